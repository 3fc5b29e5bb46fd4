"""Tournaments, campaigns of walks and people, and games of files."""

from math import sqrt
from pathlib import Path

import pytest

from flows import calls
from flows.own_strategies import FILE

ASIDE = "evasion(safety_radius=100)"

STRIDE, CAPTURE = 0.04, 0.35  # [m]
STILL, STRAIGHT = f"{FILE}:Still", f"{FILE}:Straight"
NORMAL = 1.959964  # two-sided quantile of 95 % of a normal distribution


def wilson(number: int, of: int) -> tuple[float, float]:
    """Return the 95 % interval of a share by Wilson's score."""
    share, square = number / of, NORMAL**2 / of
    middle = (share + 0.5 * square) / (1.0 + square)
    spread = sqrt(share * (1.0 - share) * square + 0.25 * square**2)
    half = spread / (1.0 + square)
    return middle - half, middle + half


def test_a_tournament_tells_how_each_game_ended() -> None:
    """Who stands is caught, who walks straight on meets a wall."""
    rows = calls.rows_of(
        "tournament",
        *calls.changes(evader=[STILL, STRAIGHT, ASIDE], seed="0:3"),
        *calls.changes(duration=60),
    )
    still, straight, aside = rows
    assert [row["evader"] for row in rows] == [STILL, STRAIGHT, ASIDE]
    for name, shares in (
        ("captured", [1.0, 0.0, 0.0]),
        ("touched_obstacle", [0.0, 1.0, 0.0]),
        ("survived", [0.0, 0.0, 1.0]),
    ):
        assert [row[name]["share"] for row in rows] == shares
    assert CAPTURE - STRIDE <= still["closest_m"]["mean"] <= CAPTURE
    assert 0.0 < straight["survived_s"]["mean"] < 3.0 * sqrt(2.0) / 0.1
    assert aside["survived_s"]["mean"] == pytest.approx(60.0)
    for row, survived in zip(rows, (0, 0, 3), strict=True):
        interval = row["survived"]["low"], row["survived"]["high"]
        assert interval == pytest.approx(wilson(survived, 3), abs=1e-6)


def test_a_campaign_of_walks_is_those_walks() -> None:
    """On the roughest floor; on the flattest one none falls."""
    flat, rough = calls.rows_of(
        "robustness",
        *calls.changes(method="open-loop", seed="3:4"),
        *calls.changes(disturbance=["unevenness 0 mm", "unevenness 8 mm"]),
    )
    alone = calls.walk_on_uneven_floor(0.008, seed=3)
    assert alone["outcome"] == "fall"
    assert (flat["survived"]["count"], rough["survived"]["count"]) == (1, 0)
    for row in (flat, rough):
        interval = row["survived"]["low"], row["survived"]["high"]
        assert row["number"] == 1
        assert interval == pytest.approx(
            wilson(row["survived"]["count"], 1), abs=1e-6
        )


def test_people_touch_a_standing_robot_if_their_path_leads_through_it() -> (
    None
):
    """They pass at the offset of their path, from any side.

    The legs of a person, which are at the height of a NAO, reach 0.15 m to
    the side, the NAO as far as its arms, 0.2 m. In between it depends on the
    side from which they come, and on the swing of the legs.
    """
    rows = calls.rows_of(
        "people",
        *calls.changes(person="straight", drawn="true", seed="0:5"),
        *calls.changes(speed=1.0, bearing=0),
        *calls.changes(evader__strategy="stand", senses="lidar"),
        *("--by", "offset"),
    )
    through = [row for row in rows if abs(row["offset"]) < 0.15]
    beside = [row for row in rows if abs(row["offset"]) > 0.4]
    assert through and beside
    for row in through:
        assert row["contact"]["count"] == row["number"] == 1
        assert row["triggered"]["count"] == 0
        assert 0.1 < row["closest_m"]["mean"] < 0.5
    for row in beside:
        assert row["contact"]["count"] == 0 and row["number"] == 1
        passed = row["closest_m"]["mean"]
        assert passed == pytest.approx(abs(row["offset"]), abs=0.02)


@pytest.mark.parametrize(
    ("sensing", "range_m", "lag"),
    [("lidar", 10.0, 0.25), ("cameras", 3.5, 0.9)],
)
def test_a_robot_begins_to_evade_a_person_whom_it_senses(
    sensing: str, range_m: float, lag: float
) -> None:
    """When the person is 3.5 s away from 0.7 m, or once it is in range.

    A depth camera needs some images of the person, and looks away
    meanwhile.
    """
    if sensing == "cameras":
        pytest.importorskip("cv2")
    speed, distance = 1.0, 6.0
    duel = calls.duel_with_person(
        sensing=sensing, speed=speed, distance=distance, duration=5.5
    )
    wanted = min(0.7 + 3.5 * speed, range_m)
    begun = duel["triggered_at_distance_m"]
    assert wanted - lag * speed < begun < wanted + 0.05
    walked = distance - speed * duel["triggered_at_s"]
    assert begun == pytest.approx(walked, abs=0.02)
    assert duel["min_distance_m"] > 0.4  # nobody is touched


def players(*entries: str, level: str = "steps", duration: float) -> str:
    """Return a game file of players that are given as TOML."""
    head = f'level = "{level}"\nduration = {duration}\n'
    return head + "".join(f"[[players]]\n{entry}\n" for entry in entries)


def stands(name: str, role: str, x: float, y: float) -> str:
    """Return a player who stands."""
    return f'name="{name}"\nrole="{role}"\nstrategy="stand"\nstart=[{x},{y},0]'


def test_the_closest_approach_is_that_of_opponents(tmp_path: Path) -> None:
    """Not of teammates, nor of one who stands by."""
    file = tmp_path / "game.toml"
    file.write_text(
        players(
            stands("red", "pursuer", 0.0, 0.0),
            stands("ruby", "pursuer", 0.0, 0.5),
            stands("blue", "evader", 2.0, 0.0),
            stands("guest", "bystander", 2.0, 0.6),
            duration=1.0,
        )
    )
    (row,) = calls.rows_of(file, *calls.changes(seed="0:1"))
    assert row["closest_m"]["min"] == row["closest_m"]["mean"] == 2.0
    assert row["captured"]["count"] == 0


@pytest.mark.parametrize("aside", [0.0, 2.0])
def test_a_robot_that_collides_with_a_person_has_not_succeeded(
    aside: float, tmp_path: Path
) -> None:
    """It reaches its goal both times; once a person walks through it."""
    file = tmp_path / "crowd.toml"
    robot = 'name="nao"\nrole="evader"\nstart=[0,0,0]\ngoal=[0.6,0]'
    person = (
        'name="guest"\nrole="bystander"\nbody="person"\n'
        f"start=[-1,{aside},0]\ngoal=[4,{aside}]\n"
        'crowd={speed=0.8,reaction="none"}'
    )
    file.write_text(players(robot, person, duration=40.0))
    game = calls.game_of_file(file)
    own = game["players"]["nao"]
    met, pair = own["crowd"], game["pairs"]["nao - guest"]
    touching = pair["closest_m"] < 0.25 + 0.14  # radii of person and NAO
    assert touching == (aside == 0.0)
    assert own["goal_at_s"] is not None and met["people"] == 1
    assert (met["collisions"] > 0) == touching
    assert met["success"] != touching
