"""Test the detection of feet on a floor with known colours."""

from math import atan2, cos, degrees, hypot, radians, sin

import numpy as np
import pytest

from stepaside.core.poses import Array
from stepaside.perception.camera_model import CameraModel
from stepaside.perception.camera_pose import CameraPose
from stepaside.perception.floor_colours import (
    FloorColours,
    FloorContact,
    detect_feet,
    floor_points,
)
from stepaside.perception.images import ColourImage
from stepaside.robots.head import rotation
from synthetic_depth import Post, paint

CAMERA = CameraModel.of_field_of_view(160, 120, radians(60.9), radians(47.6))
EYE = np.array([0.05, 0.0, 0.46])
AHEAD = rotation(0.0, radians(39.7), 0.0)  # as the lower camera looks


def image(axes: Array, posts: list[Post]) -> ColourImage:
    return ColourImage(0.0, CAMERA, paint(CAMERA, EYE, axes, posts))


@pytest.fixture
def colours() -> FloorColours:
    made = FloorColours()
    whole = np.ones((CAMERA.height, CAMERA.width), dtype=np.bool_)
    made.learn(image(AHEAD, []).pixels, whole)
    return made


def find(
    colours: FloorColours, posts: list[Post], axes: Array = AHEAD
) -> tuple[FloorContact, ...]:
    seen = image(axes, posts)
    return detect_feet(seen, CameraPose(EYE, axes, (0.0, 0.0)), colours)


@pytest.mark.parametrize("distance", [0.4, 0.6, 0.8, 1.0])
@pytest.mark.parametrize("bearing", [-20.0, 0.0, 15.0])
def test_feet_are_located_at_their_near_edge(
    colours: FloorColours, distance: float, bearing: float
) -> None:
    """The position of two legs is midway between them."""
    angle = radians(bearing)
    ahead, left = distance * cos(angle), distance * sin(angle)
    aside = -0.09 * sin(angle), 0.09 * cos(angle)
    legs = [
        (ahead + s * aside[0], left + s * aside[1], 0.06, 0.8)
        for s in (1.0, -1.0)
    ]
    (found,) = find(colours, legs)
    assert hypot(found.x_in_odometry, found.y_in_odometry) == pytest.approx(
        distance - 0.05, abs=0.04
    )
    assert degrees(
        atan2(found.y_in_odometry, found.x_in_odometry)
    ) == pytest.approx(bearing, abs=3.0)


def test_an_empty_floor_has_no_feet_from_any_side(
    colours: FloorColours,
) -> None:
    for yaw in (0.0, 0.7, -1.0):
        assert find(colours, [], rotation(0.02, radians(35.0), yaw)) == ()


def test_two_people_apart_are_two_contacts(colours: FloorColours) -> None:
    found = find(colours, [(0.8, 0.3, 0.08, 1.0), (0.7, -0.25, 0.08, 1.0)])
    assert [round(f.y_in_odometry, 1) for f in found] == [-0.2, 0.3]


def test_an_unknown_floor_gives_no_contact() -> None:
    colours = FloorColours()
    assert not colours.known
    assert find(colours, [(0.6, 0.0, 0.1, 1.0)]) == ()


def test_a_rare_colour_is_not_floor(colours: FloorColours) -> None:
    """A person learnt once by mistake is still detected."""
    leg = [(0.7, 0.0, 0.06, 0.8)]
    seen = image(AHEAD, leg).pixels
    dark = seen[..., 0] < 120
    part = np.zeros_like(dark)
    part[tuple(np.argwhere(dark)[:100].T)] = True
    colours.learn(seen, part)
    assert len(find(colours, leg)) == 1


def test_the_own_feet_are_ignored(colours: FloorColours) -> None:
    assert find(colours, [(0.15, 0.05, 0.05, 0.1)]) == ()


def test_rays_above_the_horizon_have_no_floor_point() -> None:
    level = rotation(0.0, 0.0, 0.0)
    points = floor_points(image(level, []), CameraPose(EYE, level, (0.0, 0.0)))
    assert np.isinf(points[:60]).all() and np.isfinite(points[61:]).all()
