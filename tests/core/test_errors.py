"""Test the checks of numbers and their messages."""

from math import inf, nan
from typing import Any

import pytest

from stepaside.core.errors import (
    ConfigurationError,
    ModelError,
    PlanError,
    ReachError,
    StepAsideError,
    check_finite,
    check_positive,
    check_within,
)


@pytest.mark.parametrize("value", [nan, inf, -inf])
def test_every_check_refuses_nan_and_inf(value: float) -> None:
    with pytest.raises(PlanError, match=r"x must be finite \[m\], got"):
        check_finite(value, "x", "m")
    with pytest.raises(PlanError, match=r"x must be finite and > 0 \[m\]"):
        check_positive(value, "x", "m")
    with pytest.raises(PlanError, match=r"x must lie in \[0, 2\] \[m\], got"):
        check_within(value, 0.0, 2.0, "x", "m")


@pytest.mark.parametrize(
    "value", [True, "1", None, [1.0], 10**5000, 1j], ids=type
)
def test_other_types_are_refused_with_a_short_message(value: Any) -> None:
    for check in (check_finite, check_positive):
        with pytest.raises(PlanError, match="x must be finite") as refused:
            check(value, "x", "m")
        assert len(str(refused.value)) < 200
    with pytest.raises(PlanError, match="x must lie in"):
        check_within(value, 0.0, 1.0, "x", "m")


def test_a_closed_range_includes_its_bounds() -> None:
    for value in (-1.0, 0.5, 2.0):
        check_within(value, -1.0, 2.0, "x", "m")
    for value in (-1.0 - 1e-12, 2.0 + 1e-12):
        with pytest.raises(PlanError, match=f"got {value}"):
            check_within(value, -1.0, 2.0, "x", "m")


@pytest.mark.parametrize(
    "error", [PlanError, ConfigurationError, ModelError, ReachError]
)
def test_every_input_error_is_a_stepaside_and_a_value_error(
    error: type[Exception],
) -> None:
    assert issubclass(error, StepAsideError)
    assert issubclass(error, ValueError)
