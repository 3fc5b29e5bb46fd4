"""Test the settings of a gait and their ranges (paper, Sec. IV)."""

from dataclasses import replace

import numpy as np
import pytest

from stepaside.core.errors import PlanError
from stepaside.planning import GaitSettings
from stepaside.planning.gait_settings import SoleRectangle


def test_gait_has_the_values_of_the_paper() -> None:
    """Sec. IV, for the NAO; where it is silent, ours."""
    gait = GaitSettings()
    assert (gait.speed, gait.gain, gait.stride) == (0.1, 0.2, 0.04)
    assert gait.gravity == 9.81
    assert gait.eta == pytest.approx(np.sqrt(9.81 / 0.268))
    ours = (gait.foot_spacing, gait.step_height, gait.com_height)
    assert ours == (0.1, 0.02, 0.268)
    assert (gait.start_support, gait.zmp_forward) == (0.8, 0.02)
    assert (gait.horizon, gait.zmp_profile) == (5, "linear")


def test_soles_are_those_of_the_nao_model() -> None:
    """The box of `docs/nao.md`: longer ahead, wider outside."""
    sole = SoleRectangle()
    assert (sole.back, sole.front) == (-0.05, 0.095)
    assert (sole.outer, sole.inner) == (0.042, 0.035)


@pytest.mark.parametrize(
    ("name", "value"),
    [("back", 0.0), ("front", -0.1), ("inner", 0.0), ("outer", -0.1)],
)
def test_a_sole_that_does_not_hold_its_frame_is_refused(
    name: str, value: float
) -> None:
    with pytest.raises(PlanError, match=f"sole.{name} must lie in"):
        replace(SoleRectangle(), **{name: value})


def test_horizons_from_two_to_a_thousand_are_allowed() -> None:
    for horizon in (2, 1000):
        assert replace(GaitSettings(), horizon=horizon).horizon == horizon
    for horizon in (1, 1001):
        with pytest.raises(PlanError, match=r"horizon must .*\[2, 1000"):
            replace(GaitSettings(), horizon=horizon)
    with pytest.raises(PlanError, match="horizon"):
        replace(GaitSettings(), horizon=2.5)  # type: ignore[arg-type]


def test_soles_that_touch_are_refused() -> None:
    with pytest.raises(PlanError, match="overlap"):
        replace(GaitSettings(), foot_spacing=2.0 * SoleRectangle().inner)
