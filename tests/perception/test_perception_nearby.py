"""Test obstacles and shadows where the floor is mapped."""

from typing import Any

import pytest

from stepaside.perception.depth_detector import Shadow
from stepaside.perception.floor_map import FloorMap
from synthetic_cameras import TICK, Eyes, colour, depth, obstacle, show, trim


class NoFloor(FloorMap):
    """Map without cells, which records the positions of the opponent."""

    def __init__(self) -> None:
        super().__init__()
        self.others: list[Any] = []
        self.full = False

    def is_occupied(self, x: float, y: float) -> bool:
        """Return whether all cells are occupied."""
        return self.full

    def take(self, *arguments: Any) -> None:
        """Record the position of the opponent."""
        self.others.append(arguments[2])


def mapping() -> tuple[Eyes, NoFloor]:
    """Return the eyes of a robot with a map."""
    floor = NoFloor()
    made = Eyes(floor=floor)
    made.see(0.0)
    return made, floor


def test_mapped_obstacles_start_no_track(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """Neither pillars, nor near ones."""
    eyes, _ = mapping()
    alone = len(eyes.tracks)
    show(monkeypatch, obstacle(*eyes.beside(1.0, 0.0)), Shadow(-0.25, 0.25))
    for tick in range(1, 8):
        now = tick * TICK
        eyes.see(now, depth(now))
    assert len(eyes.tracks) == alone == 0
    eyes.see(8 * TICK, colour(8 * TICK))
    eyes.detector.found = trim(80.0)
    eyes.see(9 * TICK, colour(9 * TICK))
    assert len(eyes.tracks) == 1


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
