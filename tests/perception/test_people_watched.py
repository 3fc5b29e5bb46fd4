"""Test target selection in a room with people and walls."""

from collections.abc import Callable, Sequence
from dataclasses import replace
from math import atan2, cos, degrees, hypot, radians, sin

import numpy as np
import pytest

from stepaside.core.poses import Pose, wrap_angle
from stepaside.perception.body_pose import camera_pose
from stepaside.perception.camera_model import CameraModel
from stepaside.perception.colour_detector import RED, ColourDetector
from stepaside.perception.images import Percept
from stepaside.perception.measurement import RobotState, Sighting
from stepaside.perception.pipeline import build_perception
from stepaside.perception.target_selection import PeopleSelection
from stepaside.perception.track import Observation, TargetTrack, Tracker
from synthetic_cameras import HEAD, JOINTS, NAO, UP
from synthetic_depth import Post, Wall, draw

CAMERA = CameraModel.of_field_of_view(80, 60, radians(58.0), radians(45.0))
TICK = 1.0 / 60.0  # an image is taken at every fourth, [s]
Place = tuple[float, float]


class Watch:
    """Robot at the origin that scans."""

    def __init__(self, walls: Sequence[Wall]) -> None:
        self.perception = build_perception(
            NAO, HEAD, ColourDetector(RED), tick=TICK, people=True
        )
        self._walls = walls
        self._joints = np.zeros(JOINTS)
        self._ticks = 0

    def see(self, people: Sequence[Place]) -> Sighting | None:
        """Take in one tick of a scene."""
        body, percepts = self.perception.body, list[Percept]()
        if self._ticks % 4 == 0 and body is not None:
            place, axes, _ = camera_pose(body, HEAD.depth_cameras[0])
            posts: list[Post] = [(x, y, 0.15, 1.7) for x, y in people]
            taken = body.time  # a tick ago, with the head as it was then
            image = draw(CAMERA, place, axes, posts, self._walls, taken)
            percepts.append(image)
        return self._take(percepts)

    def _take(self, percepts: Sequence[Percept]) -> Sighting | None:
        """Take in percepts at the next tick."""
        now = self._ticks * TICK
        self._ticks += 1
        measured = RobotState(
            now,
            self._joints.copy(),
            np.zeros(3),
            UP,
            np.zeros(8),
            None,
            tuple(percepts),
        )
        # Soles under the hips: the torso is at the origin.
        support = Pose(0.0, 0.05, 0.0)
        seen = self.perception.see(measured, support, True, (0.0, 0.0))
        self.perception.aim(self._joints)
        return seen


def coming(bearing: float, speed: float, far: float) -> Callable[..., Place]:
    """Person who walks towards the origin, from a direction in [deg]."""

    def place(time: float) -> Place:
        away = far - speed * time
        angle = radians(bearing)
        return away * cos(angle), away * sin(angle)

    return place


def off(seen: Sighting | None, place: Place) -> float:
    """Error of a sighting's bearing, in [deg]; 180 for none."""
    if seen is None:
        return 180.0
    return abs(degrees(wrap_angle(seen.bearing - atan2(place[1], place[0]))))


@pytest.mark.parametrize(
    ("beside", "away"),
    [(-90.0, 0.5), (-90.0, 0.9), (0.0, 0.6), (0.0, 1.1), (-45.0, 0.7)],
)
def test_a_near_wall_does_not_distract_from_an_approaching_person(
    beside: float, away: float
) -> None:
    """The person is followed from 1.5 m on, wherever the wall is."""
    watch = Watch([(radians(beside), away)])
    walk = coming(90.0, 0.8, 5.5)
    for tick in range(round(6.0 / TICK)):
        place = walk(tick * TICK)
        seen = watch.see([place])
        if 0.9 < hypot(*place) < 1.5:
            assert off(seen, place) < 8.0, f"{hypot(*place):.2f} m"
            assert not watch.perception.searching


