"""Test the fall detection of the body state."""

import pytest

from stepaside.locomotion.zmp.state_estimator import BodyState

ZERO = (0.0, 0.0)


@pytest.mark.parametrize(
    ("tilt", "fallen"),
    [
        ((0.69, 0.0), False),
        ((0.71, 0.0), True),
        ((-0.71, 0.0), True),
        ((0.0, 0.71), True),
        ((0.0, -0.71), True),
        ((-0.69, 0.69), False),
    ],
)
def test_forty_degrees_of_tilt_are_a_fall(
    tilt: tuple[float, float], fallen: bool
) -> None:
    state = BodyState(ZERO, ZERO, ZERO, ZERO, tilt, (0, 0, 0), 0.5, 50.0)
    assert state.has_fallen is fallen
