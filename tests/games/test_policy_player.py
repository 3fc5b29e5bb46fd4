"""Test games of robots on learned legs."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

pytest.importorskip("onnxruntime")

from legs_robot import nao_on_legs
from stepaside.core.errors import ConfigurationError, PolicyError
from stepaside.games.duel import Duel, run_duel
from stepaside.games.duel_settings import DuelSettings
from stepaside.games.outcome import Outcome
from stepaside.games.robot_settings import with_legs, with_robot
from stepaside.planning import GaitSettings
from stepaside.sim.body_settings import BODIES, BodySettings, at_tick
from stepaside.theory.unicycle.circle_equations import find_circle


@pytest.fixture(scope="module")
def standing(tmp_path_factory: pytest.TempPathFactory) -> DuelSettings:
    """Duel of robots whose policy holds the standing posture."""
    folder = nao_on_legs(tmp_path_factory.mktemp("legs") / "nao")
    settings = with_robot(DuelSettings(duration=1.5, seed=3), str(folder))
    return replace(settings, start=replace(settings.start, distance=1.0))


def test_a_robot_with_a_network_plays_the_game_of_learned_legs(
    standing: DuelSettings,
) -> None:
    assert standing.legs.network.endswith("policy.onnx")
    gait = standing.gait
    assert (gait.speed, gait.gain, gait.step_duration) == (0.5, 0.4, 0.4)
    assert gait.path_interval == gait.step_duration
    theory = find_circle(0.5, 0.5, 0.4, 0.4, np.pi / 2, "proportional")
    assert theory.exists
    named = with_legs(DuelSettings(), "policy.onnx")
    assert named.gait.speed == 0.5
    assert named.gait.com_height == GaitSettings().com_height


@pytest.mark.parametrize("body", ["ideal", "hardware"])
def test_a_policy_that_holds_a_posture_stands(
    body: str, standing: DuelSettings
) -> None:
    run = run_duel(replace(standing, body=BODIES[body]))
    assert run.outcome is Outcome.COMPLETED
    for track in run.tracks.values():
        moved = np.abs(track.torso[:, :2] - track.torso[0, :2])
        assert moved.max() < 0.02
        assert track.com_reference is None


def test_equal_settings_give_equal_bits(standing: DuelSettings) -> None:
    settings = replace(standing, body=BODIES["delayed"], duration=0.3)
    one, other = run_duel(settings), run_duel(settings)
    for name, track in one.tracks.items():
        assert track.qpos is not None
        repeated = other.tracks[name].qpos
        assert repeated is not None
        assert np.array_equal(track.qpos, repeated)


def test_a_policy_that_falls_at_once_is_refused(tmp_path: Path) -> None:
    folder = nao_on_legs(tmp_path / "nao", bias=(0.0, 0.9))
    settings = with_robot(DuelSettings(duration=2.0), str(folder))
    with pytest.raises(PolicyError, match="fell at 0.* while it was to stand"):
        run_duel(settings)


def test_a_period_that_the_tick_does_not_divide_is_refused(
    tmp_path: Path,
) -> None:
    folder = nao_on_legs(tmp_path / "nao", period="0.021")
    settings = with_robot(DuelSettings(duration=1.0), str(folder))
    with pytest.raises(PolicyError, match="tick must divide .* 0.021"):
        run_duel(settings)


@pytest.mark.parametrize(
    ("body", "tick"),
    [("ideal", 0.02), ("delayed", 0.004), ("hardware", 0.004)],
)
def test_an_ideal_body_is_controlled_at_the_period_of_its_policy(
    body: str, tick: float, standing: DuelSettings
) -> None:
    """One that delays or disturbs keeps its shorter tick."""
    duel = Duel(replace(standing, body=BODIES[body]))
    assert duel.world.physics.tick == pytest.approx(tick)
    duel.close()


def test_cameras_are_refused(standing: DuelSettings) -> None:
    with pytest.raises(ConfigurationError, match="legs.network must be empty"):
        replace(standing, sensing="cameras")


def test_a_body_keeps_its_delays_at_another_tick() -> None:
    body = at_tick(BODIES["hardware"], 0.004)
    assert (body.cycle, body.delay_cycles, body.imu_delay_cycles) == (0, 9, 3)
    assert at_tick(BodySettings(), 0.004) == BodySettings()
