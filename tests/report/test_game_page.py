"""The page that plays, against the duels of Python."""

import json
import subprocess
import tarfile
from collections.abc import Iterator
from dataclasses import replace
from math import pi
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from browsing import CHROMIUM, launched, open_page
from legs_robot import nao_on_legs
from small_policies import constant_policy, write_policy
from stepaside.core.errors import ConfigurationError
from stepaside.core.poses import Pose
from stepaside.games.duel import run_duel
from stepaside.games.duel_circle import circle_of_theory
from stepaside.games.duel_settings import DuelSettings, StartSettings
from stepaside.locomotion.policy.legs_settings import LegsSettings
from stepaside.planning import (
    CenterState,
    Direction,
    Foot,
    GaitSettings,
    ManeuverPlanner,
    TemplateDrive,
)
from stepaside.report import game_page
from stepaside.report.game_page import packed_files, write_game_page
from stepaside.report.game_script import schedules_of, trace_plan
from stepaside.sim.body_settings import BODIES
from stepaside.sim.push import Push
from stepaside.strategies import Evasion
from tools.static_server import served_folder

PLANNER = ManeuverPlanner(GaitSettings())
SECONDS = 4.0  # of each game: both robots walk, and turn
NEAR = DuelSettings(seed=5, start=StartSettings(0.78, 0.4, -0.2))
OTHER = replace(
    NEAR,
    start=StartSettings(0.7, -0.5, 0.3),
    gait=GaitSettings(speed=0.08, stride=0.032, gain=0.3),
    strategy=Evasion(angle=pi / 3),
)
CHANGES = {
    "start": [0.7, -0.5, 0.3],
    "speeds": [0.08, 0.08],
    "gain": 0.3,
    "angle": pi / 3,
}


def torsos(settings: DuelSettings, times: np.ndarray) -> np.ndarray:
    """Positions of both torsos at times of a duel of Python, in [m]."""
    run = run_duel(replace(settings, duration=float(times[-1])))
    rows = np.searchsorted(run.times, times - 1e-6)
    tracks = [run.tracks[name].torso[rows, :2] for name in run.players]
    return np.hstack(tracks)


@pytest.mark.parametrize("foot", Foot)
@pytest.mark.parametrize("direction", Direction)
@pytest.mark.parametrize("kind", ["start", "step", "halt"])
def test_the_traced_planner_plans_as_the_planner(
    kind: str, direction: Direction, foot: Foot
) -> None:
    bearing, share, state = 0.7, 0.8, CenterState((0.03, 0.02), (0.1, -0.05))
    swing = Pose(-0.04, 0.1 * foot.value, -0.05)
    if kind == "halt":
        plan = PLANNER.plan_halt(
            first_foot=foot, state=state, swing_start=swing
        )
    else:
        plan = PLANNER.plan(
            bearing,
            direction,
            first_foot=foot,
            state=state,
            swing_start=swing,
            standing=kind == "start",
            drive=TemplateDrive(speed_factor=share),
        )
    traced = trace_plan("plan", schedules_of(PLANNER)[kind]).function()
    velocity = direction.value * share * PLANNER.settings.speed
    numbers = traced(
        *(bearing, velocity, PLANNER.settings.gain, foot.value),
        *(*swing, 0.0, 0.0, 0.0),
        *(*state.position, *state.velocity),
    )
    expected = [*plan.placements.ravel(), *plan.inputs.ravel()]
    np.testing.assert_allclose(numbers, expected, rtol=0, atol=1e-14)


@pytest.mark.parametrize(
    "settings",
    [
        DuelSettings(evader_strategy="look-ahead"),
        DuelSettings(body=BODIES["hardware"]),
        DuelSettings(strategy=Evasion(saturated=True)),
        DuelSettings(sensing="cameras"),
        DuelSettings(pursuer="person"),
    ],
)
def test_other_duels_are_refused(
    settings: DuelSettings, tmp_path: Path
) -> None:
    with pytest.raises(ConfigurationError, match="a page plays"):
        write_game_page(settings, tmp_path / "page")
    assert not (tmp_path / "page").exists()


