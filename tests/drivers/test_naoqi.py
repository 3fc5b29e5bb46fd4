"""Drive a robot by velocities over NAOqi, against services of ``qi``."""

import re
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path
from time import monotonic

import pytest

pytest.importorskip("qi")
import qi  # noqa: E402

from flows.running import Running, until  # noqa: E402
from naoqi_peer import BUTTON, FALLEN, Services, serve  # noqa: E402
from stepaside import Outcome, load_run  # noqa: E402
from stepaside.core.errors import ConfigurationError  # noqa: E402
from stepaside.drivers import naoqi  # noqa: E402
from stepaside.drivers.method_thread import SessionLost  # noqa: E402
from stepaside.drivers.robot_loader import RobotRequest  # noqa: E402
from stepaside.perception.camera_model import CameraModel  # noqa: E402
from stepaside.perception.measurement import RobotState  # noqa: E402

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


@pytest.fixture
def driver(
    robot: Services, monkeypatch: pytest.MonkeyPatch
) -> Iterator[naoqi.NaoqiRobot]:
    """Our side, in the process of the services and their application."""
    monkeypatch.setattr(naoqi, "_application", lambda: None)
    camera = CameraModel(4, 2, 3.0, 3.0)
    request = RobotRequest(robot.url, camera=camera, latency=0.05)
    made = naoqi.make_robot(request)()
    made.open()
    yield made
    made.close()


def reported(driver: naoqi.NaoqiRobot, hindrance: str) -> RobotState:
    """Wait for a report with a hindrance."""
    found: RobotState = until(
        lambda: (r := driver.listen()) and r.hindrance == hindrance and r
    )
    return found


def test_a_robot_is_woken_up_commanded_and_rests(
    robot: Services, driver: naoqi.NaoqiRobot
) -> None:
    driver.prepare()
    first = reported(driver, "")
    assert robot.calls == ["wakeUp"] and first.pose == (0.0, 0.0, 0.0)
    for _ in range(3):  # sent again only after a while
        driver.command(0.1, -0.05, 0.2)
        driver._moving.answered(1.0)  # type: ignore[union-attr]
    assert robot.moves == [(0.1, -0.05, 0.2)]

    def repeated() -> bool:
        driver.command(0.1, -0.05, 0.2)
        return len(robot.moves) > 1

    until(repeated)
    later = until(lambda: (r := reported(driver, "")).pose.x > 0.02 and r)
    assert later.pose.y < -0.005 and later.time > first.time
    driver.look(0.3, -0.1)
    assert robot.head == (["HeadYaw", "HeadPitch"], [0.3, -0.1], 0.3)
    driver.stop()
    driver.stop()  # once is enough
    assert robot.calls == ["wakeUp", "stopMove"]
    driver.close()
    assert robot.calls[-1] == "rest"
    driver.open()


def test_the_button_pauses_and_a_fallen_robot_waits_for_it(
    robot: Services, driver: naoqi.NaoqiRobot
) -> None:
    driver.prepare()
    reported(driver, "")
    for hindrance in ("chest button", ""):
        robot.values[BUTTON] = 1.0
        reported(driver, "chest button")
        robot.values[BUTTON] = 0.0
        reported(driver, hindrance)
    robot.values[FALLEN] = 1
    reported(driver, "has fallen")
    robot.values[FALLEN] = 0
    reported(driver, "has fallen: the chest button makes it stand up")
    robot.values[BUTTON] = 1.0
    reported(driver, "has fallen: the chest button makes it stand up")
    assert robot.calls == ["wakeUp"]
    robot.values[BUTTON], robot.stands = 0.0, False
    reported(driver, "could not stand up: the chest button makes it stand up")
    assert robot.calls == ["wakeUp", "wakeUp"]


@pytest.mark.parametrize("frozen", [False, True])
def test_images_of_the_camera_are_rgb_and_new(
    robot: Services, driver: naoqi.NaoqiRobot, frozen: bool
) -> None:
    robot.frozen = frozen
    image = driver.image()
    assert image is not None and 0.05 <= monotonic() - image.time < 2.0
    assert image.pixels.tolist() == [[[255, 0, 0], [0, 0, 255]]]
    assert image.mount == (0.05, 0.0, 0.5, 0.2, 0.1, 0.0)
    assert (image.focal_x, image.focal_y) == (1.5, 1.5)
    assert robot.watched == ("stepaside", 0, 0, 11, 15)
    assert (driver.image() is None) == frozen


@pytest.mark.parametrize(
    ("address", "said"),
    [
        ("tcp://", "robot must be naoqi:tcp://HOST:PORT, got 'naoqi:tcp://'"),
        ("h:70000", "got 'naoqi:h:70000'"),
        ("h:0", "got 'naoqi:h:0'"),
        ("a b", "got 'naoqi:a b'"),
    ],
)
def test_an_invalid_address_is_refused(address: str, said: str) -> None:
    with pytest.raises(ConfigurationError, match=re.escape(said)):
        naoqi.make_robot(RobotRequest(address))


def test_a_robot_that_is_not_there_is_named(driver: naoqi.NaoqiRobot) -> None:
    made = naoqi.make_robot(RobotRequest("tcp://127.0.0.1:1"))()
    with pytest.raises(SessionLost, match=r"tcp://127\.0\.0\.1:1"):
        made.open()
