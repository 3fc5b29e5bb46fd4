"""Test that every door leads to the same game."""

import tomllib
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest
import tomli_w
from click.testing import CliRunner

from stepaside.cli.main import main
from stepaside.games.configuration_file import (
    dump_configuration,
    load_configuration,
    parse_settings,
    settings_entries,
)
from stepaside.games.duel_settings import DuelSettings, RobotSettings
from stepaside.games.game_file import load_game
from stepaside.games.recorded_game import run_duel, run_walk
from stepaside.games.robot_settings import with_legs
from stepaside.games.settings_reader import settings_of
from stepaside.games.walk_settings import WalkSettings
from stepaside.locomotion.control_settings import (
    ControlSettings,
    StabiliserSettings,
)
from stepaside.planning import PRESETS
from stepaside.sim.body_settings import BODIES
from stepaside.strategies import Evasion

DUEL = DuelSettings()
FAST = replace(DUEL, gait=PRESETS["fast"])
HARDWARE = replace(DUEL, body=BODIES["hardware"])
PERSON = replace(DUEL, pursuer="person")
LEGS = with_legs(PERSON, "walk.onnx")
OPEN_LOOP = ControlSettings(feedback=False)
CASES: dict[str, tuple[str, DuelSettings, tuple[Any, ...]]] = {
    # options, settings, and what they imply: method, feedback, strategy and
    # trigger
    "": ("", DUEL, ("closed-form", False, "evasion", "distance")),
    "fast": (
        "--gait fast",
        FAST,
        ("closed-form", True, "evasion", "distance"),
    ),
    "hardware": (
        "--body hardware",
        HARDWARE,
        ("measured", True, "evasion", "distance"),
    ),
    "mpc": (
        "--set control.method=mpc",
        replace(DUEL, control=ControlSettings("mpc")),
        ("mpc", True, "evasion", "distance"),
    ),
    "person": (
        "--pursuer person",
        PERSON,
        ("closed-form", False, "evasion", "distance"),
    ),
    "person, fast": (
        "--pursuer person --gait fast",
        replace(PERSON, gait=PRESETS["fast"]),
        ("closed-form", True, "evasion", "time"),
    ),
    "person, learned legs": (
        "--pursuer person --set legs.network=walk.onnx",
        LEGS,
        ("closed-form", False, "step-aside", None),
    ),
    "learned legs": (
        "--set legs.network=walk.onnx",
        replace(LEGS, pursuer="robot"),
        ("closed-form", False, "evasion", "distance"),
    ),
    "explicit control": (
        "--gait fast --body hardware --set control.feedback=false",
        replace(FAST, body=BODIES["hardware"], control=OPEN_LOOP),
        ("closed-form", False, "evasion", "distance"),
    ),
    "explicit method": (
        "--gait fast --set control.method=measured",
        replace(FAST, control=ControlSettings("measured")),
        ("measured", True, "evasion", "distance"),
    ),
    "explicit trigger": (
        "--pursuer person --gait fast --set strategy.trigger=distance",
        replace(
            PERSON,
            gait=PRESETS["fast"],
            strategy=Evasion(trigger="distance"),
        ),
        ("closed-form", True, "evasion", "distance"),
    ),
    "explicit strategy": (
        "--pursuer person --set legs.network=walk.onnx --strategy evasion",
        replace(LEGS, evader_strategy="evasion"),
        ("closed-form", False, "evasion", "distance"),
    ),
}


def open_differences(settings: DuelSettings) -> dict[str, Any]:
    """Return the sections that a user would write for these settings."""
    gait = settings_entries(settings)["gait"]
    found: dict[str, Any] = {
        "gait": gait,
        "body": settings_entries(settings)["body"],
        "pursuer": settings.pursuer,
        "legs": {"network": settings.legs.network},
    }
    control = settings.control
    for name in ("method", "feedback"):
        if getattr(control, name) is not None:
            found.setdefault("control", {})[name] = getattr(control, name)
    if settings.strategy.trigger is not None:
        found["strategy"] = {"trigger": settings.strategy.trigger}
    if settings.evader_strategy:
        found["evader_strategy"] = settings.evader_strategy
    return found


