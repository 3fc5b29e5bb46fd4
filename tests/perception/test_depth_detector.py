"""Test obstacles in depth images that are computed by hand."""

from math import degrees, radians

import numpy as np
import pytest

from stepaside.core.poses import Array
from stepaside.core.rotations import rotation
from stepaside.perception.camera_model import CameraModel, CameraPose
from stepaside.perception.depth_detector import DepthScene, detect_obstacles
from stepaside.perception.images import DepthImage
from synthetic_depth import Post, draw

CAMERA = CameraModel.of_field_of_view(80, 60, radians(58.0), radians(45.0))
EYE = np.array([0.0, 0.0, 0.5])


def take(axes: Array, posts: list[Post]) -> DepthImage:
    """Depth image of a floor with upright posts."""
    return draw(CAMERA, EYE, axes, posts)


def find(
    posts: list[Post], roll: float = 0.0, pitch: float = 10.0, yaw: float = 0.0
) -> DepthScene:
    axes = rotation(radians(roll), radians(pitch), radians(yaw))
    return detect_obstacles(
        take(axes, posts), CameraPose(EYE, axes, (0.0, 0.0))
    )


@pytest.mark.parametrize("pitch", [0.0, 10.0, 20.0])
@pytest.mark.parametrize("roll", [-6.0, 0.0, 6.0])
def test_an_empty_floor_gives_no_obstacle(roll: float, pitch: float) -> None:
    assert find([], roll, pitch) == DepthScene((), ())


@pytest.mark.parametrize("roll", [-6.0, 0.0, 6.0])
@pytest.mark.parametrize("yaw", [-15.0, 0.0, 40.0])
def test_a_post_is_detected_at_its_position(roll: float, yaw: float) -> None:
    """Whatever the tilt and the yaw of the head, as they are measured."""
    bearing = radians(yaw + 8.0)
    x, y = 1.6 * np.cos(bearing), 1.6 * np.sin(bearing)
    scene = find([(x, y, 0.12, 0.6)], roll, 10.0, yaw)
    (post,) = scene.obstacles
    assert degrees(post.bearing) == pytest.approx(yaw + 8.0, abs=0.7)
    assert post.nearest == pytest.approx(1.48, abs=0.03)
    assert post.x_in_odometry == pytest.approx(x, abs=0.05)
    assert post.y_in_odometry == pytest.approx(y, abs=0.05)
    assert post.width == pytest.approx(0.24, abs=0.06)


def test_an_object_too_near_gives_a_shadow_at_its_bearing() -> None:
    bearing = radians(7.0)
    x, y = 0.6 * np.cos(bearing), 0.6 * np.sin(bearing)
    scene = find([(x, y, 0.1, 0.5)])
    assert scene.obstacles == ()
    (shadow,) = scene.shadows
    assert degrees(shadow.azimuth) == pytest.approx(7.0, abs=1.5)


def test_a_partly_measured_object_is_one_shadow() -> None:
    """Its far side alone would be off to a side."""
    parts: list[Post] = [(0.83, 0.1, 0.08, 0.5), (0.95, -0.05, 0.08, 0.5)]
    scene = find(parts)
    assert scene.obstacles == ()
    assert len(scene.shadows) == 1


def test_a_wide_wall_is_no_obstacle() -> None:
    wall = [(2.0, 0.1 * i, 0.08, 1.5) for i in range(-15, 16)]
    assert find(wall).obstacles == ()


def test_the_own_body_is_removed() -> None:
    """Hands and feet within reach of its own axis are its own."""
    scene = detect_obstacles(
        take(rotation(0.0, radians(10.0), 0.0), [(1.2, 0.0, 0.1, 0.5)]),
        CameraPose(EYE, rotation(0.0, radians(10.0), 0.0), (1.2, 0.0)),
    )
    assert scene.obstacles == ()
