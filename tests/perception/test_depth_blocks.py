"""Test obstacles and shadows in depth images of drawn blocks."""

from math import radians

import numpy as np
import pytest

from stepaside.core.rotations import rotation
from stepaside.perception.camera_model import CameraModel, CameraPose
from stepaside.perception.depth_detector import DepthScene, detect_obstacles
from stepaside.perception.images import DepthImage

NEAR, FAR = 0.8, 3.5
ACROSS = 40.0 / np.tan(radians(29.0))  # focal lengths, in pixels
FOCAL = 30.0 / np.tan(radians(22.5))
Block = tuple[int, int, int, int, float]  # rows, columns, depth


def draw(
    *blocks: Block, height: float = 0.5, yaw: float = 0.0, scale: int = 1
) -> DepthScene:
    """Scene of a level camera with blocks of a depth before a floor.

    Rows and columns of a block are the first and the one after the last.
    """
    camera = CameraModel.of_field_of_view(
        80 * scale, 60 * scale, radians(58.0), radians(45.0)
    )
    down = -camera.rays()[..., 2]
    depths = np.where(down > 0.0, height / np.maximum(down, 1e-9), 0.0)
    depths[(depths < NEAR) | (depths > FAR)] = 0.0
    # Nothing near hides the floor, unless a block of no depth says so.
    for top, bottom, left, right, depth in blocks:
        depths[top:bottom, left:right] = depth
    image = DepthImage(0.0, camera, depths.astype(np.float32), NEAR, FAR)
    axes = rotation(0.0, 0.0, yaw)
    eye = np.array([0.3, -0.2, height])
    return detect_obstacles(image, CameraPose(eye, axes, (-1.0, -1.0)))


@pytest.mark.parametrize("yaw", [0.0, 1.0, 3.0, -3.1])
@pytest.mark.parametrize("shift", [-12, 0, 12])
def test_a_block_is_measured_at_its_size_and_position(
    yaw: float, shift: int
) -> None:
    """Twelve columns at 1.5 m, whose mirror image is to the other side."""
    scene = draw((10, 40, 34 + shift, 46 + shift, 1.5), yaw=yaw)
    (thing,) = scene.obstacles
    assert scene.shadows == ()
    azimuth = -np.arctan(shift / ACROSS)
    assert thing.azimuth == pytest.approx(azimuth, abs=3e-3)
    assert thing.bearing == pytest.approx(yaw + thing.azimuth)
    away = 1.5 / np.cos(azimuth)
    assert thing.nearest == pytest.approx(away, abs=0.03)
    angle = np.diff(np.arctan((np.array([-6, 6]) + shift) / ACROSS))[0]
    assert thing.width == pytest.approx(away * angle, rel=0.1)
    assert thing.height == pytest.approx(0.5 + 1.5 * 19.5 / FOCAL)
    reach = thing.nearest + 0.5 * thing.width
    assert thing.x_in_odometry == pytest.approx(
        0.3 + reach * np.cos(thing.bearing)
    )
    assert thing.y_in_odometry == pytest.approx(
        -0.2 + reach * np.sin(thing.bearing)
    )
    assert thing.whole


@pytest.mark.parametrize("dark", [1, 2])
def test_missing_depth_does_not_join_an_object_to_the_wall(dark: int) -> None:
    """The camera's own shadow beside a near edge answers nothing."""
    edge = 46 + dark
    shadow = 10, 27, 46, edge, 0.0
    wall = 0, 27, edge, 80, 3.0
    (thing,) = draw(wall, (10, 40, 34, 46, 1.5), shadow).obstacles
    assert thing.azimuth == pytest.approx(0.0, abs=3e-3)
    assert thing.nearest == pytest.approx(1.5, abs=0.03)
    assert thing.whole


def angle(column: int) -> float:
    """Azimuth of the middle of a column, in [rad]."""
    return float(np.arctan((39.5 - column) / ACROSS))


def test_an_arm_that_is_nearer_does_not_shift_a_person() -> None:
    """A sixth of the pixels, 0.2 m before the rest of a body."""
    body, arm = (0, 40, 34, 46, 1.5), (10, 30, 38, 42, 1.3)
    for blocks, nearest in (([body], 1.5), ([body, arm], 1.3)):
        (person,) = draw(*blocks).obstacles
        assert person.height > 1.0
        assert person.nearest == pytest.approx(nearest, abs=0.03)
        assert person.x_in_odometry == pytest.approx(0.3 + 1.625, abs=0.04)


@pytest.mark.parametrize("yaw", [0.0, 1.0, 3.1, -3.1])
def test_a_shadow_is_as_wide_as_the_hidden_floor(yaw: float) -> None:
    scene = draw((43, 60, 10, 20, 0.0), (43, 60, 50, 70, 0.0), yaw=yaw)
    first, second = scene.shadows
    for shadow, left, right in ((first, 50, 69), (second, 10, 19)):
        assert shadow.width == pytest.approx(angle(left) - angle(right))
        middle = 0.5 * (angle(left) + angle(right))
        assert shadow.azimuth == pytest.approx(middle)


def test_a_measured_leg_gives_the_distance_of_both() -> None:
    leg, shadow = (0, 35, 30, 36, 0.85), (43, 60, 42, 50, 0.0)
    scene = draw(leg, shadow)
    assert scene.obstacles == ()
    (person,) = scene.shadows
    assert person.width == pytest.approx(angle(30) - angle(49), abs=0.02)
    assert person.nearest == pytest.approx(0.85, abs=0.03)
    (alone,) = draw(shadow).shadows
    assert alone.nearest is None


@pytest.mark.parametrize(
    ("top", "gap", "things"), [(0, 6, 1), (4, 6, 2), (0, 22, 2)]
)
def test_legs_cut_by_the_upper_edge_are_one_person(
    top: int, gap: int, things: int
) -> None:
    """Narrow obstacles within the view, or far apart, stay two."""
    right = 36 + gap
    legs = (top, 40, 30, 36, 1.2), (top, 40, right, right + 6, 1.3)
    found = draw(*legs).obstacles
    assert len(found) == things
    if things == 1:
        (person,) = found
        both = [draw(leg).obstacles[0] for leg in legs]
        assert person.x_in_odometry == pytest.approx(
            np.mean([leg.x_in_odometry for leg in both])
        )
        assert person.y_in_odometry == pytest.approx(
            np.mean([leg.y_in_odometry for leg in both])
        )
        assert both[1].azimuth < person.azimuth < both[0].azimuth
        assert person.nearest == both[0].nearest
        assert person.whole and person.rises
