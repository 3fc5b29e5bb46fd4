"""Test a robot of the world as LoLA's server moves it."""

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from stepaside.games.served_player import MOVED, ServedBody
from stepaside.perception.measurement import Measurement


class FakeRobot:
    """A robot of a world, which notes what is asked."""

    def __init__(self) -> None:
        self.world = SimpleNamespace(ticks=0)
        self.readings = 0
        self.written: list[Any] = []
        self.shares: list[Any] = []
        self.servos = SimpleNamespace(soften=self.shares.append)

    weight = 48.0

    def read(self) -> Measurement:
        """Another measurement each time, as noise makes it."""
        self.readings += 1
        nothing = np.zeros(3)
        return Measurement(
            *(float(self.readings), nothing, nothing, nothing, np.zeros(8)),
            None,
        )

    def write(self, targets: Any) -> None:
        """Note it."""
        self.written.append(targets)


def body_of() -> tuple[Any, FakeRobot]:
    robot: Any = FakeRobot()
    return ServedBody(robot), robot


def test_sensors_are_read_once_a_tick_however_often_they_are_asked() -> None:
    body, robot = body_of()
    assert [body.sensors().time for _ in range(3)] == [1.0, 1.0, 1.0]
    robot.world.ticks = 1
    assert [body.sensors().time for _ in range(3)] == [2.0, 2.0, 2.0]


def test_a_robot_in_a_world_that_stands_still_reads_as_one_at_rest() -> None:
    """It has weight on its feet, or it would not be let walk."""
    body, _ = body_of()
    held = body.sensors()
    assert held.accelerometer.tolist() == [0.0, 0.0, 9.81]
    assert held.foot_forces.sum() == pytest.approx(48.0)
    body.let_go()
    assert not body.sensors().accelerometer.any()
    assert body.sensors().time == held.time


def test_a_robot_that_is_held_does_nothing() -> None:
    body, robot = body_of()
    body.command(np.ones(3), np.ones(3))
    assert robot.written == robot.shares == []
    body.let_go()
    body.command(np.ones(3), np.full(3, 0.5))
    assert robot.written[0].tolist() == [1.0] * 3
    assert robot.shares[0].tolist() == [0.5] * 3


def test_a_robot_moves_once_a_target_has_left_the_stance() -> None:
    body, _ = body_of()
    body.let_go()
    stance = np.array([0.1, 0.2])
    for offset, moves in (
        (0.0, False),
        (0.9, False),
        (1.1, True),
        (0.0, True),
    ):
        body.command(stance + [0.0, offset * MOVED], np.ones(2))
        assert body.is_moving == moves


def test_who_only_looks_about_does_not_move() -> None:
    robot: Any = FakeRobot()
    body = ServedBody(robot, head=[1])
    body.let_go()
    for turned in (0.0, 1.0):
        body.command(np.array([0.1, turned]), np.ones(2))
        assert not body.is_moving
    body.command(np.array([0.1 + 1.1 * MOVED, 1.0]), np.ones(2))
    assert body.is_moving
