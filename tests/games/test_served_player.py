"""Test a simulated robot whose joints LoLA's server commands."""

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from stepaside.games.served_player import MOVING, ServedPlayer
from stepaside.perception.measurement import Measurement


class FakeRobot:
    """Simulated robot that records commands."""

    def __init__(self) -> None:
        self.name, self.truth = "evader", None
        self.world = SimpleNamespace(ticks=0)
        self.readings = 0
        self.written: list[Any] = []
        self.shares: list[Any] = []
        self.servos = SimpleNamespace(soften=self.shares.append)

    weight = 48.0

    def read(self) -> Measurement:
        """Return another measurement each time, as with noise."""
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
    return ServedPlayer(robot), robot


def test_sensors_are_read_once_per_tick() -> None:
    body, robot = body_of()
    assert [body.sensors().time for _ in range(3)] == [1.0, 1.0, 1.0]
    robot.world.ticks = 1
    assert [body.sensors().time for _ in range(3)] == [2.0, 2.0, 2.0]


def test_a_waiting_robot_reports_the_sensors_of_one_at_rest() -> None:
    """Without foot forces its client would not let it walk."""
    body, _ = body_of()
    held = body.sensors()
    assert held.accelerometer.tolist() == [0.0, 0.0, 9.81]
    assert held.foot_forces.sum() == pytest.approx(48.0)
    body.begin()
    assert not body.sensors().accelerometer.any()
    assert body.sensors().time == held.time


def test_a_waiting_robot_ignores_commands() -> None:
    body, robot = body_of()
    body.command(np.ones(3), np.ones(3))
    assert robot.written == robot.shares == []
    body.begin()
    body.command(np.ones(3), np.full(3, 0.5))
    assert robot.written[0].tolist() == [1.0] * 3
    assert robot.shares[0].tolist() == [0.5] * 3


def test_a_robot_moves_once_a_target_has_left_the_stance() -> None:
    body, _ = body_of()
    body.begin()
    stance = np.array([0.1, 0.2])
    for offset, moves in (
        (0.0, False),
        (0.9, False),
        (1.1, True),
        (0.0, True),
    ):
        body.command(stance + [0.0, offset * MOVING], np.ones(2))
        assert body.is_moving == moves


def test_head_motion_does_not_count_as_moving() -> None:
    robot: Any = FakeRobot()
    body = ServedPlayer(robot, head=[1])
    body.begin()
    for turned in (0.0, 1.0):
        body.command(np.array([0.1, turned]), np.ones(2))
        assert not body.is_moving
    body.command(np.array([0.1 + 1.1 * MOVING, 1.0]), np.ones(2))
    assert body.is_moving
