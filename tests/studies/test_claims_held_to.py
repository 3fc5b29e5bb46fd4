"""Test expected values and tolerances against the numbers of the paper."""

from statistics import fmean, stdev

import pytest
from hypothesis import given
from hypothesis import strategies as st

from stepaside.studies.claims import Claim, ClaimRow

SPEED, GAIN, STRIDE = 0.1, 0.2, 0.04  # of Sec. IV, in [m/s], [1/s], [m]
SINGLE, DOUBLE = 0.425, 0.122  # of the supports, in [s]


@given(st.lists(st.floats(-5.0, 5.0), min_size=1, max_size=9))
def test_measured_value_is_the_mean_of_all_runs(
    values: list[float],
) -> None:
    """Whether the claim holds or not; with the standard deviation."""
    claim = Claim("x", "is one", "I", "steps", 1.0, "m", 0.1)
    row = ClaimRow("job.x", claim, tuple(values))
    assert row.measured == pytest.approx(fmean(values))
    spread = stdev(values) if len(values) > 1 else 0.0
    assert row.spread == pytest.approx(spread, abs=1e-9)
    entries = row.to_json()
    assert (entries["least"], entries["greatest"]) == (
        min(values),
        max(values),
    )
    assert entries["runs"] == len(values)
    assert (entries["verdict"] == "holds") == row.holds
