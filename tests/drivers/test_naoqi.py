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
from naoqi_peer import BUTTON, FALLEN, Services, serve  # noqa: E402
from stepaside import Outcome, load_run  # noqa: E402

pytestmark = pytest.mark.xdist_group("naoqi")


@pytest.fixture(scope="module", autouse=True)
def application() -> object:
    """A process has one."""
    return qi.Application(["peer"], raw=True)


@pytest.fixture
def robot() -> Iterator[Services]:
    session, services = serve()
    yield services
    services.silent = False
    session.close()


# The robot with a detector that sees the opponent at one place.
SEEING = """
import stepaside as sa
from stepaside.drivers.naoqi import NaoqiRobot
from stepaside.perception.camera_model import CameraModel

class Seeing(NaoqiRobot):
    limits = sa.VelocityLimits(forward=0.3, backward=0.3, turn=1.0)

    def __init__(self):
        super().__init__({url!r}, CameraModel(4, 2, 3.0, 3.0), 0.05)

    def listen(self):
        report = super().listen()
        if report is None:
            return None
        return report._replace(sighting=sa.Sighting(report.time, 0.5, 2.0))
"""


@pytest.fixture
def seeing(robot: Services, tmp_path: Path) -> str:
    """Address of the robot that sees its opponent."""
    file = tmp_path / "seeing.py"
    file.write_text(SEEING.format(url=robot.url), encoding="utf-8")
    return f"{file}:Seeing"


def play(address: str, *words: str) -> subprocess.Popen[str]:
    """Play the pursuer on the robot, in a process of its own."""
    command = [sys.executable, "-m", "stepaside", "play", "--role", "pursuer"]
    return subprocess.Popen(
        [*command, address, *words],
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
    )


def ended(player: subprocess.Popen[str]) -> str:
    _, said = player.communicate(timeout=60.0)
    return said


def test_a_pursuer_turns_to_the_opponent_and_rests_at_the_end(
    robot: Services, seeing: str, tmp_path: Path
) -> None:
    folder = tmp_path / "record"
    player = play(seeing, "--duration", "1.5", "--record", str(folder))
    said = ended(player)
    assert player.returncode == 0, said
    assert robot.calls[0] == "wakeUp"
    assert robot.calls[-2:] == ["stopMove", "rest"]
    # v, and k times the bearing, law (1).
    assert max(robot.moves) == pytest.approx((0.1, 0.0, 0.2 * 0.5))
    run = load_run(folder, "play")
    assert run.outcome is Outcome.COMPLETED


@pytest.mark.slow
def test_a_robot_that_sees_nothing_is_woken_up_and_stands(
    robot: Services,
) -> None:
    player = Running(play(f"naoqi:{robot.url}"))
    player.until_said("opponent not detected")
    assert player.interrupt() == 0
    assert (robot.calls[0], robot.calls[-1]) == ("wakeUp", "rest")
    assert not any(any(move) for move in robot.moves)


@pytest.mark.slow
def test_a_robot_whose_controller_is_killed_is_stopped(
    robot: Services, seeing: str
) -> None:
    player = play(seeing)
    until(lambda: robot.moves)
    os.kill(player.pid, signal.SIGKILL)
    player.wait()
    until(lambda: not any(robot.velocity))
    assert robot.calls[-1] == "stopMove"


@pytest.mark.slow
@pytest.mark.parametrize(("name", "value"), [(FALLEN, 1), (BUTTON, 1.0)])
def test_a_fall_and_the_chest_button_stop_the_robot(
    robot: Services, seeing: str, name: str, value: float
) -> None:
    player = play(seeing)
    until(lambda: robot.moves)
    robot.values[name] = value
    until(lambda: robot.velocity == (0.0, 0.0, 0.0))
    player.send_signal(signal.SIGINT)
    ended(player)
    assert robot.calls[-1] == "rest"


def test_a_silent_robot_is_stopped_and_named(
    robot: Services, seeing: str
) -> None:
    player = Running(play(seeing))
    until(lambda: any(robot.velocity))
    assert "no reports" not in player.said
    robot.silent = True
    until(lambda: not any(robot.velocity))
    player.until_said("no reports of listen()")
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
