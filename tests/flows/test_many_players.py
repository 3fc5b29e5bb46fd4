"""Games of more than two: pursuers, teams, a polygon, a crowd."""

from itertools import combinations
from math import atan2, pi, sin
from pathlib import Path

import numpy as np
import pytest

from flows import calls
from flows.calls import Arrays, kept_summary, summary, trajectories
from flows.circles import GAIN, PACE, SPEED, apart

EXAMPLES = Path(__file__).parents[2] / "examples"
CROWD = """
duration = 16.0
level = "steps"

[room]
width = 6.0
depth = 6.0

[[players]]
name = "robot"
role = "evader"
strategy = "goal"
start = [-0.9, 0.0, 0.0]
goal = [0.0, 0.0]

[[players]]
name = "person"
count = 4
body = "person"
draws_goal = true
crowd = { speed = 0.8, returns = true }
"""


def test_two_pursuers_walk_at_their_evader(tmp_path: Path) -> None:
    """In physics; each pair's closest approach is that of its arrays."""
    game = EXAMPLES / "two-pursuers.toml"
    seen = kept_summary("run", tmp_path / "run", game, "--duration", 10)
    assert seen["outcome"] == "completed" and seen["fallen"] == []
    assert len(seen["pairs"]) == 3
    kept = trajectories(tmp_path / "run")
    for both, pair in seen["pairs"].items():
        one, other = (kept[f"{name}_torso"] for name in both.split(" - "))
        near = apart(one, other)
        # Torso points are less than 2 cm from the origins of the torsos.
        assert pair["closest_m"] == pytest.approx(near.min(), abs=0.04)
        assert pair["captured_at_s"] is None
        if "blue" in both:
            assert near[-1] < near[0] - 0.2
    paths = {name: own["path_m"] for name, own in seen["players"].items()}
    for name in ("ruby", "scarlet"):
        assert paths[name] == pytest.approx((10.0 - 0.8) * PACE, rel=0.03)
    assert paths["blue"] < 0.3  # it stands until one is near


def test_an_evader_that_knows_its_pursuers_is_not_captured() -> None:
    """Three assigned pursuers catch one of two who each know one of them."""
    found = calls.rows_of(
        EXAMPLES / "teams.toml",
        *calls.changes(pursuers="assigned"),
        *calls.changes(evaders=["evasion", "team-evasion"]),
        *calls.changes(seed="2:3", duration=45),
    )
    rows = {row["evaders"]: row for row in found}
    caught, free = rows["evasion"], rows["team-evasion"]
    assert caught["number"] == free["number"] == 1
    assert caught["captured"]["count"] == 1
    assert caught["closest_m"]["min"] <= 0.35
    assert free["captured"]["count"] == 0
    assert free["closest_m"]["min"] > 0.35


def test_an_evader_leaves_between_pursuers_at_a_right_angle(
    tmp_path: Path,
) -> None:
    """Away from both, along the bisector, and not away from one."""
    kept = played(
        tmp_path / "gap",
        ("red", "pursuer", "pursuit", 1.0, 0.0, pi),
        ("ruby", "pursuer", "pursuit", 0.0, 1.0, -pi / 2),
        ("blue", "evader", "team-evasion", 0.0, 0.0, 0.0),
    )
    x, y, heading = kept["blue_place"][-1]
    assert atan2(-y, -x) == pytest.approx(pi / 4, abs=0.1)
    assert heading == pytest.approx(pi / 4, abs=0.1)


def pursuit_of_standing(
    folder: Path, strategy: str, *evaders: tuple[float, float]
) -> Arrays:
    """Two pursuers, 1 m apart at x = 0, walk 16 s at evaders that stand."""
    return played(
        folder,
        ("red", "pursuer", strategy, 0.0, 0.0, 0.0),
        ("ruby", "pursuer", strategy, 0.0, 1.0, 0.0),
        *(
            (f"evader-{n}", "evader", "stand", *at, 0.0)
            for n, at in enumerate(evaders)
        ),
    )


