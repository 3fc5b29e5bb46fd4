"""Test indices as a slice."""

import numpy as np

from stepaside.core.index_span import span_of


def test_consecutive_indices_are_a_slice_with_the_same_elements() -> None:
    values = np.arange(10.0)
    for indices in ([3, 4, 5], [7], [5, 4, 3], [2, 4]):
        span = span_of(indices)
        assert isinstance(span, slice) == (indices in ([3, 4, 5], [7]))
        np.testing.assert_array_equal(values[span], values[indices])
