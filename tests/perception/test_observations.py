"""Test the way from what an image shows to a place in odometry."""

from dataclasses import replace
from math import atan2, cos, hypot, pi, radians, sin, tan
from typing import Any

import numpy as np
import pytest

from stepaside.core.poses import Array, wrap_angle
from stepaside.core.rotations import rotation
from stepaside.perception.camera_model import CameraModel, CameraPose
from stepaside.perception.colour_detector import RED, ColourDetection
from stepaside.perception.depth_detector import Shadow
from stepaside.perception.images import ColourImage, DepthImage
from stepaside.perception.observations import (
    DEFAULT_DISTANCE,
    DEVIATION_BOUND,
    SHADOW_MARGIN,
    TRIM_FORWARD,
    TRIM_WIDTH,
    angle_of,
    observe_shadow,
    observe_trim,
)
from stepaside.perception.track import Observation, TargetTrack

CAMERA = CameraModel(640, 480, 550.0, 560.0)
PIXELS = np.zeros((8, 8, 3), dtype=np.uint8)
IMAGE = ColourImage(3.5, CAMERA, PIXELS)
DEPTH = DepthImage(3.5, CAMERA, np.zeros((8, 8), np.float32), 0.8, 3.5)
PLACE = np.array([0.3, -0.4, 0.47])
YAW = 2.8
AXES = rotation(0.15, 0.05, YAW)


def eye(axes: Array) -> CameraPose:
    return CameraPose(PLACE, axes, (0.3, -0.4))


EYE = eye(AXES)


def trim(distance: float, bearing: float, **changes: Any) -> ColourDetection:
    """Ends of a robot's trim, projected by plane geometry.

    Args:
        distance: Of its axis from the camera, in [m].
        bearing: In odometry, in [rad].
        changes: Other entries of the detection.
    """
    ends = []
    for away, height in ((distance, RED.top), (distance - TRIM_FORWARD, 0.06)):
        ray = away * cos(bearing), away * sin(bearing), height - PLACE[2]
        ends.append(CAMERA.project(AXES.T @ np.array(ray))[0].tolist())
    (column, top), (_, bottom) = ends
    values: dict[str, Any] = {
        "column": column,
        "top": top,
        "bottom": bottom,
        "left": column - 20.0,
        "right": column + 20.0,
        "confidence": 1.0,
        "cut_above": False,
        "cut_below": False,
        "cut_aside": False,
    } | changes
    return ColourDetection(**values)


def observe(found: ColourDetection, *tracks: TargetTrack) -> Observation:
    return observe_trim(IMAGE, found, EYE, RED, tracks)


def track(
    distance: float, bearing: float, time: float = 3.5, speed: float = 0.0
) -> TargetTrack:
    """Track an object at a distance from the camera, moving away from it."""
    x = PLACE[0] + distance * cos(bearing)
    y = PLACE[1] + distance * sin(bearing)
    return TargetTrack(
        Observation(time, x, y, bearing, 0.03, 0.01, True, True),
        velocity_in_odometry=(speed * cos(bearing), speed * sin(bearing)),
    )


def distance_of(seen: Observation) -> float:
    return hypot(seen.x_in_odometry - PLACE[0], seen.y_in_odometry - PLACE[1])


@pytest.mark.parametrize("distance", [0.9, 1.7])
def test_trim_that_is_whole_tells_bearing_and_distance(
    distance: float,
) -> None:
    """With the head turned, nodding and aslant."""
    axes = rotation(0.0, 0.05, YAW)
    bearing = YAW - 0.2
    ends = []
    for away, height in ((distance, RED.top), (distance - TRIM_FORWARD, 0.06)):
        ray = away * cos(bearing), away * sin(bearing), height - PLACE[2]
        ends.append(CAMERA.project(axes.T @ np.array(ray))[0].tolist())
    found = trim(1.0, YAW, column=ends[0][0], top=ends[0][1])
    found = ColourDetection(
        0.5 * (ends[0][0] + ends[1][0]),
        ends[0][1],
        ends[1][1],
        *(found.left, found.right, 1.0, False, False, False),
    )
    seen = observe_trim(IMAGE, found, eye(axes), RED, ())
    assert wrap_angle(seen.bearing - bearing) == pytest.approx(0.0, abs=0.01)
    assert distance_of(seen) == pytest.approx(distance, rel=0.01)
    direction = atan2(
        seen.y_in_odometry - PLACE[1], seen.x_in_odometry - PLACE[0]
    )
    assert wrap_angle(direction - seen.bearing) == pytest.approx(0.0, abs=1e-9)
    assert seen.time == 3.5 and seen.identified and seen.ranged
    away = distance_of(seen)
    assert seen.along == pytest.approx(0.02 + 0.05 * away)
    assert seen.across == pytest.approx(0.003 + 0.005 * away)


