"""Test obstacles, shadows, echoes and missed detections."""

from dataclasses import replace
from math import cos, degrees, radians, sin
from typing import Any

import numpy as np
import pytest

from stepaside.core.poses import wrap_angle
from stepaside.perception.depth_detector import Shadow
from stepaside.perception.floor_map import FloorMap
from stepaside.perception.images import SonarEcho
from stepaside.perception.pipeline import (
    FloorMapping,
)
from stepaside.perception.sonar import HALF_CONE, MIN_AGE
from synthetic_cameras import (
    HEAD,
    SUPPORT,
    TICK,
    Eyes,
    axis_of,
    colour,
    depth,
    obstacle,
    show,
    trim,
)

HEARD = [  # sonar, bearing from the heading in [deg], whether it is heard
    ("left", 49.0, True),
    ("left", 51.0, False),
    ("left", -4.0, True),
    ("left", -7.0, False),
    ("right", -49.0, True),
    ("right", -51.0, False),
    ("right", 4.0, True),
    ("right", 7.0, False),
]


class NoFloor(FloorMap):
    """Map without cells, which records the positions of the opponent."""

    def __init__(self) -> None:
        super().__init__()
        self.others: list[Any] = []
        self.wall, self.full = np.inf, False

    def distance_in_cone(self, *cone: float) -> float:
        """Return the distance of a wall."""
        return float(self.wall)

    def is_occupied(self, x: float, y: float) -> bool:
        """Return whether all cells are occupied."""
        return self.full

    def take(self, *arguments: Any) -> None:
        """Record the position of the opponent."""
        self.others.append(arguments[2])


def mapping() -> tuple[Eyes, NoFloor]:
    """Return the eyes of a robot with a map."""
    floor = NoFloor()
    made = Eyes(FloorMapping(floor))
    made.see(0.0)
    return made, floor


@pytest.fixture
def eyes() -> Eyes:
    made = Eyes()
    made.see(0.0)
    return made


@pytest.mark.parametrize("sonar", ["left", "right"])
def test_an_echo_without_track_starts_one_nearby(
    eyes: Eyes, sonar: str
) -> None:
    eyes.see(TICK, SonarEcho(TICK, sonar, None))
    eyes.see(2 * TICK, SonarEcho(2 * TICK, sonar, 0.61))
    assert not eyes.tracks
    eyes.see(3 * TICK, SonarEcho(3 * TICK, sonar, 0.59))
    (track,) = eyes.tracks
    x, y, heading = eyes.torso
    away = track.distance_from(x, y, 3 * TICK)
    assert away == pytest.approx(0.69, abs=5e-4)
    turned = track.bearing_from(x, y, 3 * TICK)
    assert turned == pytest.approx(axis_of(eyes, sonar))
    assert (turned > heading) == (sonar == "left")
    assert track.identified_at == -np.inf and track.ranged_at == 3 * TICK
    assert track.deviation_at(3 * TICK) == pytest.approx(0.25)


def test_an_echo_counts_from_the_sonar() -> None:
    """On a deeper robot it is farther ahead of the axis."""
    distances = []
    for ahead in (0.0, 0.2):
        mount = HEAD.sonars["left"]
        position = mount.position_in_body + ahead * mount.axes_in_body[:, 0]
        sonars = {"left": replace(mount, position_in_body=position)}
        eyes = Eyes(head=replace(HEAD, sonars=sonars))
        eyes.see(TICK, SonarEcho(TICK, "left", 0.4))
        (track,) = eyes.tracks
        distances.append(track.distance_from(*eyes.torso[:2], TICK))
    assert distances[1] - distances[0] == pytest.approx(0.2)


