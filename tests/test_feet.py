"""Test that the lower camera tells of the feet of who is near."""

from math import atan2, hypot, radians

import numpy as np
import pytest

from drawn_depth import Post, paint
from made_up_eyes import HEAD, JOINTS, NAO, UP
from stepaside.perception.feet import CLOSE, Feet
from stepaside.perception.observing import camera_of
from stepaside.perception.perception import Perception
from stepaside.poses import Pose, wrap_angle
from stepaside.robots.head import Mount
from stepaside.sensing.camera_model import CameraModel
from stepaside.sensing.colour_detector import RED
from stepaside.sensing.images import ColourImage
from stepaside.sensing.measurement import Measurement
from stepaside.sensing.track import Observation, Track

CAMERA = CameraModel.of_field_of_view(160, 120, radians(60.9), radians(47.6))
Legs = list[Post]


class Standing:
    """Perception of a robot that stands at the origin and looks ahead."""

    def __init__(self, *, people: bool = True) -> None:
        self.perception = Perception(NAO, HEAD, RED, tick=0.02, people=people)
        self.see(0.0)

    def see(self, time: float, *images: ColourImage) -> None:
        """Take in one tick."""
        self.perception.see(
            Measurement(
                *(time, np.zeros(JOINTS), np.zeros(3), UP, np.zeros(8), None),
                tuple(images),
            ),
            Pose(0.0, 0.05, 0.0),
            True,
            (0.0, 0.0),
        )

    def image(self, time: float, legs: Legs, *, low: bool) -> ColourImage:
        """What one camera of the head sees of legs on a floor."""
        body, mount = self.perception.body, self.mount(low=low)
        assert body is not None
        place, axes = camera_of(body, mount)
        pixels = paint(CAMERA, place, axes, legs)
        return ColourImage(time, CAMERA, pixels, low)

    @staticmethod
    def mount(*, low: bool) -> Mount:
        """Of one camera of the head."""
        mount = HEAD.bottom if low else HEAD.top
        assert mount is not None
        return mount

    def follow(self, x: float, y: float, *, walked: bool = True) -> Track:
        """Somebody who is believed to be at a place, 0.15 m beside it."""
        track = Track(Observation(0.0, x, y, 0.0, 0.15, 0.15, False, True))
        track.confirmed, track.walked = True, walked
        self.perception._tracker.tracks.append(track)
        return track


def legs_at(x: float, y: float) -> Legs:
    """Two legs side by side, who come from ahead."""
    return [(x, y + side, 0.06, 0.8) for side in (0.09, -0.09)]


@pytest.mark.parametrize("place", [(0.5, 0.0), (0.7, 0.15), (0.9, -0.2)])
def test_the_lower_camera_tells_how_far_the_feet_are(
    place: tuple[float, float],
) -> None:
    robot = Standing()
    robot.see(0.02, robot.image(0.02, [], low=False))
    track = robot.follow(place[0] + 0.15, place[1] + 0.1)
    for i in range(2, 12):
        now = 0.02 * i
        robot.see(now, robot.image(now, legs_at(*place), low=True))
    x, y = track.place_at(0.22)
    # These legs have no toes.
    assert hypot(x, y) == pytest.approx(hypot(*place), abs=0.1)
    off = wrap_angle(atan2(y, x) - atan2(place[1], place[0]))
    assert abs(off) < radians(4.0)
    (report,) = robot.perception.reports
    assert len(report.azimuths) == 1 and report.image.camera is CAMERA


def test_feet_found_nobody_and_move_nothing_that_rests() -> None:
    robot = Standing()
    robot.see(0.02, robot.image(0.02, [], low=False))
    low = robot.image(0.04, legs_at(0.6, 0.0), low=True)
    robot.see(0.04, low)
    assert robot.perception._tracker.tracks == []
    resting = robot.follow(0.7, 0.0, walked=False)
    robot.see(0.06, robot.image(0.06, legs_at(0.6, 0.0), low=True))
    assert resting.place_at(0.06) == pytest.approx((0.7, 0.0))


def test_the_lower_camera_is_asked_for_when_somebody_is_close() -> None:
    robot = Standing()
    perception = robot.perception
    near = robot.follow(CLOSE - 0.1, 0.0)
    assert not perception.looks_low()  # the floor is not known yet
    perception._tracker.tracks.clear()
    robot.see(0.02, robot.image(0.02, [], low=False))
    perception._tracker.tracks.append(near)
    assert perception.looks_low()
    near.walked = False
    assert not perception.looks_low()
    perception._tracker.tracks[:] = [robot.follow(CLOSE + 0.1, 0.0)]
    assert not perception.looks_low()


def test_who_looks_for_a_robot_uses_one_camera() -> None:
    robot = Standing(people=False)
    robot.see(0.02, robot.image(0.02, [], low=False))
    robot.follow(0.8, 0.0)
    assert not robot.perception.looks_low()


def test_of_the_floor_under_somebody_nothing_is_learnt() -> None:
    """Nor of what is hidden behind."""
    feet, robot = Feet(), Standing()
    someone = robot.follow(1.0, 0.0)
    body = robot.perception.body
    assert body is not None
    place, axes = camera_of(body, HEAD.top)
    image = robot.image(0.02, legs_at(1.0, 0.0), low=False)
    feet.learn(image, place, axes, (0.0, 0.0), [someone])
    assert not feet.colours.known
    feet.learn(image, place, axes, (0.0, 0.0), [])
    assert feet.colours.known
