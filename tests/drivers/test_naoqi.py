"""Drive a robot by velocities over NAOqi, against services of ``qi``."""

import os
import signal
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest

pytest.importorskip("qi")
import qi  # noqa: E402

from flows.running import Running, until  # noqa: E402
from naoqi_peer import BUTTON, FALLEN, SIGHT, Services, serve  # noqa: E402
from stepaside import Outcome, load_run  # noqa: E402

pytestmark = pytest.mark.xdist_group("naoqi")


@pytest.fixture(scope="module", autouse=True)
def application() -> object:
    """A process has one."""
    return qi.Application(["peer"], raw=True)


@pytest.fixture
def robot() -> Iterator[Services]:
    session, services = serve()
    services.values[SIGHT] = [0.0, 0.5, 2.0]
    yield services
    services.silent = False
    session.close()


def play(robot: Services, *words: str) -> subprocess.Popen[str]:
    """Play the pursuer on the robot, in a process of its own."""
    command = [sys.executable, "-m", "stepaside", "play", "--role", "pursuer"]
    return subprocess.Popen(
        [*command, f"naoqi:{robot.url}", *words],
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
    )


def ended(player: subprocess.Popen[str]) -> str:
    _, said = player.communicate(timeout=60.0)
    return said


def test_a_pursuer_turns_to_the_opponent_and_rests_at_the_end(
    robot: Services, tmp_path: Path
) -> None:
    folder = tmp_path / "record"
    player = play(robot, "--duration", "1.5", "--record", str(folder))
    said = ended(player)
    assert player.returncode == 0, said
    assert robot.calls[0] == "wakeUp"
    assert robot.calls[-2:] == ["stopMove", "rest"]
    # v, and k times the bearing, law (1).
    assert max(robot.moves) == pytest.approx((0.1, 0.0, 0.2 * 0.5))
    run = load_run(folder, "play")
    assert run.outcome is Outcome.COMPLETED
    assert run.settings.language == "naoqi"


def test_a_robot_whose_controller_is_killed_is_stopped(
    robot: Services,
) -> None:
    player = play(robot)
    until(lambda: robot.moves)
    os.kill(player.pid, signal.SIGKILL)
    player.wait()
    until(lambda: not any(robot.velocity))
    assert robot.calls[-1] == "stopMove"


@pytest.mark.parametrize(("name", "value"), [(FALLEN, 1), (BUTTON, 1.0)])
def test_a_fall_and_the_chest_button_stop_the_robot(
    robot: Services, name: str, value: float
) -> None:
    player = play(robot)
    until(lambda: robot.moves)
    robot.values[name] = value
    until(lambda: robot.velocity == (0.0, 0.0, 0.0))
    player.send_signal(signal.SIGINT)
    ended(player)
    assert robot.calls[-1] == "rest"


def test_a_silent_robot_is_stopped_and_named(robot: Services) -> None:
    player = Running(play(robot))
    until(lambda: any(robot.velocity))
    assert "no odometry" not in player.said
    robot.silent = True
    until(lambda: not any(robot.velocity))
    player.until_said("no odometry")
    robot.silent = False
    until(lambda: any(robot.velocity))  # and on again
    assert player.interrupt() == 0


LOOK = """
import sys, time
from stepaside.drivers.naoqi import make_robot
from stepaside.drivers.robot_loader import RobotRequest
from stepaside.perception.camera_model import CameraModel
camera = CameraModel(4, 2, 3.0, 3.0)
robot = make_robot(RobotRequest(sys.argv[1], camera=camera, latency=0.05))()
robot.open()
image = robot.image()
assert 0.05 <= time.monotonic() - image.time < 2.0
print(image.pixels.tolist(), tuple(image.mount), image.focal_x)
print(robot.image() is None)
robot.close()
"""


@pytest.mark.parametrize("frozen", [False, True])
def test_images_of_the_camera_are_rgb_and_new(
    robot: Services, frozen: bool
) -> None:
    robot.frozen = frozen
    done = subprocess.run(
        [sys.executable, "-c", LOOK, robot.url],
        capture_output=True,
        text=True,
        timeout=60.0,
        check=True,
    )
    image, repeated = done.stdout.splitlines()
    assert image == (
        "[[[255, 0, 0], [0, 0, 255]]] (0.05, 0.0, 0.5, 0.2, 0.1, 0.0) 1.5"
    )
    assert repeated == str(frozen)
    assert not done.stderr and not robot.watched
