"""Test that measurements, plans and records are not changed later."""

from collections.abc import Iterator
from dataclasses import fields, is_dataclass
from pathlib import Path
from typing import Any

import mujoco
import numpy as np
import pytest

import vendor_humanoid as stranger
from stepaside.fitting.leg_detection import find_legs
from stepaside.fitting.model_analysis import analyse_model
from stepaside.games.duel_settings import DuelSettings, StartSettings
from stepaside.games.recorded_game import RecordedGame
from stepaside.games.walker import SimulatedPlayer
from stepaside.planning import (
    Direction,
    Foot,
    GaitSettings,
    ManeuverPlanner,
)
from stepaside.sim.body_settings import BODIES


def arrays_in(value: Any, depth: int = 0) -> Iterator[np.ndarray]:
    """Return all arrays nested in a value."""
    if isinstance(value, np.ndarray):
        yield value
    elif depth > 6:
        return
    elif isinstance(value, dict):
        for each in value.values():
            yield from arrays_in(each, depth + 1)
    elif isinstance(value, list | tuple):
        for each in value:
            yield from arrays_in(each, depth + 1)
    elif is_dataclass(value) and not isinstance(value, type):
        for field in fields(value):
            yield from arrays_in(getattr(value, field.name), depth + 1)


class Kept:
    """Values, and what was in them when they were kept."""

    def __init__(self) -> None:
        self._arrays: list[tuple[str, np.ndarray, np.ndarray]] = []

    def keep(self, name: str, value: Any) -> None:
        """Store a value under a name."""
        for array in arrays_in(value):
            self._arrays.append((name, array, array.copy()))

    def check(self) -> None:
        """Check that all stored values are unchanged."""
        names = {name for name, *_ in self._arrays}
        for name, array, before in self._arrays:
            np.testing.assert_array_equal(array, before, err_msg=name)
        assert names


@pytest.mark.parametrize("body", ["ideal", "hardware"])
def test_values_returned_by_a_duel_do_not_change_later(
    body: str,
) -> None:
    """Measurements, targets, plans, snapshots and recorded arrays."""
    settings = DuelSettings(
        duration=3.0, start=StartSettings(0.7, 0.1, 0.1), body=BODIES[body]
    )
    duel, kept = RecordedGame(settings, endless=True), Kept()
    ticks = 0
    walker = duel.in_physics.players[1]
    assert isinstance(walker, SimulatedPlayer)
    robot: Any = walker.robot
    read, write = robot.read, robot.write

    def note(**parts: bool) -> Any:
        measured = read(**parts)
        kept.keep("measurement", tuple(measured))
        return measured

    def send(targets: Any) -> None:
        write(targets)
        if ticks % 25 == 0:
            kept.keep("targets", targets)

    robot.read, robot.write = note, send
    while duel.world.time < 3.0:
        if ticks % 25 == 0:
            kept.keep("snapshot", walker.snapshot())
            kept.keep("posture", robot.posture)
            kept.keep(
                "truth",
                (
                    robot.truth.position_torso_in_world,
                    robot.truth.position_reference_in_world,
                ),
            )
            kept.keep("plan", walker.scheme.state.plan)
        if ticks == 300:
            kept.keep("tracks", duel.recorder.tracks())
        assert duel.tick() is None
        ticks += 1
    duel.world.close()
    kept.check()


def test_detected_legs_do_not_depend_on_the_posture(
    tmp_path: Path,
) -> None:
    """Also after the model has moved to another posture."""
    path = stranger.mjcf(tmp_path)
    found = analyse_model(path, [])
    kept = Kept()
    legs = find_legs(found.model, found.data, path)
    kept.keep("legs", legs)
    kept.keep("survey", found.legs)
    random = np.random.default_rng(3)
    found.data.qpos[7:] = random.uniform(-0.5, 0.5, found.model.nq - 7)
    found.data.qpos[:3] = 5.0
    mujoco.mj_forward(found.model, found.data)
    kept.check()


def test_plans_do_not_change_after_planning() -> None:
    planner, kept = ManeuverPlanner(GaitSettings()), Kept()
    for bearing in (0.3, -0.8, 1.2):
        for foot in Foot:
            plan = planner.plan(
                bearing, Direction.BACKWARD, first_foot=foot, standing=True
            )
            kept.keep("plan", plan)
            kept.keep("samples", plan.sample([0.0, 0.5, 1.0]))
    kept.check()
