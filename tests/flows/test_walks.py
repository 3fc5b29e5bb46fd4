"""Walks of one humanoid: pushes, the fast gait, people, MPC."""

from math import sqrt
from typing import Any

import numpy as np
import pytest

import stepaside as sa
from flows.calls import summary
from flows.circles import PACE

FAST = 0.083 / (0.28 + 0.04)  # [m/s], stride over the time of a step
MASS = 5.3  # [kg], of NAO, about
RATE = sqrt(9.81 / 0.268)  # [1/s], of the pendulum
HALF_SOLE = 0.035  # [m], from the ankle to the inner edge
SPACING = 0.1  # [m], between the feet


def pushed(impulse: float, *options: object) -> Any:
    """A walk that is pushed to its left after 3 s.

    Args:
        impulse: Impulse, in [N s].
        options: Other options of the command.
    """
    push = f"{impulse}@3:90deg"
    return summary("run", "walk", "--duration", 6, "--push", push, *options)


def shift(impulse: float) -> float:
    """How far a push moves the divergent component of motion, in [m]."""
    return impulse / (MASS * RATE)


def test_a_push_within_the_bound_leaves_the_walker_upright() -> None:
    """The sole alone can hold it."""
    impulse = 0.4
    assert shift(impulse) < HALF_SOLE
    seen = pushed(impulse)
    assert seen["outcome"] == "completed"
    assert seen["walking"]["push_impulse_n_s"][1] == pytest.approx(
        impulse, rel=0.01
    )
    assert seen["walking"]["tilt_max_deg"] < 10.0
    assert seen["walking"]["speed_m_s"] == pytest.approx(PACE, rel=0.1)


def test_a_push_beyond_the_bound_fells_it_and_the_run_says_so() -> None:
    """No foot within reach lands under the divergent component."""
    impulse = 6.0
    assert shift(impulse) > HALF_SOLE + SPACING
    seen = pushed(
        impulse,
        "--set",
        "control.feedback=true",
        "--set",
        "control.method=measured",
    )
    assert seen["outcome"] == "fall"
    assert "walker fell at" in seen["message"]
    assert 3.0 < seen["duration_s"] < 5.0
    assert seen["walking"]["tilt_max_deg"] > 30.0


def test_mpc_holds_a_push_that_fells_an_open_loop() -> None:
    impulse = 1.1
    blind = pushed(impulse)
    assert blind["outcome"] == "fall"
    seen = pushed(
        impulse,
        "--set",
        "control.feedback=true",
        "--set",
        "control.method=mpc",
    )
    assert seen["outcome"] == "completed"
    solver = seen["walking"]["solver"]
    assert solver["solves"] > 500 and solver["infeasible"] == 0
    assert seen["walking"]["tilt_max_deg"] < 10.0


def test_mpc_without_a_push_walks_the_plan() -> None:
    """Where no constraint is active its solution is the closed form."""
    walks = [
        sa.run_game(
            sa.walk(
                duration=4.0,
                control=sa.ControlSettings(method=method, feedback=True),
            )
        )
        for method in ("measured", "mpc")
    ]
    plain, mpc = (np.asarray(walk.walker.com) for walk in walks)
    assert abs(plain - mpc).max() < 1e-3
    travelled = plain[-1, 0] - plain[0, 0]
    assert travelled == pytest.approx((4.0 - 1.0 - 0.8) * PACE, rel=0.15)


def test_the_fast_gait_walks_at_its_pace() -> None:
    seen = summary("run", "walk", "--gait", "fast", "--duration", 6)
    assert seen["outcome"] == "completed"
    assert seen["walking"]["speed_m_s"] == pytest.approx(FAST, rel=0.03)
    steps = seen["planning"]["steps"]
    assert steps == pytest.approx((6.0 - 1.0 - 0.44) / 0.32, abs=3)


PERSON = (
    *("duel", "--gait", "fast", "--pursuer", "person"),
    *(
        "--set",
        "person.path=straight",
        "--set",
        "person.speed=1",
        "--duration",
        9,
    ),
)


def test_a_person_walks_into_a_robot_that_stands() -> None:
    seen = summary(*PERSON, "--strategy", "stand")
    assert seen["outcome"] == "contact"
    assert set(seen["touched"]) == {"evader", "pursuer"}


def test_the_fast_gait_evades_a_person() -> None:
    """Begun when contact, at 0.7 m, is 3.5 s away; the clearance is kept."""
    seen = summary(*PERSON)
    assert seen["outcome"] == "completed" and seen["touched"] == []
    assert seen["triggered_at_distance_m"] == pytest.approx(
        0.7 + 3.5 * 1.0, abs=0.05
    )
    assert seen["min_distance_m"] > 0.7
