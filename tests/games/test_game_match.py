"""Test games of several players: levels, bodies, rules and summary."""

from functools import cache
from math import pi
from typing import Any

import numpy as np
import pytest

from stepaside.games.game import Outcome
from stepaside.games.game_settings import GameSettings, read_game
from stepaside.games.recorded_game import run_game
from stepaside.games.run import Run


def game(*players: dict[str, Any], **entries: Any) -> GameSettings:
    return read_game(entries | {"players": list(players)}, "game")


def robot(name: str, role: str, *start: float, **more: Any) -> dict[str, Any]:
    return {"name": name, "role": role, "start": list(start)} | more


THREE = (
    robot("red", "pursuer", 1.0, 0.0, pi),
    robot("ruby", "pursuer", 0.0, 1.0, -pi / 2),
    robot("blue", "evader", 0.0, 0.0, 0.8, evasion={"safety_radius": 2.0}),
)
GUEST = {
    "name": "guest",
    "body": "person",
    "start": [-3.0, 0.0, 0.0],
    "goal": [3.0, 0.0],
}
GHOST = robot("ghost", "pursuer", 2.0, 1.0, pi, body="unicycle")


@cache
def played() -> Run:
    """Return three robots, a person and a unicycle after 2 s in physics."""
    return run_game(game(*THREE, GUEST, GHOST, duration=2.0))


def test_robots_people_and_unicycles_play_in_one_world() -> None:
    run = played()
    assert run.outcome is Outcome.COMPLETED and run.duration == 2.0
    assert run.players == ("red", "ruby", "blue", "guest", "ghost")
    assert run.robots == ("red", "ruby", "blue")
    assert run.persons == ("guest",)
    for name in run.players:
        moved = (
            run.tracks[name].unicycle[-1, :2]
            - run.tracks[name].unicycle[0, :2]
        )
        assert np.hypot(*moved) > 0.05, name
    # A person walks at its speed, a unicycle at the gait's in gait time.
    assert run.tracks["guest"].torso[-1, 0] == pytest.approx(-1.8, abs=0.4)
    ghost = run.summary.players["ghost"]
    gait = run.settings.player("ghost").gait
    speed = gait.stride / gait.step_duration
    assert ghost.path_m == pytest.approx(
        speed * (2.0 - gait.start_support), abs=0.01
    )


@pytest.mark.parametrize("level", ["steps", "unicycle"])
def test_a_player_walks_to_its_goal_around_a_person(level: str) -> None:
    settings = game(
        robot(
            "blue",
            "bystander",
            0.0,
            0.0,
            0.0,
            goal=[2.5, 0.0],
            gait={"speed": 0.3, "stride": 0.12, "gain": 0.6},
        ),
        GUEST | {"start": [3.0, 0.05, pi], "goal": [-3.0, 0.05]},
        level=level,
        duration=60.0,
    )
    run = run_game(settings)
    own = run.summary.players["blue"]
    assert own.crowd is not None
    assert own.crowd.success and own.crowd.collisions == 0
    assert own.goal_at_s is not None and own.goal_at_s < 40.0
    assert run.duration == pytest.approx(own.goal_at_s, abs=0.05)
    assert run.tracks["blue"].torso[-1, :2] == pytest.approx(
        (2.5, 0.0), abs=0.31
    )


PATH_OF_PERSON: dict[str, dict[str, Any]] = {
    "goal": {"goal": [2.0, 1.0]},
    "drawn goal": {"draws_goal": True},
    "steer": {"person": {"speed": 0.5}},
    "straight": {"person": {"path": "straight", "speed": 0.5}},
    "aside": {"person": {"path": "straight", "speed": 0.5, "miss": 1.2}},
    "reacting": {
        "person": {"path": "straight", "speed": 0.5, "reaction": "regular"}
    },
}
