"""Test that an evader keeps its plan with an inaccurate, changing map."""

from dataclasses import replace
from typing import Any

import numpy as np

from fake_robot import GAIT
from stepaside.arena import (
    Disc,
    Obstacle,
    ObstacleSet,
    Polygon,
    Room,
    RoomRecipe,
    generate_room,
)
from stepaside.control.strategy_runner import StrategyRunner
from stepaside.core.poses import Pose
from stepaside.games import play_strategies
from stepaside.locomotion.guard import KnownRoom, MappedRoom
from stepaside.perception.floor_map import CELL, FloorMap
from stepaside.perception.measurement import Sighting
from stepaside.planning import Direction
from stepaside.strategies import Intent, Knowledge, Pursuit
from stepaside.strategies.look_ahead import LookAhead
from stepaside.strategies.strategy_game import StepGame


class Flickering:
    """Looks ahead by a map whose discs and walls jump by some centimetres."""

    saturated = False

    def __init__(self, map_error: float) -> None:
        self.random = np.random.default_rng(5)
        self.inner, self.map_error = LookAhead(), map_error
        self.direction = self.inner.direction
        self.headings: list[float] = []

    def begin(self) -> Any:
        """As it does."""
        return self.inner.begin()

    def decide(self, known: Knowledge, memory: Any) -> tuple[Intent, Any]:
        """Choose by what the map shows now."""
        shown: list[Obstacle] = []
        for solid in known.obstacles_in_map:
            off = self.random.uniform(0.03, 0.09)
            if isinstance(solid, Disc):
                shown.append(replace(solid, radius=solid.radius + off))
            else:
                middle = solid.points.mean(axis=0)
                away = solid.points - middle
                points = middle + away + off * np.sign(away)
                shown.append(Polygon(tuple(map(tuple, points.tolist()))))
        known = replace(
            known,
            obstacles_in_map=ObstacleSet(shown),
            map_error=self.map_error,
        )
        intent, memory = self.inner.decide(known, memory)
        self.headings.append(intent.heading)
        return intent, memory


def turned(map_error: float) -> int:
    """How often an evader turns from one side to the other, in a minute."""
    evader, changes = Flickering(map_error), 0
    for seed in (0, 2):
        room = generate_room(RoomRecipe(3.0, 3.0, discs=3), seed)
        assert room.starts is not None
        game = StepGame(duration=30.0)
        play_strategies(Pursuit(), evader, room.starts, room=room, game=game)
        changes += int((np.abs(np.diff(evader.headings)) > 3.0).sum())
    return changes


def test_plans_change_less_with_a_map_error() -> None:
    assert turned(CELL) < 0.5 * turned(0.0)


class Noting:
    """Stands, and notes what it is told."""

    direction, saturated = Direction.BACKWARD, False

    def __init__(self) -> None:
        self.told: list[Knowledge] = []

    def begin(self) -> None:
        """Return no memory."""

    def decide(self, knowledge: Knowledge, memory: Any) -> tuple[Intent, Any]:
        """Stand."""
        self.told.append(knowledge)
        return Intent(moving=False), memory


def test_knowledge_contains_the_map_error() -> None:
    given = KnownRoom(Room(), Pose(0.0, 0.0, 0.0))
    seen = MappedRoom(FloorMap(), unknown_is_free=False)
    for around, map_error in ((None, 0.0), (given, 0.0), (seen, CELL)):
        strategy = Noting()
        decisions = StrategyRunner(strategy, GAIT, around)
        decisions.headings.note(0.0, 0.0)
        decisions.templates.note(0.0, Pose(0.0, 0.0, 0.0))
        decisions.decide(0.0, Sighting(0.0, 0.0, 1.0), moving=True)
        assert [known.map_error for known in strategy.told] == [map_error]
