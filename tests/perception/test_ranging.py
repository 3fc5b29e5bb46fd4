"""Test distances from apparent size against the geometry of the trim."""

import numpy as np
import pytest

from stepaside.core.poses import Array
from stepaside.perception.colour_detector import RED
from stepaside.perception.observations import range_of_trim, range_of_width

EYE = 0.46
TOES = 0.05  # that trim at the feet is nearer than the axis, in [m]


def direction(away: float, height: float, eye: float, aside: float) -> Array:
    """Direction to a point at a distance and height, of any length."""
    scale = 0.3 + away
    return scale * np.array(
        [away * np.cos(aside), away * np.sin(aside), height - eye]
    )


def measured(
    away: float, eye: float = EYE, aside: float = 0.0
) -> float | None:
    """Range of a robot whose axis is ``away``; its feet stand before it."""
    upper = direction(away, RED.top, eye, aside)
    lower = direction(away - TOES, RED.bottom, eye, aside)
    return range_of_trim(upper, lower, eye, RED)


@pytest.mark.parametrize("aside", [-0.7, 0.0, 0.4])
@pytest.mark.parametrize("away", [0.4, 0.8, 1.5, 3.0])
def test_trim_gives_the_distance_of_the_axis(
    away: float, aside: float
) -> None:
    assert measured(away, aside=aside) == pytest.approx(away, rel=1e-3)


@pytest.mark.parametrize("eye", [0.40, 0.46, 0.50])
def test_the_distance_is_exact_at_any_camera_height(eye: float) -> None:
    assert measured(1.2, eye) == pytest.approx(1.2, rel=1e-3)


@pytest.mark.parametrize(
    ("away", "told"), [(0.19, False), (0.21, True), (3.9, True), (4.1, False)]
)
def test_trim_gives_distances_from_0_2_m_to_4_m(
    away: float, told: bool
) -> None:
    assert measured(away) == (pytest.approx(away, rel=0.01) if told else None)


def test_the_width_gives_the_distance_within_limits() -> None:
    """Shoulders of 0.3 m from the front, half of that from the side."""
    assert range_of_width(0.25) == pytest.approx(1.0)
    assert range_of_width(0.5) == pytest.approx(0.5)
    for narrow in (-0.1, 0.0, 0.05):
        assert range_of_width(narrow) == 4.0
    assert range_of_width(3.0) == 0.2
