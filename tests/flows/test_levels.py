"""One duel at every level and by every door."""

from math import atan2, degrees, pi, radians, remainder, tau
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import stepaside as sa
from flows import calls
from flows.calls import arena_duel, kept_summary, play_duel, trajectories
from flows.circles import PACE, apart, arc, circle

ASIDE = "evasion(safety_radius=100)"

START = (0.92, radians(-40.0), radians(40.0))  # [m], [rad], [rad]
SECONDS = 32.0
FILE = f"""
duration = {SECONDS}

[[players]]
name = "red"
role = "pursuer"
start = [0.0, 0.0, {START[1]}]

[[players]]
name = "blue"
role = "evader"
start = [{START[0]}, 0.0, {pi + START[2]}]
evasion = {{ safety_radius = 1.2 }}
"""


@pytest.fixture(scope="module")
def duel() -> sa.Run:
    return play_duel(START, SECONDS, safety_radius=1.2)


@pytest.fixture(scope="module")
def folders(tmp_path_factory: pytest.TempPathFactory) -> dict[str, Path]:
    """Run folders of the game file by level."""
    folder = tmp_path_factory.mktemp("levels")
    (folder / "two.toml").write_text(FILE)
    levels = ("unicycle", "steps", "physics")
    for level in levels:
        kept_summary(
            "run", folder / level, folder / "two.toml", "--level", level
        )
    return {level: folder / level for level in levels}


def test_a_duel_from_python_ends_on_the_circle(duel: sa.Run) -> None:
    goal = circle()
    assert duel.outcome is sa.Outcome.COMPLETED
    assert duel.theory is not None
    assert duel.theory == pytest.approx((goal.radius, goal.distance, 90.0))
    late = duel.times >= 2 * SECONDS / 3
    assert duel.distance[late].mean() == pytest.approx(goal.distance, rel=0.03)
    assert duel.orientation[late].mean() == pytest.approx(90.0, abs=3.0)
    for track in (duel.pursuer, duel.evader):
        assert track.place is not None
        radius, pace = arc(duel.times, track.place, 12.0, SECONDS - 1.0)
        assert radius == pytest.approx(goal.radius, rel=0.03)
        assert pace == pytest.approx(PACE, rel=0.03)
    torsos = apart(duel.pursuer.torso, duel.evader.torso)
    closest = duel.summary.min_distance_m
    # Of the torso points, which are less than 2 cm from the origins.
    assert closest == pytest.approx(torsos.min(), abs=0.04)
    assert duel.summary.distance_m == pytest.approx(
        duel.distance[late].mean(), abs=1e-3
    )


@pytest.mark.parametrize("level", ["unicycle", "steps", "physics"])
def test_a_game_of_two_ends_on_the_circle_at_each_level(
    level: str, folders: dict[str, Path], duel: sa.Run
) -> None:
    goal = circle()
    kept = trajectories(folders[level])
    red, blue = kept["red_place"], kept["blue_place"]
    late = kept["times_s"] >= 2 * SECONDS / 3
    near = apart(red, blue)
    assert near[late].mean() == pytest.approx(goal.distance, rel=0.03)
    turned = abs(red - blue)[late, 2].mean()
    headings = degrees(abs(remainder(turned, tau)))
    assert headings == pytest.approx(90.0, abs=2.0)
    radius, pace = arc(kept["times_s"], blue, 12.0, SECONDS - 1.0)
    assert radius == pytest.approx(goal.radius, rel=0.03)
    assert pace == pytest.approx(PACE, rel=0.03)
    # All begin alike and pass the same closest approach, but for sway.
    assert tuple(red[0]) == pytest.approx((0.0, 0.0, START[1]), abs=1e-6)
    assert near.min() == pytest.approx(duel.distance.min(), abs=0.03)


def test_a_game_in_physics_is_the_duel(
    folders: dict[str, Path], duel: sa.Run
) -> None:
    kept = trajectories(folders["physics"])
    near = apart(kept["red_place"], kept["blue_place"])
    assert len(near) == len(duel.times)
    np.testing.assert_allclose(near[:500], duel.distance[:500], atol=1e-3)


def test_a_game_of_steps_begins_at_once(folders: dict[str, Path]) -> None:
    kept = trajectories(folders["steps"])
    red = kept["red_place"]
    walks = np.hypot(*(red - red[0])[:, :2].T) > 1e-6
    assert kept["times_s"][walks.argmax()] == pytest.approx(0.02)


def play_by_the_paper(**settings: Any) -> dict[str, Any]:
    """Play an episode of the environment with the paper's evader.

    Its observation begins with the distance and the cosine and sine of the
    bearing of the pursuer.
    """
    environment = arena_duel(**settings)
    observed, info = environment.reset(seed=0)
    side = 0
    ended = False
    while not ended:
        bearing = atan2(observed[2], observed[1])
        if side == 0 or side * bearing > radians(20.0):
            side = -1 if bearing > 0 else 1
        heading = remainder(bearing + side * pi / 2, tau)
        observed, _, over, late, info = environment.step([heading, 1.0])
        ended = over or late
    return dict(info)


def test_an_episode_is_the_game_of_the_tournament() -> None:
    """Arena and start are those of its seed; the evader is the paper's."""
    pytest.importorskip("gymnasium")
    pytest.importorskip("pettingzoo")
    (row,) = calls.rows_of(
        "tournament",
        *calls.changes(level="steps", floor="open", seed="3:4"),
        *calls.changes(evader=ASIDE, pursuer="pursuit", duration=60),
    )
    goal = circle()
    assert row["number"] == 1 and row["survived"]["share"] == 1.0
    assert row["circle_m"]["mean"] == pytest.approx(goal.distance)
    steps = play_by_the_paper(level="steps", arenas=1, first_arena=3)
    assert steps["closest_m"] == pytest.approx(
        row["closest_m"]["mean"], abs=1e-6
    )
    unicycle = play_by_the_paper(level="unicycle", arenas=1, first_arena=3)
    for info in (steps, unicycle):
        assert info["distance_m"] == pytest.approx(goal.distance, rel=0.01)
        assert info["closest_m"] == pytest.approx(steps["closest_m"], abs=0.01)
