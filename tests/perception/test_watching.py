"""Test that robots see moving scenes as those that are stored."""

from collections.abc import Iterator
from dataclasses import replace
from math import atan2, cos, hypot, pi, radians, sin
from typing import Any

import numpy as np
import pytest

from stepaside.core.poses import Pose, wrap_angle
from stepaside.perception.body_pose import BodyPose, camera_pose
from stepaside.perception.camera_model import CameraModel
from stepaside.perception.gaze import SELDOM, Glances, RoomScan
from stepaside.perception.images import Percept
from stepaside.perception.measurement import RobotState
from stepaside.perception.pipeline import build_perception
from stored_values import compare_stored, summed
from synthetic_cameras import (
    CAMERA,
    HEAD,
    JOINTS,
    NAO,
    UP,
    FakeDetector,
    colour,
    trim,
)
from synthetic_depth import Post, draw

TICK = 1.0 / 60.0
DEPTH = CameraModel.of_field_of_view(80, 60, radians(58.0), radians(45.0))
Place = tuple[float, float]


def walker(time: float, bearing: float, speed: float) -> Place:
    """Place of someone who comes, passes by and comes back."""
    along, aside = 2.6 - speed * time, 0.3 * sin(time) + 0.2
    along = along if along > -1.5 else -3.0 - along
    c, s = cos(bearing), sin(bearing)
    return c * along - s * aside, s * along + c * aside


def legs(place: Place, time: float) -> list[Post]:
    x, y = place
    apart = 0.11 + 0.06 * sin(7.0 * time)
    return [(x, y + apart, 0.06, 0.8), (x, y - apart, 0.07, 0.75)]


def images(
    body: BodyPose, detector: FakeDetector, number: int, tall: bool
) -> Iterator[Percept]:
    """Yield images of the scene at the time of a pose."""
    time = body.time
    near, far = walker(time, 0.4, 0.6), walker(time, -1.1, 0.4)
    posts: list[Post] = [(1.6, -0.9, 0.1, 0.5), (0.9, 1.3, 0.12, 1.7)]
    posts += legs(near, time) if tall else [(*near, 0.12, 0.55)]
    posts += [(*far, 0.2, 1.7)] if tall else [(*far, 0.1, 0.57)]
    if number % 4 == 0:
        place, axes, _ = camera_pose(body, HEAD.depth_cameras[0])
        yield draw(DEPTH, place, axes, posts, [(pi, 2.4)], time)
    if number % 6 == 0 and not tall:
        place, axes, _ = camera_pose(body, HEAD.top)
        ahead = atan2(axes[1, 0], axes[0, 0])
        x, y = near[0] - place[0], near[1] - place[1]
        off, away = wrap_angle(atan2(y, x) - ahead), hypot(x, y)
        detector.found = None
        if abs(off) < 0.5 and sin(1.3 * time) > -0.6:
            column = 0.5 * CAMERA.width - CAMERA.focal_x * np.tan(off)
            half = 0.125 * CAMERA.focal_x / away
            detector.found = replace(
                trim(column), left=column - half, right=column + half
            )
        yield colour(time)


def of_watch(ticks: int, **how: Any) -> Iterator[str | float]:
    """Watch for some time; yield sums over each second."""
    detector, tall = FakeDetector(), how.get("people", False)
    eyes = build_perception(NAO, HEAD, detector, tick=TICK, **how)  # type: ignore[arg-type]
    joints, seen = np.zeros(JOINTS), list[Any]()
    for number in range(ticks):
        now, percepts = number * TICK, list[Any]()
        if eyes.body is not None and now > 0.5:  # a tick ago
            percepts = [*images(eyes.body, detector, number, tall)]
        if number == 300:
            eyes.head.start()
        still, nothing = np.zeros(3), np.zeros(8)
        told = RobotState(
            now, joints, still, UP, nothing, None, tuple(percepts)
        )
        support = Pose(
            0.02 * now, 0.05, 0.2 * sin(now) + 0.3 * eyes.head.turning
        )
        tilt = 0.01 * sin(5.0 * now), 0.02 * cos(4.0 * now)
        sighting = eyes.see(told, support, number % 60 < 30, tilt)
        eyes.aim(joints)
        head = eyes.head
        seen += [
            sighting,
            head.yaw,
            head.pitch,
            eyes.gaze_target,
            head.turning,
        ]
        seen += [float(eyes.searching), float(head.is_ready)]
        for track in eyes.tracker.tracks:
            seen += [float(track.number), track.position_at(now), track.drift]
            seen += [track.velocity, float(track.confirmed), track.height]
        seen += [(each.azimuths, each.depth) for each in eyes.reports]
        if number % 60 == 59:
            yield from [*summed(seen)][1:]
            seen = []


@pytest.mark.parametrize(
    "how",
    [
        {},
        {"people": True},
        {"glances": True},
        {"scan": False},
        {"scan": True, "people": True},
    ],
    ids=str,
)
def test_a_scene_is_seen_as_stored(how: dict[str, Any]) -> None:
    options = dict(how)
    if "glances" in how:
        options["glances"] = Glances(TICK, SELDOM)
    if "scan" in how:
        options["scan"] = RoomScan(behind=how["scan"])
    compare_stored("scenes.json", str(how), of_watch(600, **options), 1e-4)
