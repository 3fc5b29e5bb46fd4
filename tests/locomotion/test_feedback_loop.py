"""Test balance control: open loop and feedback."""

from dataclasses import replace
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from fake_robot import measure
from stepaside.core.poses import Pose
from stepaside.locomotion.zmp.control_settings import OPEN_LOOP, STABILISED
from stepaside.locomotion.zmp.feedback_loop import (
    ClosedLoop,
    OpenLoop,
    build_balance,
)
from stepaside.locomotion.zmp.reference_table import (
    ReferenceTable,
    resting_sample,
    standing_reference,
)
from stepaside.planning import GaitSettings
from stepaside.robots.description import load_robot
from stepaside.robots.leg_kinematics import LegKinematics

NAO = load_robot("nao")
GAIT = GaitSettings()
LEFT, RIGHT = Pose(0.0, 0.05, 0.0), Pose(0.0, -0.05, 0.0)


class Noting:
    """Mock that records its calls and answers by name."""

    def __init__(self) -> None:
        self.asked: list[tuple[Any, ...]] = []

    def __getattr__(self, name: str) -> Any:
        """Answer any method by its name."""

        def method(*arguments: Any) -> str:
            self.asked.append((name, *arguments))
            return f"answer to {name}"

        return method


def stabiliser(**changes: Any) -> Any:
    """Stabiliser that only records its calls."""
    made = Noting()
    values: dict[str, Any] = {
        "state": None,
        "adapted": 5,
        "ready": False,
        "zmp_shift": (0.0, 0.0),
        "zmp_feedback": SimpleNamespace(solved="solved"),
        "estimator": SimpleNamespace(tilt=(0.1, 0.2), torso_heading=0.3),
        "joints": Noting(),
    } | changes
    for name, value in values.items():
        setattr(made, name, value)
    return made


def unasked(*_: Any) -> Any:
    raise AssertionError("must not be called")


def resting_table() -> ReferenceTable:
    table = ReferenceTable(0.004)
    table.rest(resting_sample(LEFT, RIGHT, GAIT))
    return table


def test_feedback_adds_the_load_feedforward() -> None:
    """Scaled by the load fraction, for the commanded body and shifted ZMP."""
    gains = SimpleNamespace(load_share=0.5)
    fake = stabiliser(
        zmp_shift=(0.01, -0.02),
        settings=SimpleNamespace(stabiliser=gains),
        joints=SimpleNamespace(update=lambda angles, targets: 2.0 * targets),
    )
    asked: list[Any] = []

    def added(*told: Any) -> np.ndarray:
        asked.append(told)
        return np.array([0.2, 0.4, 0.6])

    loads: Any = SimpleNamespace(added=added)
    legs: Any = SimpleNamespace(track=lambda body: np.ones(3))
    loop = ClosedLoop(fake, legs, loads)
    measurement = measure(1.0)._replace(joint_positions=np.zeros(3))
    table: Any = SimpleNamespace(
        sample=lambda index: SimpleNamespace(zmp=(0.3, 0.1))
    )
    found = loop.targets(measurement, table, 7, lambda now: "step")  # type: ignore[arg-type,return-value]
    np.testing.assert_allclose(found, [2.1, 2.2, 2.3])  # type: ignore[arg-type]
    ((body, zmp),) = asked
    assert body == "answer to update" and zmp == pytest.approx((0.31, 0.08))


def test_settings_open_or_close_the_loop() -> None:
    legs = LegKinematics(NAO, tick=0.012)
    legs.stand(standing_reference(LEFT, RIGHT, GAIT))
    options: dict[str, Any] = {
        "tick": 0.012,
        "delay": 0.036,
        "kinematics": legs,
    }
    loop = build_balance(NAO, GAIT, OPEN_LOOP, **options)
    assert isinstance(loop, OpenLoop)
    targets = loop.targets(measure(0.0), resting_table(), 0, unasked)
    assert np.abs(targets - legs.joint_targets).max() > 1e-4
    closed = build_balance(NAO, GAIT, STABILISED, **options)
    assert isinstance(closed, ClosedLoop)
    made = closed.stabiliser
    assert made.settings is STABILISED and not closed.ready
    assert made.tick == 0.012 and made.delay_ticks == 3
    assert made.lean == 0.0
    leaning = replace(NAO, lean=0.1)
    bent = build_balance(leaning, GAIT, STABILISED, **options)
    assert isinstance(bent, ClosedLoop) and bent.stabiliser.lean == 0.1
