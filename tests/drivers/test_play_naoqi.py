"""Test records and dry runs of ``play`` by joints and footsteps of NAOqi."""

import subprocess
import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from threading import Thread
from time import sleep

import numpy as np
import pytest

pytest.importorskip("qi")
pytest.importorskip("msgpack")

from stepaside.cli.main import main  # noqa: E402
from stepaside.drivers.joint.safety_state_machine import RobotState  # noqa: E402
from stepaside.drivers.naoqi.joint_server import (  # noqa: E402
    NaoqiJointServer,
)
from stepaside.drivers.naoqi.naoqi_server import NaoqiServer  # noqa: E402
from stepaside.drivers.row_file import read_rows  # noqa: E402
from stepaside.drivers.velocity.velocity_body import REST, VelocityCommand  # noqa: E402
from stepaside.drivers.velocity.velocity_loop import DrivingState  # noqa: E402
from stepaside.games.outcome import Outcome  # noqa: E402
from stepaside.games.run_archive import load_run  # noqa: E402
from stepaside.perception.measurement import Sighting  # noqa: E402

from lola_fakes import JOINTS, STANCE, MadeUpRobot  # isort: skip  # noqa: E402
from velocity_fakes import SimulatedUnicycle, until  # isort: skip  # noqa: E402

ANYWHERE = "tcp://127.0.0.1:0"
TICK = 0.012
WALKED = 0.6  # [s]
PLAY = "from stepaside.cli.main import main; main()"


class Joints:
    """Serve a robot driven by its joints, in lock step."""

    def __init__(self) -> None:
        self.robot = MadeUpRobot()
        self.server = NaoqiJointServer(
            ANYWHERE, self.robot, JOINTS, lock_step=True
        )
        self._ready = 0

    def tick(self, gone: Callable[[], object]) -> None:
        """Wait for who is there, and press the button when it stands."""
        self.robot.sighting = Sighting(self.robot.time, 0.3, 2.0)
        self._ready += self.server.ready
        self.server.press(200 < self._ready < 205)
        self.server.speak()
        until(lambda: self.server.hear() or gone())
        self.server.act()
        if not self.server.connected:
            sleep(TICK)


class Walks:
    """Serve a robot with walking control and a sighting."""

    def __init__(self) -> None:
        self.walker = SimulatedUnicycle()
        self.server = NaoqiServer(
            ANYWHERE, self.walker, ["a", "b"], VelocityCommand(1, 1), tick=TICK
        )
        self.told = 0

    def tick(self, gone: Callable[[], object]) -> None:
        """Let a while pass."""
        self.walker.time += TICK
        self.walker.sighting = Sighting(self.walker.time, 0.3, 2.0)
        self.server.speak()
        self.server.act()
        self.told = max(self.told, len(self.server.robot.steps))
        sleep(0.4 * TICK)


@contextmanager
def offered(scene: Joints | Walks) -> Iterator[list[str]]:
    """Return the arguments of ``play`` for this robot."""
    url = f"naoqi:{scene.server.url}"
    try:
        yield ["play", "--role", "pursuer", "--robot", url]
    finally:
        scene.server.close()


def played(words: list[str], scene: Joints | Walks) -> None:
    """Play to the end in a process of its own, which forks a guardian."""
    process = subprocess.Popen(
        [sys.executable, "-c", PLAY, *words, f"--duration={WALKED}"],
        stderr=subprocess.PIPE,
        text=True,
    )
    try:
        while process.poll() is None:
            scene.tick(lambda: process.poll() is not None)
        assert process.stderr is not None
        assert process.returncode == 0, process.stderr.read()
    finally:
        process.kill()
        process.communicate()


@pytest.mark.parametrize("by", ["joints", "footsteps"])
def test_a_played_run_folder_replays(by: str, tmp_path: Path) -> None:
    scene = Joints() if by == "joints" else Walks()
    folder = tmp_path / "record"
    with offered(scene) as words:
        played([*words, "--interface", by, "--record", str(folder)], scene)
    run = load_run(folder, "play")
    assert run.outcome is Outcome.COMPLETED
    assert run.message == "played long enough"
    assert run.summary.language == "naoqi"
    assert run.summary.walking_s == pytest.approx(WALKED, abs=0.2)
    states = [change.state for change in run.summary.changes]
    if isinstance(scene, Joints):
        walked = [
            RobotState.LIMP,
            RobotState.REACHING,
            RobotState.READY,
            RobotState.WALKING,
        ]
        walked += [RobotState.RESTING, RobotState.LIMP]  # it has not moved yet
        assert states == [state.value for state in walked]
        assert scene.robot.stiffness.max() == 0.0
        assert run.pursuer.qpos is not None
        assert run.summary.closest_m == pytest.approx(2.0)
    else:
        assert DrivingState.WALKING.value in states and scene.told
        assert not scene.server.robot.awake
        assert run.summary.closest_m == pytest.approx(2.0)
        assert np.abs(read_rows(folder)["wanted"][:, 0]).max() > 0.0


def look_on(
    scene: Joints | Walks, words: list[str], folder: Path, ticks: int
) -> Thread:
    """Run a dry run for a while, which forks no guardian."""

    def play() -> None:
        with pytest.raises(SystemExit):
            main([*words, "--dry-run", "--record", str(folder)])

    player = Thread(target=play)
    player.start()
    begun = folder / "play.json"
    while not begun.exists() and player.is_alive():
        scene.tick(lambda: not player.is_alive())
    for _ in range(ticks):
        scene.tick(lambda: not player.is_alive())
    return player


def test_a_dry_run_by_joints_moves_nothing_and_is_kept(tmp_path: Path) -> None:
    scene, folder = Joints(), tmp_path / "record"
    with offered(scene) as words:
        player = look_on(scene, [*words, "--interface", "joints"], folder, 40)
    player.join(60.0)
    assert not player.is_alive()
    assert not scene.server.robot.commanded
    np.testing.assert_array_equal(scene.robot.angles, STANCE)
    run = load_run(folder, "play")
    states = [change.state for change in run.summary.changes]
    assert states[:2] == ["limp", "reaching"]
    assert run.settings.dry_run


def test_a_dry_run_by_footsteps_is_recorded_without_commands(
    tmp_path: Path,
) -> None:
    scene, folder = Walks(), tmp_path / "record"
    with offered(scene) as words:
        player = look_on(
            scene, [*words, "--interface", "footsteps"], folder, 100
        )
        robot = scene.server.robot
        assert not robot.awake and not scene.told and robot.asked == REST
    player.join(60.0)
    assert not player.is_alive()
    run = load_run(folder, "play")
    assert run.settings.dry_run
    assert np.abs(read_rows(folder)["wanted"][:, 0]).max() > 0.0