def played(
    folder: Path, *players: tuple[str, str, str, float, float, float]
) -> Arrays:
    """Play 16 s of steps; name, role, strategy and start of each."""
    text = 'duration = 16.0\nlevel = "steps"\n'
    for name, role, plays, *start in players:
        text += f"""
[[players]]
name = "{name}"
role = "{role}"
strategy = "{plays}"
start = {start}
"""
    folder.mkdir()
    (folder / "game.toml").write_text(text)
    kept_summary("run", folder / "run", folder / "game.toml")
    return trajectories(folder / "run")


def test_assigned_pursuers_take_the_evaders_of_least_total_distance(
    tmp_path: Path,
) -> None:
    """Crosswise by name: the first evader is before the second pursuer."""
    kept = pursuit_of_standing(
        tmp_path / "assigned", "assigned", (2.0, 1.0), (2.0, 0.0)
    )
    assert kept["red_place"][-1, 0] > 0.9 and kept["ruby_place"][-1, 0] > 0.9
    assert abs(kept["red_place"][:, 1]).max() < 0.05
    assert abs(kept["ruby_place"][:, 1] - 1.0).max() < 0.05


def test_pursuers_of_a_pincer_come_from_two_sides(tmp_path: Path) -> None:
    """Their directions from the evader part by more than straight on.

    Those of the paper's pursuers grow by 0.2 rad, as they turn slowly.
    """
    kept = pursuit_of_standing(tmp_path / "pincer", "pincer", (2.0, 0.5))
    x, y = np.transpose(
        [kept[f"{name}_place"][-1, :2] for name in ("red", "ruby")]
    )
    low, high = np.arctan2(y - 0.5, 2.0 - x)
    assert high - low > 2 * atan2(0.5, 2.0) + 0.45


def test_cyclic_pursuit_ends_on_its_polygon() -> None:
    """R = v/ω with ω = kπ/n, and sides of 2R sin(π/n)."""
    radius = SPEED / (GAIN * pi / 3)
    side = 2 * radius * sin(pi / 3)
    assert (radius, side) == pytest.approx((0.4775, 0.8270), abs=1e-4)
    game = EXAMPLES / "cyclic-pursuit.toml"
    seen = summary("run", "game", game, "--level", "steps")
    assert seen["outcome"] == "completed" and len(seen["players"]) == 3
    for player in seen["players"].values():
        assert player["radius_m"] == pytest.approx(radius, rel=0.01)
    for pair in seen["pairs"].values():
        assert pair["distance_m"] == pytest.approx(side, rel=0.01)
        assert pair["angle_deg"] == pytest.approx(120.0, abs=0.5)


def test_a_robot_crosses_a_crowd(tmp_path: Path) -> None:
    """The summary says what its arrays say of people and the goal."""
    (tmp_path / "crowd.toml").write_text(CROWD)
    seen = kept_summary("run", tmp_path / "run", tmp_path / "crowd.toml")
    own = seen["players"]["robot"]
    robot = own["crowd"]
    kept = trajectories(tmp_path / "run")
    names = [f"person-{n}" for n in range(1, 5)]
    assert robot["people"] == len(names)
    people = [kept[f"{name}_place"] for name in names]
    place, times = kept["robot_place"], kept["times_s"]
    near = np.min([apart(place, each) for each in people], axis=0)
    step = times[1] - times[0]
    for limit, key in ((0.45, "intimate_s"), (1.2, "personal_s")):
        below = (near < limit).sum() * step
        assert robot[key] == pytest.approx(below, abs=0.1)
    assert robot["personal_s"] > 0.5
    assert near.min() > 0.39 and robot["collisions"] == 0
    assert robot["success"] is True
    there = np.hypot(*place[-1, :2])
    assert there < 0.5 and own["goal_at_s"] == pytest.approx(
        times[-1], abs=0.1
    )
    # People keep off each other and inside of the room.
    for each in people:
        assert abs(each[:, :2]).max() < 3.0
    for one, other in combinations(people, 2):
        assert apart(one, other).min() > 0.2
