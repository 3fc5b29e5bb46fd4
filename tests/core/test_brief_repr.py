"""Test the short text of public values."""

from dataclasses import replace
from functools import cache
from typing import Any, NamedTuple

import numpy as np
import pytest

import stepaside
from public_values import a_bound, a_plan, a_run
from stepaside import (
    DuelSettings,
    GaitSettings,
    Push,
    RelativeStart,
    WalkSettings,
    make_game,
)
from stepaside.core.poses import Pose
from stepaside.strategies import Evasion, Pursuit, play_strategies
from stepaside.strategies.strategy_game import StepGame
from stepaside.theory.unicycle import simulate_sampled


class Named(NamedTuple):
    """A value with a text."""

    name: str


SHORT = 600  # longest text of any value, in [characters]
GAME = make_game(0.1, 0.1, 0.2, 0.2)
START = RelativeStart(1.0, 0.3, 0.4)


@cache
def values() -> dict[str, Any]:
    """Return one value of every public type."""
    walk = stepaside.run_walk(WalkSettings(duration=1.0))
    nao = stepaside.load_robot("nao")
    tree = stepaside.load_tree(nao)
    poses = Pose(0.0, 0.0, 0.0), Pose(1.0, 0.0, 0.0)
    return {
        "duel": a_run(),
        "walk": walk,
        "track": a_run().evader,
        "settings of a duel": DuelSettings(),
        "settings of a walk": WalkSettings(),
        "gait": GaitSettings(),
        "control": stepaside.ControlSettings(),
        "plan": a_plan(),
        "samples": a_plan().sample([0.0, 0.5]),
        "game of unicycles": stepaside.simulate(GAME, START, 60.0),
        "sampled game": simulate_sampled(GAME, START, 60.0, 0.4),
        "games": stepaside.play_games(GAME, [START.wrapped()] * 2000, 1.0),
        "steps": play_strategies(
            Pursuit(), Evasion(), poses, game=StepGame(duration=60.0)
        ),
        "circle": stepaside.find_circle(0.1, 0.1, 0.2, 0.2),
        "certificate": stepaside.certify(GAME, START),
        "bound": a_bound(),
        "robot": nao,
        "tree": tree,
        "posture": stepaside.Configuration(tree, np.zeros(len(tree.joints))),
    }


def test_a_value_is_one_short_line() -> None:
    for value in values().values():
        text = repr(value)
        assert len(text) <= SHORT and "\n" not in text, text


@pytest.mark.parametrize("name", ["duel", "walk"])
def test_a_run_shows_its_name_players_and_outcome(name: str) -> None:
    run = values()[name]
    text = repr(run)
    assert len(text) < 200
    for part in (f"{name.title()}Run", run.name, run.message, *run.players):
        assert part in text


def test_settings_show_what_differs_from_the_default() -> None:
    assert repr(DuelSettings()) == "DuelSettings()"
    assert repr(DuelSettings(seed=3)) == "DuelSettings(seed=3)"
    changed = DuelSettings(gait=replace(GaitSettings(), stride=0.06))
    assert repr(changed) == "DuelSettings(gait=GaitSettings(stride=0.06))"
    pushed = WalkSettings(pushes=(Push(1.0, 2.0, 0.5),))
    assert "impulse=1.0" in repr(pushed) and "gait" not in repr(pushed)
