"""Test settings of gait, control and games from descriptions."""

import math
import tomllib
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest
from click.testing import CliRunner

from stepaside.cli.main import main
from stepaside.core.errors import ConfigurationError
from stepaside.games.configuration_file import (
    dump_configuration,
    parse_settings,
)
from stepaside.games.duel_circle import circle_of_theory, time_scale
from stepaside.games.duel_settings import DuelSettings, RobotSettings
from stepaside.games.initial_poses import draw_start
from stepaside.games.robot_settings import (
    body_of_robot,
    with_players,
    with_robot,
)
from stepaside.planning import GaitSettings
from stepaside.robots.description import load_robot
from stepaside.sim.body_settings import BODIES
from stepaside.theory.unicycle.circles import find_circle

NAO = load_robot("nao")


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
    made = with_robot(DuelSettings(seed=5, duration=3.0), robot)
    assert (made.seed, made.duration) == (5, 3.0)
    assert made.gait.stride == 0.03 and made.gait.sole.front == 0.08
    assert made.control.feedback
    assert made.control.stabiliser.dead_zone == 0.02
    assert made.strategy.safety_radius == 0.9
    drawn = draw_start(made).distance
    assert drawn is not None and 1.4 <= drawn <= 1.5


def given(*words: str) -> dict[str, Any]:
    """Return the configuration that a command would use."""
    result = CliRunner().invoke(main, [*words, "--settings"])
    assert result.exit_code == 0, result.output
    return tomllib.loads(result.stdout)


def test_two_players_may_be_different_robots(tmp_path: Path) -> None:
    robot = changed_nao(
        tmp_path / "robot",
        **{"speed = 0.1 ": "speed = 0.08 ", "safety_radius = 0.8": ""},
    )
    text = (tmp_path / "robot" / "robot.toml").read_text()
    assert "safety_radius" not in text
    (tmp_path / "robot" / "robot.toml").write_text(
        text.replace("[game]", "[game]\nsafety_radius = 0.95")
    )
    made = with_players(DuelSettings(), {"pursuer": robot})
    assert made.robot_of("pursuer").gait.speed == 0.08
    assert made.robot_of("evader") == RobotSettings()
    assert made.strategy.safety_radius == 0.95
    again = parse_settings(
        DuelSettings,
        tomllib.loads(dump_configuration(made)),
        "itself",
    )
    assert again == made.resolved()
    config = given("duel", "--set", f"pursuer_robot={robot}")
    assert config["pursuer_robot"]["gait"]["speed"] == 0.08
    assert "evader_robot" not in config


def test_theory_of_different_gaits_is_in_real_time() -> None:
    """A gait with a slower time scale is a slower unicycle."""
    slow = GaitSettings(single_support=0.85, double_support=0.244)
    gait = GaitSettings()
    assert time_scale(slow) == pytest.approx(0.5 * time_scale(gait))
    own = RobotSettings(gait=slow)
    theory = circle_of_theory(DuelSettings(pursuer_robot=own))
    pace = time_scale(gait)
    expected = find_circle(
        0.05 * pace,
        0.1 * pace,
        0.1 * pace,
        0.2 * pace,
        math.pi / 2,
        "proportional",
    )
    assert theory == expected
    assert theory.radius_pursuer_m < theory.radius_evader_m
    same = circle_of_theory(DuelSettings(pursuer_robot=RobotSettings()))
    assert same == circle_of_theory(DuelSettings())


def test_equal_gaits_reach_the_circle_of_the_paper_at_any_time_scale() -> None:
    """Time is scaled; the circle of equal players is unchanged."""
    slow = GaitSettings(single_support=0.85, double_support=0.244)
    both = RobotSettings(gait=slow)
    settings = DuelSettings(pursuer_robot=both, evader_robot=both)
    one, other = circle_of_theory(settings), circle_of_theory(DuelSettings())
    assert one.radius_evader_m == pytest.approx(other.radius_evader_m)
    assert one.distance_m == pytest.approx(other.distance_m)
    assert settings.cycle == pytest.approx(2.0 * slow.step_duration)
    nearer = replace(DuelSettings(), pursuer_robot=both)
    assert nearer.cycle == settings.cycle


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
    for options, cycles in (([], 1), (["--set", "body.delay_cycles=2"], 2)):
        shown = CliRunner().invoke(
            main,
            ["run", "walk", "--robot", robot, "--body", "hardware", *options]
            + ["--settings"],
        )
        assert tomllib.loads(shown.output)["body"]["delay_cycles"] == cycles
    wrong = changed_nao(
        tmp_path, **{'name = "NAO"': 'name = "NAO"\nbody.delay = 1'}
    )
    with pytest.raises(ConfigurationError, match="body: unknown entry delay"):
        body_of_robot(wrong, "hardware")
