"""Priority of defaults, file, presets and single options."""

import json
import tomllib
from dataclasses import replace
from math import pi, radians
from pathlib import Path
from typing import Any

import pytest
from click.testing import CliRunner, Result

from stepaside.cli.main import main
from stepaside.cli.theory import PlanSettings
from stepaside.core.entries import read_entries
from stepaside.games.game_settings import duel
from stepaside.games.game_settings import walk as make_walk
from stepaside.games.settings_reader import dump_configuration
from stepaside.sim.body_settings import BODIES
from stepaside.sim.camera_settings import CLUTTER
from stepaside.sim.push import Push

KINDS: dict[str, Any] = {
    "duel": duel(),
    "view": duel(),
    "run walk": make_walk(),
    "theory plan": PlanSettings(),
}
SWITCHES = """
[evasion]
saturated = true
release_distance = 1.5
[start]
distance = 1.0
[body]
torque_speed = true
[control]
feedback = true
method = "measured"
[scene]
things = [{ kind = "red box", x = 3.0, y = 1.0 }]
[sight]
rate = 10
"""


def run(line: str) -> Result:
    return CliRunner().invoke(main, line.split())


def printed(line: str) -> dict[str, Any]:
    """Return the printed configuration of a command."""
    result = run(f"{line} --settings")
    assert result.exit_code == 0, result.stderr
    return tomllib.loads(result.stdout)


def settings(line: str) -> Any:
    (name,) = (each for each in KINDS if line.startswith(each))
    return read_entries(type(KINDS[name]), printed(line), line)


@pytest.fixture
def file(tmp_path: Path) -> Path:
    made = tmp_path / "settings.toml"
    made.write_text(SWITCHES, encoding="utf-8")
    return made


@pytest.mark.parametrize("name", KINDS)
def test_defaults_are_those_of_the_settings(name: str) -> None:
    usual = KINDS[name]
    usual = usual if name == "theory plan" else usual.resolved()
    assert settings(name) == usual


@pytest.mark.parametrize("name", KINDS)
def test_printed_configuration_has_a_comment_for_each_entry(name: str) -> None:
    lines = run(f"{name} --settings").stdout.splitlines()
    for before, line in zip(lines, lines[1:], strict=False):
        if line and not line.startswith("# "):
            assert before.startswith("# ") and len(before) > 2, line
    text = "\n".join(lines)
    step = "# Step size along the path [m]; 0.0001 to 10.\nstride = "
    assert step in text


def test_printed_configuration_repeats_the_run(tmp_path: Path) -> None:
    line = (
        "duel --seed 3 --duration 0.2 --set scene.things=clutter "
        "--set evasion.angle=45deg --set gait.gain=0.25"
    )
    made = tmp_path / "duel.toml"
    made.write_text(run(f"{line} --settings").stdout, encoding="utf-8")
    first, again = (
        json.loads(run(f"{asked} --json").stdout)
        for asked in (line, f"duel --config {made}")
    )
    for name in ("planning", "real_time_factor"):
        del first[name], again[name]
    assert first == again


def test_safety_radius_and_release_distance_change_together() -> None:
    """Each alone would be invalid with the default of the other."""
    line = (
        "--set evasion.safety_radius=1.2 --set evasion.release_distance=1.5 "
        "--set evasion.side_hysteresis=5deg"
    )
    for name in ("duel", "view"):
        strategy = settings(f"{name} {line}").evader.evasion
        assert (strategy.safety_radius, strategy.release_distance) == (
            1.2,
            1.5,
        )
        assert strategy.side_hysteresis == pytest.approx(radians(5.0))
    refused = run(
        "duel --set evasion.safety_radius=2 --set evasion.release_distance=1.5"
    )
    assert refused.exit_code == 2
    assert "release_distance must exceed safety_radius" in refused.stderr


def test_options_override_the_file_and_the_file_the_defaults(
    file: Path,
) -> None:
    given = settings(f"duel --config {file}")
    assert given.evader.evasion.saturated and given.body.torque_speed
    assert given.evader.sight.rate == 10.0 and given.start.distance == 1.0
    beside = settings(
        f"duel --config {file} --set sight.rate=20 --set physics.slope=1deg"
    )
    assert beside.evader.sight.rate == 20.0
    assert beside.evader.evasion == given.evader.evasion
    assert beside.physics.slope == pytest.approx(pi / 180.0)


def test_options_override_presets_and_presets_the_file(file: Path) -> None:
    """The file of a run has every entry, so presets must override it."""
    found = settings(
        f"duel --config {file} --body delayed --set body.delay_cycles=5"
    )
    assert found.body == replace(BODIES["delayed"], delay_cycles=5)


def test_options_switch_off_flags_of_a_file(file: Path) -> None:
    found = settings(
        f"duel --config {file} --set evasion.saturated=false "
        "--set body.torque_speed=false "
        "--set control.feedback=false --set control.method=closed-form "
        "--set scene.things=none "
        "--set evasion.release_distance=inf "
        "--distance none --set sight.rate=inf"
    )
    assert found == duel().resolved()
    clutter = settings(
        f"duel --config {file} --set scene.things=clutter"
    ).scene.things
    assert clutter == list(CLUTTER)


def test_walk_file_has_its_own_entries(tmp_path: Path) -> None:
    walk = make_walk(
        0.2,
        backward=True,
        duration=3.0,
        gait=replace(make_walk().gait, speed=0.08),
        pushes=(Push(0.5, 1.0, 0.0), Push(0.4, 2.0, pi)),
    )
    file = tmp_path / "walk.toml"
    file.write_text(dump_configuration(walk), encoding="utf-8")
    assert settings(f"run walk --config {file}") == walk.resolved()
    ahead = settings(
        f"run walk --config {file} --set walker.strategy=walk --push 1@2:90deg"
    )
    assert ahead.player("walker").strategy == "walk"
    assert ahead.pushes == (Push(1.0, 2.0, pi / 2),)
    refused = run(f"duel --config {file}")
    assert refused.exit_code == 2
    assert "unknown" in refused.stderr or "game must" in refused.stderr


def test_pushes_are_replaced_or_removed_and_name_the_player(
    file: Path,
) -> None:
    file.write_text(
        "[[pushes]]\nimpulse = 1.0\ntime = 2.0\ndirection = 0.0\n"
        'player = "pursuer"\n',
        encoding="utf-8",
    )
    kept = Push(1.0, 2.0, 0.0, player="pursuer")
    assert settings(f"duel --config {file}").pushes == (kept,)
    for words, pushes in (
        ("--set pushes=none", ()),
        ("--set pushes=2@3:0", (Push(2.0, 3.0, 0.0),)),
        ("--set pushes=evader=2@3:0", (Push(2, 3, 0, 0.1, "evader"),)),
    ):
        assert settings(f"duel --config {file} {words}").pushes == pushes
    assert settings("duel").pushes == settings("run walk").pushes == ()