def test_an_echo_updates_the_distance_of_a_track(eyes: Eyes) -> None:
    """Only if its distance was not measured recently."""
    for age, heard in ((MIN_AGE - 0.05, False), (MIN_AGE + 0.05, True)):
        eyes.tracks.clear()
        now = 1.0
        track = eyes.know(
            *eyes.beside(0.8, 0.1), time=now, identified=True, ranged=False
        )
        track.ranged_at = now - age
        eyes.see(now, SonarEcho(now, "left", 0.5))
        x, y, heading = eyes.torso
        away = track.distance_from(x, y, now)
        assert (away < 0.79) == heard
        turned = wrap_angle(track.bearing_from(x, y, now) - heading)
        assert turned == pytest.approx(0.1, abs=0.01)
        if heard:
            part = 0.02**2 / (0.02**2 + 0.06**2)
            assert away == pytest.approx(0.8 - 0.2 * part, abs=2e-3)
        assert len(eyes.tracks) == 1
    assert MIN_AGE == 0.25


@pytest.mark.parametrize(("sonar", "bearing", "heard"), HEARD)
def test_a_sonar_covers_its_own_side(
    eyes: Eyes, sonar: str, bearing: float, heard: bool
) -> None:
    """50 degrees aside, and little across the middle."""
    track = eyes.know(
        *eyes.beside(0.8, radians(bearing)), time=1.0, ranged=False
    )
    eyes.see(1.0, SonarEcho(1.0, sonar, 0.5))
    away = track.distance_from(*eyes.torso[:2], 1.0)
    assert (away < 0.79) == heard
    assert len(eyes.tracks) == 1
    assert degrees(HALF_CONE) == pytest.approx(50.0)


@pytest.mark.parametrize("percept", [colour, depth])
@pytest.mark.parametrize(
    ("bearing", "missed"),
    [(0.0, True), (23.0, True), (-23.0, True), (27.5, False), (-27.5, False)],
)
def test_a_frame_counts_a_miss_only_within_its_view(
    eyes: Eyes,
    monkeypatch: pytest.MonkeyPatch,
    percept: Any,
    bearing: float,
    missed: bool,
) -> None:
    """Within 85 percent of its width: 25.3 of 29.7 degrees."""
    body = eyes.perception.body
    assert body is not None
    show(monkeypatch)
    angle = SUPPORT.theta + radians(bearing)
    place = (
        body.position_head_in_odometry
        + body.axes_head_in_odometry @ HEAD.top.position_in_body
    )
    if percept is depth:
        place = (
            body.position_head_in_odometry
            + body.axes_head_in_odometry @ HEAD.depth[0].position_in_body
        )
    track = eyes.know(place[0] + 1.5 * cos(angle), place[1] + 1.5 * sin(angle))
    eyes.see(TICK, percept(TICK))
    assert track.frames == ((True, False) if missed else (True,))


def test_mapped_obstacles_start_no_track(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """Neither pillars, nor near ones, nor echoes of walls."""
    eyes, _ = mapping()
    alone = len(eyes.tracks)
    show(monkeypatch, obstacle(*eyes.beside(1.0, 0.0)), Shadow(-0.25, 0.25))
    for tick in range(1, 8):
        now = tick * TICK
        eyes.see(now, depth(now), SonarEcho(now, "left", 0.3))
    assert len(eyes.tracks) == alone == 0
    eyes.see(8 * TICK, colour(8 * TICK))
    eyes.detector.found = trim(80.0)
    eyes.see(9 * TICK, colour(9 * TICK))
    assert len(eyes.tracks) == 1


@pytest.mark.parametrize(("gap", "heard"), [(0.2, False), (0.3, True)])
def test_an_echo_near_a_mapped_obstacle_is_ignored(
    gap: float, heard: bool
) -> None:
    eyes, floor = mapping()
    floor.wall = 0.6 + gap
    facing = axis_of(eyes, "left") - eyes.torso.theta
    track = eyes.know(*eyes.beside(0.75, facing), time=-1.0)
    eyes.see(TICK, SonarEcho(TICK, "left", 0.5))
    assert (track.ranged_at == TICK) is heard


def test_a_mapped_obstacle_updates_no_track(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    eyes, floor = mapping()
    track = eyes.know(*eyes.beside(1.0, 0.0))
    show(monkeypatch, obstacle(*eyes.beside(1.05, 0.0)))
    floor.full = True
    eyes.see(TICK, depth(TICK))
    assert track.observed_at == 0.0
    floor.full = False
    eyes.see(2 * TICK, depth(2 * TICK))
    assert track.observed_at == 2 * TICK
