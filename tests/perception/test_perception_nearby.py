"""Test obstacles, shadows, echoes and missed detections."""

from dataclasses import replace
from math import degrees, radians
from typing import Any

import numpy as np
import pytest

from stepaside.perception.depth_detector import Shadow
from stepaside.perception.floor_map import FloorMap
from stepaside.perception.images import SonarEcho
from stepaside.perception.observations import HALF_CONE
from stepaside.perception.pipeline import (
    FloorMapping,
)
from synthetic_cameras import (
    HEAD,
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
