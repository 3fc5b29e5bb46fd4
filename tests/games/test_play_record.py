"""Test replays of plays: motion of the player and its sightings."""

from math import hypot
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from stepaside.core.errors import ConfigurationError
from stepaside.core.poses import Array, Pose, wrap_angle
from stepaside.drivers.play_log import PlayLog, PlayTick, joint_row
from stepaside.drivers.safety import SafetyState
from stepaside.games.configuration_file import dump_configuration
from stepaside.games.game_settings import StartSettings
from stepaside.games.game_settings import duel as make_duel
from stepaside.games.outcome import Outcome
from stepaside.games.play_rows import monotonic_times
from stepaside.games.play_settings import PlaySettings
from stepaside.games.recorded_game import RecordedGame
from stepaside.games.robot_player import RobotPlayer
from stepaside.games.run_archive import complete_play, load_run
from stepaside.games.run_captions import describe_state
from stepaside.robots.description import load_robot
from stepaside.robots.tree_cache import load_tree
from stepaside.sim.body_settings import BODIES

pytestmark = pytest.mark.usefixtures("blank_figures")

EVADER = PlaySettings()
START = StartSettings(distance=0.7, pursuer_offset=0.1, evader_offset=0.2)


def log_at(folder: Path, settings: PlaySettings) -> PlayLog:
    """Return a log in a folder with its configuration."""
    beside = {"configuration.toml": dump_configuration(settings)}
    return PlayLog(folder, {"role": settings.role}, beside)


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
            self.true.append(
                (
                    evader.torso_in_world,
                    evader.place_in_world,
                    evader.robot.posture,
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


def test_the_replayed_path_is_the_true_one_up_to_slip(
    walked: Walked,
) -> None:
    run, frame = walked.run, walked.frame.inverse()
    true = walked.true[:: round(float(run.times[1]) / 0.012)]
    assert len(run.times) in (len(true), len(true) + 1)
    planning = run.summary.planning
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


def test_the_opponent_is_at_its_sightings(walked: Walked) -> None:
    run, frame = walked.run, walked.frame.inverse()
    other = run.tracks["pursuer"].torso
    for row in range(0, len(other), 10):
        tick = min(round(run.times[row] / 0.012), len(walked.others) - 1)
        x, y = walked.others[tick]
        wanted = frame.compose(Pose(x, y, 0.0))
        off = hypot(other[row, 0] - wanted.x, other[row, 1] - wanted.y)
        assert off < 0.03  # at 0.1 m/s a sighting is some ticks old
    closest = min(
        hypot(x - place.x, y - place.y)
        for (x, y), (_, place, _) in zip(
            walked.others, walked.true, strict=True
        )
    )
    assert run.summary.min_distance_m == pytest.approx(closest, abs=0.01)


def test_a_play_is_read_from_its_folder_with_checksums(walked: Walked) -> None:
    loaded = load_run(walked.folder, "play")
    assert loaded.summary == walked.run.summary
    assert loaded.settings == EVADER.resolved()
    for name, track in walked.run.tracks.items():
        for key, array in track.arrays("").items():
            got = loaded.tracks[name].arrays("")[key]
            np.testing.assert_array_equal(got, array)
    assert describe_state(loaded, 3) == "walking (chest button)"
    file = walked.folder / "summary.json"
    told = file.read_text()
    file.write_text(told.replace("long enough", "for ever"))
    try:
        with pytest.raises(ConfigurationError, match="was modified"):
            load_run(walked.folder)
    finally:
        file.write_text(told)


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
    with pytest.raises(ConfigurationError, match="must hold the columns"):
        load_run(cut)


def test_record_time_continues_where_a_robot_clock_restarts() -> None:
    times = np.array([-0.024, -0.012, 0.0, 0.012, 900.0, 900.012, 0.0, 0.0])
    wanted = 0.012 * np.array([0, 1, 2, 3, 4, 5, 6, 6])
    np.testing.assert_allclose(monotonic_times(times), wanted, atol=1e-9)
