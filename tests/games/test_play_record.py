"""Test replays of plays: motion of the player and its sightings."""

from math import hypot
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from click.testing import CliRunner

from stepaside.cli.main import main
from stepaside.core.errors import ConfigurationError
from stepaside.core.poses import Array, Pose, wrap_angle
from stepaside.drivers.play_log import PlayLog, PlayTick, joint_row
from stepaside.drivers.safety import SafetyState
from stepaside.games.game import Outcome
from stepaside.games.game_settings import StartSettings
from stepaside.games.game_settings import duel as make_duel
from stepaside.games.play_settings import PlaySettings
from stepaside.games.players import RobotPlayer
from stepaside.games.recorded_game import RecordedGame
from stepaside.games.run_archive import complete_play, load_run
from stepaside.games.settings_reader import dump_configuration
from stepaside.robots.description import load_robot
from stepaside.robots.tree_cache import load_tree
from stepaside.sim.body_settings import BODIES

pytestmark = pytest.mark.usefixtures("blank_figures")

EVADER = PlaySettings()
START = StartSettings(distance=0.7, pursuer_offset=0.1, evader_offset=0.2)


def log_at(folder: Path, settings: PlaySettings) -> PlayLog:
    """Return a log in a folder with its configuration."""
    beside = {"configuration.toml": dump_configuration(settings)}
    return PlayLog(folder, beside)


def look_at(log: PlayLog, walker: RobotPlayer) -> None:
    """Log measurements and intents of a walker, tick by tick."""
    read, write = walker.robot.read, walker.robot.write
    measured: list[Any] = []

    def note(**parts: bool) -> Any:
        measured[:] = [read()]
        return measured[0]

    def send(targets: Any) -> None:
        write(targets)
        scheme = walker.scheme
        # Open loop, sensors are read only when a decision is due.
        measurement = measured.pop() if measured else read()
        row = joint_row(measurement, targets, scheme, 1, scheme.begun)
        seen = measurement.sighting or scheme.sighting
        log.note(
            PlayTick(
                SafetyState.WALKING,
                *("chest button", measurement.time, seen, "", row),
            )
        )

    robot: Any = walker.robot
    robot.read, robot.write = note, send


class Walked:
    """Evader after a walk, with its true motion and its record."""

    def __init__(self, folder: Path) -> None:
        settings = make_duel(start=START, body=BODIES["delayed"], duration=4.0)
        duel = RecordedGame(settings, recorded=False, endless=True)
        self.folder, log = folder, log_at(folder, EVADER)
        evader = duel.in_physics.players[1]
        assert isinstance(evader, RobotPlayer)
        look_at(log, evader)
        self.true: list[tuple[Pose, Pose, Array]] = []
        self.others: list[tuple[float, float]] = []
        self.frame = evader.frame
        while duel.world.time < 4.0:
            true = evader.truth
            torso = *true.position_torso_in_world, true.heading_in_world
            self.true.append(
                (
                    Pose(*torso),
                    evader.place_in_world,
                    evader.robot.motion()["qpos"].copy(),
                )
            )
            self.others.append(
                duel.in_physics.players[0].truth.position_reference_in_world
            )
            assert duel.tick() is None
        duel.world.close()
        log.close()
        self.run = complete_play(
            folder, EVADER, Outcome.COMPLETED, "long enough"
        )


@pytest.fixture(scope="module")
def walked(tmp_path_factory: pytest.TempPathFactory) -> Walked:
    return Walked(tmp_path_factory.mktemp("plays") / "play")


@pytest.mark.slow
def test_the_replayed_path_is_the_true_one_up_to_slip(walked: Walked) -> None:
    run, frame = walked.run, walked.frame.inverse()
    true = walked.true[:: round(float(run.times[1]) / 0.012)]
    assert len(run.times) in (len(true), len(true) + 1)
    planning, least = run.summary.planning, run.summary.min_distance_m
    assert least is not None and 0.5 < least < 0.75
    assert planning is not None and planning.steps >= 4
    for own, (seen, _, _) in zip(run.evader.torso, true, strict=False):
        wanted = frame.compose(seen)
        assert hypot(own[0] - wanted.x, own[1] - wanted.y) < 0.01
        assert abs(wrap_angle(own[2] - wanted.theta)) < 0.02
    qpos = run.evader.qpos
    assert qpos is not None
    truly = np.array([posture for *_, posture in true])[: len(qpos)]
    off = np.abs(qpos[: len(truly)] - truly)
    own = load_tree(load_robot("nao"))
    coupled = [own.joints.index(name) for name in own.followers]
    assert off[:, 7:][:, coupled].max() < 1e-3  # a little play in physics
    assert np.delete(off[:, 7:], coupled, axis=1).max() < 1e-6
    assert off[:, 2].max() < 0.01


@pytest.mark.parametrize(
    "name", ["play.html", "play.png", "csv.csv", "u.urdf"]
)
def test_a_play_by_joints_is_shown(
    walked: Walked, tmp_path: Path, name: str
) -> None:
    file = str(tmp_path / name)
    words = ["show", str(walked.folder), "-o", file, "--no-open"]
    shown = CliRunner().invoke(main, words)
    assert shown.exit_code == 0, shown.output
    assert (tmp_path / name).exists()


def test_a_truncated_record_is_replayed_to_its_end(
    walked: Walked, tmp_path: Path
) -> None:
    cut = tmp_path / "cut"
    cut.mkdir()
    for name in ("play.json", "configuration.toml"):
        (cut / name).write_bytes((walked.folder / name).read_bytes())
    rows = (walked.folder / "rows.f64").read_bytes()
    (cut / "rows.f64").write_bytes(rows[: len(rows) // 2 + 5])
    run = load_run(cut)
    assert run.outcome is Outcome.FAILED
    assert run.times[-1] == pytest.approx(2.0, abs=0.05)
    (cut / "play.json").write_text('{"columns": {"times_s": 1}}')
    with pytest.raises(ConfigurationError, match="cannot be read"):
        load_run(cut)
