"""Test settings of games: one schema for every kind, by every door."""

import tomllib
from dataclasses import replace
from math import pi
from pathlib import Path
from typing import Any

import pytest
import tomli_w
from click.testing import CliRunner

from stepaside.cli.main import main
from stepaside.core.entries import read_entries
from stepaside.core.errors import ConfigurationError
from stepaside.games.forecast import circle_of_theory, time_scale
from stepaside.games.game_settings import (
    GameSettings,
    StartSettings,
    duel,
    read_game,
    walk,
)
from stepaside.games.game_starts import draw_start
from stepaside.games.robot_bodies import body_of_robot
from stepaside.games.settings_reader import dump_configuration, load_game
from stepaside.planning import PRESETS, GaitSettings
from stepaside.robots.description import load_robot
from stepaside.sim.body_settings import BODIES
from stepaside.sim.person_settings import PersonSettings
from stepaside.strategies import Evasion
from stepaside.theory.unicycle.circles import find_circle

NAO = load_robot("nao")


def game(*players: dict[str, Any], **entries: Any) -> GameSettings:
    return read_game(entries | {"players": list(players)}, "game")


def given(*words: str) -> dict[str, Any]:
    """Return the configuration that a command would use."""
    result = CliRunner().invoke(main, [*words, "--settings"])
    assert result.exit_code == 0, result.output
    return tomllib.loads(result.stdout)


def changed_nao(folder: Path, **changes: str) -> str:
    """Return a copy of NAO with another description."""
    folder.mkdir(exist_ok=True)
    text = (NAO.folder / "robot.toml").read_text(encoding="utf-8")
    for old, new in changes.items():
        assert old in text
        text = text.replace(old, new)
    (folder / "robot.toml").write_text(text, encoding="utf-8")
    (folder / "model.xml").write_text(NAO.mjcf(), encoding="utf-8")
    return str(folder)


def test_a_setting_is_changed_of_the_game_of_all_or_of_one_player() -> None:
    fast = PRESETS["fast"]
    made = duel(
        seed=3,
        gait=fast,
        pursuer={"body": "person", "person": PersonSettings(speed=1.0)},
        evader={"strategy": "look-ahead"},
    )
    assert made.seed == 3 and made.evader.gait == fast
    assert made.pursuer.gait == GaitSettings()  # a person has no use of it
    assert made.pursuer.person.speed == 1.0 and made.robots == ("evader",)
    assert made.changed(evader={"strategy": ""}).evader.strategy == ""
    own = duel(gait={"speed": 0.03}, evader={"gait": {"speed": 0.02}})
    assert own.evader.gait.speed == 0.02 and own.pursuer.gait.speed == 0.03
    for changes, message in (
        ({"weather": 1}, "unknown entry weather"),
        ({"evader": {"mood": 1}}, "evader: .*mood"),
        ({"evader": {"strategy": "nobody"}}, "evader: strategy.*nobody"),
        ({"evader": "nobody"}, "evader: strategy.*nobody"),
        ({"evader": {"body": "person"}}, "the last one as a robot"),
    ):
        with pytest.raises(ConfigurationError, match=message):
            made.changed(**changes)
    assert made.changed(evader="stand").evader.strategy == "stand"
    with pytest.raises(ConfigurationError, match="level of a walk must be"):
        walk(level="steps")


WALKER = [{"name": "walker"}]


@pytest.mark.parametrize(
    ("entries", "message"),
    [
        ({"weather": 1}, "here: unknown entry weather; there are"),
        ({"physics": {"tock": 1.0}}, "physics.tock; did you mean physics.tic"),
        ({"physics": {"tick": "x"}}, r"physics.tick must lie in .* \[s\]"),
        ({"seed": True}, "seed must be an integer in .*, got True"),
        ({"physics": {"friction": float("nan")}}, "physics.friction .*nan"),
        ({"pushes": [{"impulse": -1}]}, "pushes 1.impulse .*pushes 1.time"),
        ({"seed": -1, "duration": 0}, "seed must .*; duration must"),
        ({"physics": {"tick": 0.0031}}, "physics.tick must be a whole"),
        ({"gait": {"stride": 30}}, "here: gait.stride must lie in"),
        ({"evader": {"gait": {"stride": 30}}}, "here, evader: gait.stride"),
        ({"evader": {"person": {"speed": 1}}}, "person must be omitted"),
        ({"evader": 3}, "here, evader must be a table or the .*, got 3"),
        ({"evader": "brave"}, "here, evader: strategy must be one of"),
        (
            {"game": "walk", "legs": {"network": "x.onnx"}, "players": WALKER},
            "legs.network must be empty in a walk",
        ),
        ({"players": 3}, r"must be tables \[\[players\]\], got 3"),
        (
            {"players": [{"role": "evader"}]},
            "player 1 must be a table with a name",
        ),
        ({"recipe": {"discs": 3}}, "requires the seed of a random room"),
    ],
)
def test_errors_of_entries_are_named(
    entries: dict[str, Any], message: str
) -> None:
    with pytest.raises(ConfigurationError, match=message):
        read_game(entries, "here", base=duel())


