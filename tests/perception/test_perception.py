"""Test perception from images to sightings."""

from math import atan2, hypot

import numpy as np
import pytest

from stepaside.core.poses import Pose, wrap_angle
from stepaside.perception.measurement import RobotState
from synthetic_cameras import (
    HEAD,
    JOINTS,
    SUPPORT,
    TICK,
    UP,
    Eyes,
    colour,
    trim,
)


@pytest.fixture
def eyes() -> Eyes:
    made = Eyes()
    made.see(0.0)
    return made


@pytest.mark.parametrize("column", [40.0, 80.0, 130.0])
def test_three_images_of_the_opponent_give_a_sighting(column: float) -> None:
    """Bearing and distance are from the torso, not from the camera."""
    eyes = Eyes()
    eyes.detector.found = trim(column)
    for i in range(3):
        seen = eyes.see(TICK * i, colour(TICK * i))
        assert (seen is not None) == (i == 2)
    assert eyes.perception.sighting == seen and seen.time == 2 * TICK
    (track,) = eyes.tracks
    x, y, heading = eyes.torso
    u, v = track.position_at(seen.time)
    assert seen.distance == pytest.approx(hypot(u - x, v - y))
    expected = wrap_angle(atan2(v - y, u - x) - heading)
    assert seen.bearing == pytest.approx(expected)
    assert np.sign(round(seen.bearing, 2)) == np.sign(80.0 - column)
    assert not eyes.perception.searching
    assert eyes.target is not None
    assert eyes.target.bearing == pytest.approx(seen.bearing)
    # The camera is in front of the torso: 5 cm if both look ahead.
    assert 0.05 < seen.distance - eyes.target.distance < 0.06


def test_the_camera_pose_follows_from_head_and_mount(eyes: Eyes) -> None:
    """A detection in the image centre is in front of the camera."""
    eyes.detector.found = trim(80.0)
    eyes.see(TICK, colour(TICK))
    body = eyes.perception.body
    assert body is not None
    place = (
        body.position_head_in_odometry
        + body.axes_head_in_odometry @ HEAD.top.position_in_body
    )
    u, v = eyes.tracks[0].position_at(TICK)
    angle = atan2(v - place[1], u - place[0])
    assert angle == pytest.approx(SUPPORT.theta, abs=1e-3)
    breadth = 2.0 * atan2(15.0, 140.0)
    away = hypot(u - place[0], v - place[1])
    assert away == pytest.approx(0.25 / breadth, rel=1e-3)


def test_a_delayed_image_uses_the_pose_at_its_exposure() -> None:
    eyes = Eyes()
    for i in range(40):
        eyes.support = Pose(1.0, -2.0, 0.7 + 0.02 * i)
        eyes.see(TICK * i)
    eyes.detector.found = trim(80.0)
    eyes.see(40 * TICK, colour(10 * TICK + 0.4 * TICK))
    body = eyes.perception.poses.at(10 * TICK)()
    assert body.time == pytest.approx(10 * TICK)
    place = (
        body.position_head_in_odometry
        + body.axes_head_in_odometry @ HEAD.top.position_in_body
    )
    u, v = eyes.tracks[0].position_at(10 * TICK)
    angle = atan2(v - place[1], u - place[0])
    assert angle == pytest.approx(0.7 + 0.02 * 10, abs=1e-3)


@pytest.mark.parametrize(("people", "period"), [(False, 0.1), (True, TICK)])
def test_tracks_age_without_images(people: bool, period: float) -> None:
    """Decisions about people may begin at any tick, others at ten a second."""
    eyes = Eyes(people=people)
    eyes.see(0.0)
    eyes.know(*eyes.beside(1.0, 0.5))
    perception, support = eyes.perception, eyes.support
    times = []
    for i in range(1, 300):
        values = np.zeros(JOINTS), np.zeros(3), UP, np.zeros(8), None
        seen = perception.see(
            RobotState(TICK * i, *values), support, True, (0.0, 0.0)
        )
        if seen is not None:
            times.append(seen.time)
    assert times == sorted(times) and times[-1] > 1.0
    assert np.diff(np.unique(times)) == pytest.approx(period)
    assert perception.sighting is None and perception.searching
