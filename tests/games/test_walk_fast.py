"""Test the fast gait in physics: speed, tracking and tilt."""

from dataclasses import replace
from math import pi
from typing import Any

import pytest

from stepaside.games.game_settings import walk
from stepaside.games.recorded_game import run_game
from stepaside.locomotion.control_settings import ControlSettings
from stepaside.planning import PRESETS, GaitSettings
from stepaside.sim.body_settings import BODIES

FAST = PRESETS["fast"]
CONTROL = ControlSettings("closed-form", True)


def walked(
    gait: GaitSettings = FAST,
    body: str = "ideal",
    *,
    bearing: float = 0.0,
    backward: bool = False,
    duration: float = 7.0,
) -> dict[str, Any]:
    """Return the summary of a walk without a fall."""
    settings = walk(
        seed=3,
        duration=duration,
        bearing=bearing,
        backward=backward,
        gait=gait,
        body=BODIES[body],
        control=CONTROL,
    )
    found = run_game(settings).results()
    assert found["outcome"] == "completed"
    walking: dict[str, Any] = found["walking"]
    return walking


@pytest.mark.parametrize(
    ("bearing", "backward"), [(pi / 4, True), (-pi / 4, False)]
)
def test_a_hardware_like_body_walks_as_fast(
    bearing: float, backward: bool
) -> None:
    found = walked(
        body="hardware", bearing=bearing, backward=backward, duration=10.0
    )
    assert found["speed_m_s"] >= 0.23
    for ratio in (found["speed_ratio"], found["yaw_ratio"]):
        assert ratio == pytest.approx(1.0, abs=0.06)


def test_without_the_swing_reaction_the_torso_rocks() -> None:
    """And the ZMP is far from its reference."""
    planned = walked(backward=True)
    ignored = walked(replace(FAST, swing_reaction=0.0), backward=True)
    assert ignored["tilt_max_deg"] > 1.5 * planned["tilt_max_deg"]
    for axis in "xy":
        off = [
            found["tracking"][f"com_{axis}_m"] for found in (planned, ignored)
        ]
        assert off[1] > 1.5 * off[0]
