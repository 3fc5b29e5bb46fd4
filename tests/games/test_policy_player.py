"""Test games of robots on learned legs."""

from dataclasses import replace
from hashlib import sha256
from pathlib import Path

import numpy as np
import pytest

pytest.importorskip("onnxruntime")

from legs_robot import nao_on_legs
from stepaside.arena import Room
from stepaside.cli.main import main
from stepaside.core.poses import Pose
from stepaside.games.duel_settings import DuelSettings
from stepaside.games.game import play
from stepaside.games.outcome import Outcome
from stepaside.games.policy_player import PolicyPlayer
from stepaside.games.recorded_game import (
    RecordedGame,
    run_duel,
    run_duels,
)
from stepaside.games.robot_settings import with_legs, with_robot
from stepaside.locomotion.policy.policy_walk import PolicyWalk
from stepaside.planning import Direction, GaitSettings
from stepaside.sim.body_settings import BODIES
from stepaside.sim.person_settings import PersonSettings
from stepaside.strategies import Intent, Knowledge
from stepaside.strategies.velocity_set import BodyVelocity
from stepaside.theory.unicycle.circles import find_circle


@pytest.fixture(scope="module")
def standing(tmp_path_factory: pytest.TempPathFactory) -> DuelSettings:
    """RecordedGame of robots whose policy holds the standing posture."""
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


def test_duels_side_by_side_have_the_bits_of_each_alone(
    standing: DuelSettings,
) -> None:
    """Also when one ends before the others."""
    many = [
        replace(standing, seed=seed, duration=duration)
        for seed, duration in ((1, 0.3), (2, 0.1), (3, 0.3))
    ]
    for run, settings in zip(run_duels(many), many, strict=True):
        alone = run_duel(settings)
        assert run.settings == alone.settings
        assert (run.outcome, run.message) == (alone.outcome, alone.message)
        for name, track in alone.tracks.items():
            found = run.tracks[name].qpos
            assert track.qpos is not None and found is not None
            assert np.array_equal(found, track.qpos)


def test_a_robot_in_a_room_knows_it(standing: DuelSettings) -> None:
    """Distances of random starts are those of the robot, also in a room."""
    starts = Pose(-1.0, 0.0, 0.0), Pose(1.0, 0.0, np.pi)
    strategy = Sidestepper()
    settings = replace(
        standing,
        start=replace(standing.start, distance=None, least=0.5),
        room=replace(standing.room, plan=Room(2.6, 2.6, starts=starts)),
        evader_strategy=strategy,
    )
    duel = RecordedGame(settings)
    play(duel)
    assert duel.settings.start.least == 0.5
    assert duel.settings.start.distance == pytest.approx(2.0)
    known = strategy.told[-1]
    assert known.pose_in_map[:2] == pytest.approx((1.0, 0.0), abs=0.05)
    assert known.obstacles_in_map


@pytest.mark.parametrize("bad", ["nan", "-0.1", "inf"])
def test_legs_whose_measured_response_cannot_be_are_refused(
    bad: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    folder = nao_on_legs(tmp_path / "nao")
    digest = sha256((folder / "policy.onnx").read_bytes()).hexdigest()
    lines = [f'network = "{digest}"', "tube = 0.1"]
    for i, axis in enumerate(("forward", "lateral", "turn")):
        rows = np.outer([-1.0, 0.0, 1.0], np.eye(3)[i]).tolist()
        lines += [
            f"[{axis}]\ncommands = [-1.0, 0.0, 1.0]\ndelivered = {rows}",
            f"lag = 0.1\nhalting = {bad if i == 0 else 0.2}",
        ]
    file = folder / "legs-policy.toml"
    file.write_text("\n".join(lines))
    with pytest.raises(SystemExit) as left:
        main(["duel", "--robot", str(folder), "--duration", "0.5"])
    assert left.value.code == 2
    said = capsys.readouterr().err
    assert str(file) in said and "forward.halting must" in said
    assert f"got {bad}" in said


class Sidestepper:
    """Strategy that walks to the left, and counts its decisions."""

    direction, saturated = Direction.BACKWARD, False

    def __init__(self) -> None:
        self.told: list[Knowledge] = []

    def begin(self) -> None:
        """Return no memory."""

    def decide(self, known: Knowledge, memory: None) -> tuple[Intent, None]:
        """Walk to the left."""
        self.told.append(known)
        return Intent(velocity=BodyVelocity(0.0, 0.2, 0.1)), None


def test_a_body_velocity_reaches_the_policy_every_80_ms(
    standing: DuelSettings,
) -> None:
    strategy = Sidestepper()
    duel = RecordedGame(replace(standing, evader_strategy=strategy))
    _, evader = duel.in_physics.players
    assert isinstance(evader, PolicyPlayer)
    walk = evader.scheme.locomotion
    assert isinstance(walk, PolicyWalk)
    play(duel)
    assert walk.legs.intended == BodyVelocity(0.0, 0.2, 0.1)
    velocities = strategy.told[-1].limits.velocities
    assert velocities == walk.velocities
    assert velocities is not None and velocities.lateral == (-1.0, 1.0)
    told = [each for each in strategy.told if each.limits.velocities]
    times = np.unique([known.time for known in told if known.moving])
    np.testing.assert_allclose(np.diff(times), 0.08, atol=1e-9)


def test_a_person_is_evaded_on_learned_legs_as_the_template_is(
    standing: DuelSettings,
) -> None:
    """The policy only stands: the template, which walks, keeps away."""
    settings = replace(
        standing,
        pursuer="person",
        person=PersonSettings("straight", 1.4),
        evader_strategy="step-aside",
        start=replace(standing.start, distance=6.0),
        duration=5.0,
    )
    run = run_duel(settings)
    assert run.outcome is Outcome.CONTACT
    assert run.summary.triggered_at_s is not None
    theory = run.summary.theory.closest_approach_m
    assert theory is not None and theory > 1.0 > run.summary.min_distance_m