PERSON: dict[str, Any] = {"body": "person"}
CASES: dict[str, tuple[str, dict[str, Any], tuple[Any, ...]]] = {
    # options, entries, and what they imply: method, feedback, strategy and
    # trigger
    "": ("", {}, ("closed-form", False, "evasion", "distance")),
    "fast": (
        "--gait fast",
        {"gait": "fast"},
        ("closed-form", True, "evasion", "distance"),
    ),
    "hardware": (
        "--body hardware",
        {"body": "hardware"},
        ("measured", True, "evasion", "distance"),
    ),
    "mpc": (
        "--set control.method=mpc",
        {"control": {"method": "mpc"}},
        ("mpc", True, "evasion", "distance"),
    ),
    "person": (
        "--pursuer person",
        {"pursuer": PERSON},
        ("closed-form", False, "evasion", "distance"),
    ),
    "person, fast": (
        "--pursuer person --gait fast",
        {"pursuer": PERSON, "gait": "fast"},
        ("closed-form", True, "evasion", "time"),
    ),
    "person, learned legs": (
        "--pursuer person --set legs.network=walk.onnx",
        {"pursuer": PERSON, "legs": {"network": "walk.onnx"}},
        ("closed-form", False, "step-aside", None),
    ),
    "learned legs": (
        "--set legs.network=walk.onnx",
        {"legs": {"network": "walk.onnx"}},
        ("closed-form", False, "evasion", "distance"),
    ),
    "explicit control": (
        "--gait fast --body hardware --set control.feedback=false",
        {"gait": "fast", "body": "hardware", "control": {"feedback": False}},
        ("closed-form", False, "evasion", "distance"),
    ),
    "explicit trigger": (
        "--pursuer person --gait fast --set evasion.trigger=distance",
        {
            "pursuer": PERSON,
            "gait": "fast",
            "evasion": {"trigger": "distance"},
        },
        ("closed-form", True, "evasion", "distance"),
    ),
    "explicit strategy": (
        "--pursuer person --set legs.network=walk.onnx --strategy evasion",
        {
            "pursuer": PERSON,
            "legs": {"network": "walk.onnx"},
            "evader": {"strategy": "evasion"},
        },
        ("closed-form", False, "evasion", "distance"),
    ),
    "strategy with an argument": (
        "--strategy evasion(angle=45deg)",
        {"evader": {"strategy": "evasion(angle=45deg)"}},
        ("closed-form", False, "evasion", "distance"),
    ),
}


@pytest.mark.parametrize("case", CASES)
def test_settings_imply_the_same_from_every_door(
    case: str, tmp_path: Path
) -> None:
    words, entries, (method, feedback, strategy, trigger) = CASES[case]
    resolved = read_game(entries, base=duel()).resolved()
    evader = resolved.evader
    assert (evader.control.method, evader.control.feedback) == (
        method,
        feedback,
    )
    assert evader.strategy == strategy
    assert evader.evasion.trigger == trigger
    assert resolved.resolved() == resolved
    shown = given("duel", *words.split())
    assert read_entries(GameSettings, shown) == resolved
    file = tmp_path / "duel.toml"
    file.write_text(tomli_w.dumps({"game": "duel"} | entries))
    assert load_game(file).resolved() == resolved
    file.write_text(dump_configuration(resolved))
    assert load_game(file) == resolved