def test_an_approaching_person_is_preferred_to_one_who_passes() -> None:
    """One walks by at 1.3 m, the other at the robot: two tracks, one counts.

    They cross in sight of the robot, and each is still the one it was.
    """
    watch = Watch([])
    walk = coming(30.0, 0.8, 5.0)
    counted = set()
    for tick in range(round(5.0 / TICK)):
        time = tick * TICK
        place, passer = walk(time), (1.3, 2.4 - 0.8 * time)
        seen = watch.see([passer, place])
        if time > 4.0:
            assert seen is not None and off(seen, place) < 8.0
            assert seen.distance == pytest.approx(hypot(*place), abs=0.12)
            counted.add(seen.target_id)
    assert len(counted) == 1


def followed(
    *places: Place, velocity: tuple[float, float] = (0.0, 0.0)
) -> TargetTrack:
    """A confirmed track of what was seen at places, 0.1 s apart."""
    first, *rest = [
        Observation(0.1 * i, x, y, 0.0, 0.03, 0.03, False, True)
        for i, (x, y) in enumerate(places)
    ]
    track = TargetTrack(first, velocity_in_odometry=velocity)
    for seen in rest:
        track.update(seen)
    track.confirmed = True
    return track


def looks(begin: float, speed: float, seconds: float, spread: float) -> float:
    """Share of a while in which the head looks at one thing ahead.

    Args:
        begin: Its distance at first, in [m].
        speed: With which it leaves, in [m/s].
        seconds: The while.
        spread: Deviation of its places, in [m].
    """
    tracker = Tracker()
    people, at, count = PeopleSelection(tracker), 0, round(seconds / 0.1)

    def seen(i: int) -> Observation:
        place = begin + 0.1 * i * speed
        return Observation(
            0.1 * i, place, 0.0, 0.0, spread, spread, False, True
        )

    track = TargetTrack(seen(0))
    tracker.tracks = [track]
    track.confirmed = looked = True
    for i in range(1, count):
        if looked or i % 20 == 0:  # else the head sweeps by it
            track.update(seen(i))
        chosen = people.look(None, 0.1 * i, 0.0, 0.0)
        looked = chosen is track
        at += looked
    return at / (count - 1)


def test_a_walking_person_comes_before_a_nearer_object_at_rest() -> None:
    wall = followed(*[(0.6, 0.0)] * 10)
    walker = followed(*[(0.0, 3.0 - 0.05 * i) for i in range(10)])
    passer = followed(*[(2.0 - 0.1 * i, 1.5) for i in range(10)])
    tracker = Tracker()
    tracker.tracks = [wall, passer, walker]
    assert PeopleSelection(tracker).main(0.95, 0.0, 0.0) is walker
    tracker.tracks = [wall]
    assert PeopleSelection(tracker).main(0.95, 0.0, 0.0) is wall
    # Another must come clearly nearer to count instead.
    people = PeopleSelection(tracker)
    again = followed(*[(0.1, 3.1 - 0.05 * i) for i in range(10)])
    tracker.tracks = [again]
    assert people.main(0.95, 0.0, 0.0) is again
    tracker.tracks = [again, walker]
    assert people.main(0.95, 0.0, 0.0) is again


class WatchBehind(Watch):
    """The same robot with a camera on its back, and none on its head."""

    def see(self, people: Sequence[Place]) -> Sighting | None:
        """Take in one tick of a scene, shown by the camera on the back."""
        body, percepts = self.perception.body, list[Percept]()
        if self._ticks % 4 == 0 and body is not None:
            place, axes, _ = camera_pose(body, HEAD.depth_cameras[1])
            posts: list[Post] = [(x, y, 0.15, 1.7) for x, y in people]
            image = draw(CAMERA, place, axes, posts, self._walls, body.time)
            percepts.append(replace(image, number=1))
        return self._take(percepts)


def test_a_camera_on_the_back_shows_who_comes_from_behind() -> None:
    """At true bearing and distance, wherever the head looks."""
    watch, place = WatchBehind([]), coming(170.0, 0.8, 3.2)
    seen = None
    for tick in range(90):
        seen = watch.see([place(tick * TICK)])
    assert seen is not None and seen.settled
    x, y = place(89 * TICK)
    assert abs(wrap_angle(seen.bearing - atan2(y, x))) < radians(3.0)
    assert seen.distance == pytest.approx(hypot(x, y), abs=0.1)