def test_a_missing_npm_is_named(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(game_page, "which", lambda name: None)
    with pytest.raises(ConfigurationError, match="needs npm.*Node.js"):
        game_page.fetch_package(Path(), "mujoco")


def test_an_unreachable_registry_is_named(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    failed = subprocess.CompletedProcess([], 1, "", "ENOTFOUND")
    monkeypatch.setattr(game_page, "which", lambda name: "npm")
    monkeypatch.setattr(subprocess, "run", lambda *a, **k: failed)
    with pytest.raises(ConfigurationError, match="registry must be reach"):
        game_page.fetch_package(tmp_path, "mujoco")


def test_a_package_of_something_else_is_refused(tmp_path: Path) -> None:
    package = tmp_path / "other.tgz"
    with tarfile.open(package, "w:gz"):
        pass
    with pytest.raises(ConfigurationError, match=r"other\.tgz is no package"):
        packed_files(package, "mujoco", ["mujoco.js"])


@pytest.fixture(scope="module")
def browser() -> Iterator[Any]:
    """Chromium."""
    if CHROMIUM is None:
        pytest.skip("there is no Chromium here")
    with launched() as chromium:
        yield chromium


@pytest.fixture(scope="module")
def opened(
    browser: Any, tmp_path_factory: pytest.TempPathFactory
) -> Iterator[Any]:
    """The page in a browser, loaded, and what went wrong on it."""
    folder = tmp_path_factory.mktemp("page")
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(game_page, "RECORDED", 1.0)
        try:
            write_game_page(NEAR, folder)
        except ConfigurationError as error:
            if "npm" not in str(error):
                raise
            pytest.skip(str(error))
    with served_folder(folder) as address:
        page, wrong = open_page(browser, width=390, height=844), []
        page.on("pageerror", lambda error: wrong.append(str(error)))
        page.goto(address)
        page.evaluate("stepaside.loaded")
        yield page, wrong


@pytest.mark.xdist_group("browser")
@pytest.mark.timeout(900)
@pytest.mark.parametrize(
    ("settings", "changes"), [(NEAR, {}), (OTHER, CHANGES)]
)
def test_the_browser_plays_the_duel_of_python(
    opened: Any, settings: DuelSettings, changes: dict[str, Any]
) -> None:
    page, wrong = opened
    call = f"stepaside.simulate({SECONDS}, {json.dumps(changes)})"
    rows = np.array(page.evaluate(call))
    assert rows[-1, 0] == pytest.approx(SECONDS)
    expected = torsos(settings, rows[:, 0])
    assert np.ptp(expected, axis=0).max() > 0.1  # the robots have walked
    np.testing.assert_allclose(rows[:, 1:], expected, rtol=0, atol=1e-4)
    assert wrong == []


@pytest.mark.xdist_group("browser")
@pytest.mark.timeout(900)
def test_a_push_acts_as_in_python(opened: Any) -> None:
    page, _ = opened
    push = Push(0.6, time=1.0, direction=pi / 2, player="evader")
    rows = page.evaluate(
        """() => {
          stepaside.simulate(1);
          const { game } = stepaside, { heading } = game.players[1].truth();
          game.push(1, -0.6 * Math.sin(heading), 0.6 * Math.cos(heading));
          return game.simulate(1);
        }"""
    )
    rows = np.array(rows)
    expected = torsos(replace(NEAR, pushes=(push,)), rows[:, 0])
    unpushed = torsos(NEAR, rows[:, 0])
    assert np.abs(expected - unpushed).max() > 3e-3
    np.testing.assert_allclose(rows[:, 1:], expected, rtol=0, atol=1e-4)


@pytest.mark.xdist_group("browser")
@pytest.mark.timeout(900)
def test_settings_act_on_the_game(opened: Any) -> None:
    page, wrong = opened
    slider = page.get_by_label("angle of evasion")
    slider.fill("30")
    assert page.evaluate("stepaside.game.settings.angle") == pytest.approx(
        pi / 6
    )
    page.get_by_label("start: distance").fill("1.5")
    assert page.evaluate("stepaside.game.time") < 1.0
    assert page.evaluate("stepaside.game.distance") == pytest.approx(
        1.5, abs=0.02
    )
    assert page.evaluate("document.body.scrollWidth") <= 390
    assert wrong == []


@pytest.mark.xdist_group("browser")
@pytest.mark.timeout(900)
def test_footsteps_are_drawn_where_the_soles_land(opened: Any) -> None:
    page, _ = opened
    away = page.evaluate(
        """() => {
          const { game } = stepaside, away = [];
          game.reset({ ...game.defaults, start: [1.4, 1.4, 0] });
          const [pursuer] = game.players;
          let plan = null, drawn = null;
          while (game.time < 12) {
            game.tick();
            if (pursuer.plan === plan) continue;
            if (drawn) {
              const [x, y] = pursuer.sole(plan.side);
              away.push(Math.hypot(x - drawn[0], y - drawn[1]));
            }
            plan = pursuer.plan;
            drawn = plan && pursuer.landing();
          }
          return away;
        }"""
    )
    assert len(away) > 15
    assert max(away) < 0.01


@pytest.mark.xdist_group("browser")
@pytest.mark.timeout(900)
def test_the_theoretical_circle_passes_through_both_players(
    opened: Any,
) -> None:
    page, wrong = opened
    drawn = """() => {
      placeTheory();
      const { x, y } = scene.theory.position, { game } = stepaside;
      return [scene.theory.visible, ...game.players.map((player) => {
        const [u, v] = player.truth().reference;
        return Math.hypot(u - x, v - y);
      })];
    }"""
    page.evaluate("stepaside.simulate(4)")
    visible, *away = page.evaluate(drawn)
    radius = circle_of_theory(NEAR).radius_evader_m
    assert visible and away == pytest.approx([radius, radius], abs=1e-9)
    page.evaluate("stepaside.game.settings.gain = 0.3")
    assert not page.evaluate(drawn)[0]
    assert wrong == []


def on_legs(folder: Path) -> DuelSettings:
    """Duel of two robots on a small policy that observes everything."""
    terms = ["base_lin_vel", "base_ang_vel", "projected_gravity", "command"]
    terms += ["joint_pos", "joint_vel", "actions"]
    robot = nao_on_legs(folder, terms=str(terms), history="2")
    draw = np.random.default_rng(0).standard_normal
    weights = np.clip(0.01 * draw((4, 48)), -0.02, 0.02)
    network = write_policy(robot / "policy.onnx", weights, np.zeros(4))
    legs = LegsSettings(network=str(network))
    return DuelSettings(robot=str(robot), seed=5, duration=SECONDS, legs=legs)


@pytest.mark.xdist_group("browser")
@pytest.mark.timeout(900)
def test_robots_on_learned_legs_play_as_in_python(
    browser: Any, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    pytest.importorskip("onnxruntime")
    settings, folder = on_legs(tmp_path / "robot"), tmp_path / "page"
    monkeypatch.setattr(game_page, "RECORDED", 0.2)
    try:
        write_game_page(settings, folder)
    except ConfigurationError as error:
        if "npm" not in str(error):
            raise
        pytest.skip(str(error))
    other = constant_policy(tmp_path / "other.onnx")
    with served_folder(folder) as address:
        page, wrong = open_page(browser, width=390, height=844), []
        page.on("pageerror", lambda error: wrong.append(str(error)))
        page.goto(address)
        page.wait_for_selector("#policy:not([hidden])")
        page.set_input_files("#network", other)
        page.get_by_text("other.onnx is not policy.onnx").wait_for()
        assert page.evaluate("stepaside.game") is None
        page.set_input_files("#network", tmp_path / "robot/policy.onnx")
        page.evaluate("stepaside.loaded")
        rows = np.array(page.evaluate(f"stepaside.simulate({SECONDS})"))
    assert rows[-1, 0] == pytest.approx(SECONDS)
    expected = torsos(settings, rows[:, 0])
    assert np.ptp(expected, axis=0).max() > 1e-3  # the joints have moved
    np.testing.assert_allclose(rows[:, 1:], expected, rtol=0, atol=1e-5)
    assert wrong == []