def test_the_lower_end_of_trim_tells_how_far_a_robot_is_at_most() -> None:
    """So near that the image shows only one end, or the middle."""
    above = trim(0.5, YAW, cut_above=True, top=0.0)
    seen = observe(above)
    assert seen.ranged
    assert distance_of(seen) == pytest.approx(0.5, rel=0.04)  # aslant
    both = observe(replace(above, cut_below=True))
    assert not both.ranged
    wide = replace(above, cut_below=True, left=110.0, right=150.0)
    assert distance_of(observe(wide)) == pytest.approx(distance_of(seen))


@pytest.mark.parametrize("bearing", [YAW, pi - 0.05, -pi + 0.05])
def test_memory_is_of_what_was_in_that_direction(bearing: float) -> None:
    """Within 20 degrees, also over the half turn."""
    found = trim(1.5, bearing, confidence=0.5)
    there = observe(found).bearing
    for off, known in ((19.0, True), (-19.0, True), (21.0, False)):
        seen = observe(found, track(0.9, there + radians(off)))
        away = 0.9 if known else DEFAULT_DISTANCE
        assert distance_of(seen) == pytest.approx(away, abs=1e-9)
    several = track(2.0, there + 1.0), track(0.7, there), track(0.9, there)
    assert distance_of(observe(found, *several)) == pytest.approx(0.7)


def test_a_shadow_is_no_farther_than_the_near_limit() -> None:
    shadow = Shadow(-0.15, 0.15)
    seen = observe_shadow(DEPTH, shadow, EYE, ())
    away = 0.8 + SHADOW_MARGIN
    assert (
        seen.x_in_odometry - PLACE[0],
        seen.y_in_odometry - PLACE[1],
    ) == pytest.approx((away * cos(YAW), away * sin(YAW)))
    assert seen.bearing == pytest.approx(YAW) and seen.time == 3.5
    assert seen.along == DEVIATION_BOUND
    assert seen.across == pytest.approx(0.08 * away)
    assert not seen.identified and not seen.ranged


@pytest.mark.parametrize("behind", [False, True])
@pytest.mark.parametrize("side", [-1.0, 1.0])
@pytest.mark.parametrize("left_out", [0.3, 0.5])
def test_trim_that_an_edge_hides_in_part_is_put_where_its_middle_is(
    side: float, left_out: float, behind: bool
) -> None:
    """Side +1 is the right one; what is seen of it ends at the edge.

    Behind, its middle is beyond the half turn, and what is seen is not.
    """
    away, edge = 0.6, 0.5 * CAMERA.width
    whole = TRIM_WIDTH / away
    half = abs(angle_of(IMAGE, 0.0))
    middle = side * (half - (0.5 - left_out) * whole)  # positive rightward
    yaw = middle - side * (pi + 0.02) if behind else YAW
    inner = middle - side * 0.5 * whole
    ends = sorted([inner, side * half])
    left, right = (edge + CAMERA.focal_x * tan(angle) for angle in ends)
    shown = edge + CAMERA.focal_x * tan(0.5 * sum(ends))
    found = trim(
        away, YAW, column=shown, left=left, right=right, confidence=0.5
    )
    known = track(away, yaw - middle)
    level = rotation(0.0, 0.0, yaw)
    near = observe_trim(IMAGE, found, eye(level), RED, [known], near=True)
    blind = observe_trim(IMAGE, found, eye(level), RED, [known])
    off = [wrap_angle(seen.bearing - yaw + middle) for seen in (near, blind)]
    assert off[0] == pytest.approx(0.0, abs=0.01)
    assert off[1] == pytest.approx(side * 0.5 * left_out * whole, abs=0.01)
    assert max(abs(near.bearing), abs(blind.bearing)) <= pi
    assert near.across > 0.4 * left_out * TRIM_WIDTH > blind.across
    assert not near.ranged and near.along > 0.5