def write(path: Path, entries: dict[str, Any]) -> Path:
    path.write_text(tomli_w.dumps(entries), encoding="utf-8")
    return path


@pytest.mark.parametrize("case", CASES)
def test_settings_imply_the_same_from_every_door(
    case: str, tmp_path: Path
) -> None:
    words, settings, (method, feedback, strategy, trigger) = CASES[case]
    resolved = settings.resolved()
    control = resolved.control
    assert (control.method, control.feedback) == (method, feedback)
    assert resolved.evader_strategy == strategy
    assert resolved.strategy.trigger == trigger
    assert resolved.resolved() == resolved

    line = ["duel", *words.split(), "--settings"]
    shown = CliRunner().invoke(main, line)
    assert shown.exit_code == 0, shown.stderr
    entries = tomllib.loads(shown.stdout)
    assert parse_settings(DuelSettings, entries, "printed") == resolved

    entries = open_differences(settings)
    file = load_configuration(write(tmp_path / "duel.toml", entries))
    assert file.resolved() == resolved

    assert settings_of(DuelSettings, entries).resolved() == resolved

    body, pursuer = entries.pop("body"), entries.pop("pursuer")
    evader = {"name": "blue", "role": "evader", **entries}
    evader["strategy"] = evader.pop("evader_strategy", "")
    evader["evasion"] = entries.get("strategy", {})
    if not settings.legs.walks:
        evader.pop("legs")
    other = {"name": "red", "role": "pursuer", "body": pursuer}
    made = write(
        tmp_path / "game.toml", {"body": body, "players": [other, evader]}
    )
    blue = load_game(made).resolved().player("blue")
    assert blue.control == control and blue.strategy == strategy
    assert blue.evasion.trigger == trigger


def test_a_choice_that_is_left_open_follows_later_changes(
    tmp_path: Path,
) -> None:
    file = write(
        tmp_path / "duel.toml", {"control": {"stabiliser": {"edge": 0.001}}}
    )
    settings = replace(load_configuration(file), body=BODIES["hardware"])
    wanted = ControlSettings("measured", True, StabiliserSettings(edge=0.001))
    assert settings.resolved().control == wanted
    own = RobotSettings(gait=PRESETS["fast"])
    mixed = replace(DUEL, evader_robot=own).resolved()
    assert mixed.robot_of("evader").control == ControlSettings(
        "closed-form", True
    )
    assert not mixed.robot_of("pursuer").control.feedback


def test_the_levels_of_templates_have_no_legs_that_step_sideways(
    tmp_path: Path,
) -> None:
    players = [
        {"name": "red", "role": "pursuer", "body": "person"},
        {"name": "blue", "role": "evader", "legs": {"network": "walk.onnx"}},
        {"name": "green", "role": "evader", "goal": [1.0, 1.0]},
        {"name": "gray"},
    ]
    for level, strategy in (("physics", "step-aside"), ("steps", "evasion")):
        file = {"level": level, "players": players}
        made = load_game(write(tmp_path / "game.toml", file)).resolved()
        played = [player.strategy for player in made.players]
        assert played == ["", strategy, "goal", "stand"]


def test_a_run_shows_what_its_settings_implied() -> None:
    run = run_duel(replace(FAST, duration=0.1))
    assert run.settings.control == ControlSettings("closed-form", True)
    assert run.settings.evader_strategy == "evasion"
    assert dump_configuration(run.settings) == dump_configuration(
        replace(FAST, duration=0.1, start=run.settings.start)
    )
    walk = run_walk(WalkSettings(duration=0.1, body=BODIES["hardware"]))
    assert walk.settings.control == ControlSettings("measured", True)