def test_a_description_gives_gait_control_and_distances(
    tmp_path: Path,
) -> None:
    robot = changed_nao(
        tmp_path,
        **{
            "stride = 0.04": "stride = 0.03",
            "front = 0.095": "front = 0.08",
            "feedback = false": "feedback = true",
            "dead_zone = 0.015": "dead_zone = 0.02",
            "safety_radius = 0.8": "safety_radius = 0.9",
            "start_near = 0.6": "start_near = 1.4",
        },
    )
    made = read_game({"robot": robot}, base=duel(seed=5, duration=3.0))
    assert made == duel(seed=5, duration=3.0, robot=robot)
    evader = made.evader
    assert (made.seed, made.duration) == (5, 3.0)
    assert evader.gait.stride == 0.03 and evader.gait.sole.front == 0.08
    assert evader.control.feedback
    assert evader.control.stabiliser.dead_zone == 0.02
    assert evader.evasion.safety_radius == 0.9
    drawn = draw_start(made).distance
    assert drawn is not None and 1.4 <= drawn <= 1.5
    for options, expected in (([], 0.9), (["evasion.safety_radius=2"], 2.0)):
        words = [word for each in options for word in ("--set", each)]
        shown = given("duel", "--set", f"pursuer.robot={robot}", *words)
        pursuer, evading = shown["players"]
        assert pursuer["gait"]["stride"] == 0.03
        assert evading["gait"]["stride"] == 0.04
        assert evading["evasion"]["safety_radius"] == expected


def test_theory_of_different_gaits_is_in_real_time() -> None:
    """A gait with a slower time scale is a slower unicycle."""
    slow = GaitSettings(single_support=0.85, double_support=0.244)
    pace = time_scale(GaitSettings())
    assert time_scale(slow) == pytest.approx(0.5 * pace)
    theory = circle_of_theory(duel(pursuer={"gait": slow}))
    speeds, gains = (0.05 * pace, 0.1 * pace), (0.1 * pace, 0.2 * pace)
    assert theory == find_circle(*speeds, *gains, pi / 2, "proportional")
    both, usual = duel(gait=slow), circle_of_theory(duel())
    assert circle_of_theory(both).distance_m == pytest.approx(usual.distance_m)
    assert both.cycle == pytest.approx(2.0 * slow.step_duration)
    assert duel(pursuer={"gait": slow}).cycle == both.cycle
    argued = duel(evader={"strategy": "evasion(angle=45deg)"})
    assert circle_of_theory(argued) == circle_of_theory(
        duel(evasion=Evasion(angle=pi / 4))
    )


def test_a_body_has_the_errors_of_its_robot(tmp_path: Path) -> None:
    """Those that its description gives; options come first."""
    robot = changed_nao(
        tmp_path, **{'name = "NAO"': 'name = "NAO"\nbody.delay_cycles = 1'}
    )
    assert body_of_robot(robot, "ideal") == BODIES["ideal"]
    for name in ("delayed", "hardware"):
        assert body_of_robot("nao", name) == BODIES[name]
        expected = replace(BODIES[name], delay_cycles=1)
        assert body_of_robot(robot, name) == expected
    words = ("run", "walk", "--robot", robot, "--body", "hardware")
    for options, cycles in (((), 1), (("--set", "body.delay_cycles=2"), 2)):
        assert given(*words, *options)["body"]["delay_cycles"] == cycles
    wrong = changed_nao(
        tmp_path, **{'name = "NAO"': 'name = "NAO"\nbody.delay = 1'}
    )
    with pytest.raises(ConfigurationError, match="body: unknown entry delay"):
        body_of_robot(wrong, "hardware")


def test_starts_fill_their_ranges_and_repeat() -> None:
    """Distance and offsets of both, in the ranges of the docstring."""
    drawn = [draw_start(duel(seed=seed)) for seed in range(400)]
    for name, low, high in (
        ("distance", 0.6, 1.5),
        ("pursuer_offset", -pi / 2, pi / 2),
        ("evader_offset", -pi / 6, pi / 6),
    ):
        values = [getattr(start, name) for start in drawn]
        assert low <= min(values) < low + 0.03 * (high - low)
        assert high - 0.03 * (high - low) < max(values) <= high
        fixed = duel(seed=7, start=StartSettings(**{name: 0.5}))
        assert draw_start(fixed) == replace(drawn[7], **{name: 0.5})
    person = draw_start(duel(seed=7, pursuer={"body": "person"}))
    assert person.distance == pytest.approx((drawn[7].distance or 0.0) + 1.5)
