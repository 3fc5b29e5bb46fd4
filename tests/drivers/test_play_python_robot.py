"""Test ``play`` with the example adapter and its simulated robot."""

import json
import os
import signal
import socket
import subprocess
import sys
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest

from flows.running import until

ADAPTERS = Path(__file__).parents[2] / "examples" / "adapters"
ROBOT = f"{ADAPTERS / 'walker_robot.py'}:WalkerRobot"
PLAY = "from stepaside.cli.main import main; main()"
TEMPLATE = (
    "--role evader --set gait.speed=0.3 --set gait.gain=0.6 "
    "--set evasion.safety_radius=5"
).split()
LONGEST = 60.0  # for what takes seconds on an idle machine, in [s]
SEEING = f"{ADAPTERS / 'seeing_robot.py'}:SeeingRobot"
TIMEOUT = 0.6  # after which this robot stops by itself, in [s]


class Walker:
    """The simulated robot, in a process of its own."""

    def __init__(self, *options: str) -> None:
        words = [sys.executable, str(ADAPTERS / "simulated_walker.py")]
        self.process = subprocess.Popen(
            [*words, "--port", "0", *options],
            stdout=subprocess.PIPE,
            text=True,
        )
        assert self.process.stdout is not None
        self.port = int(self.process.stdout.readline().split()[1])
        self._socket = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        self._socket.settimeout(LONGEST)
        self._socket.connect(("127.0.0.1", self.port))

    def send(self, **call: object) -> None:
        """Send a call."""
        self._socket.send(json.dumps(call).encode())

    def moves(self) -> bool:
        """Whether the robot walks."""
        self.send(call="inspect")
        return any(json.loads(self._socket.recv(1024))["velocity"])

    def close(self) -> None:
        """End the process."""
        self._socket.close()
        self.process.kill()
        self.process.communicate()


@pytest.fixture
def start() -> Iterator[Callable[..., Any]]:
    """Function that starts a robot, or a play of it."""
    walkers: list[Walker] = []
    plays: list[subprocess.Popen[str]] = []

    def start_one(
        *options: str, of: Walker | None = None, robot: str = ROBOT
    ) -> Any:
        if of is None:
            walkers.append(Walker(*options))
            return walkers[-1]
        plays.append(
            subprocess.Popen(
                [sys.executable, "-c", PLAY, "play", robot]
                + [*TEMPLATE, *options],
                env=os.environ | {"WALKER_PORT": str(of.port)},
                stderr=subprocess.PIPE,
                text=True,
            )
        )
        return plays[-1]

    yield start_one
    for play in plays:
        play.kill()
        play.communicate()
    for walker in walkers:
        walker.close()


def test_the_page_prints_the_example() -> None:
    page = ADAPTERS.parents[1] / "docs" / "connect-your-robot.md"
    code = (ADAPTERS / "walker_robot.py").read_text(encoding="utf-8")
    assert f"```python\n{code}```" in page.read_text(encoding="utf-8")


@pytest.mark.parametrize("lost", ["states", "both"])
def test_it_stops_when_its_network_fails_and_walks_on_afterwards(
    lost: str, start: Callable[..., Any]
) -> None:
    """If commands are lost, too, the robot has to stop by itself."""
    both = lost == "both"
    walker = start(*(["--timeout", str(TIMEOUT)] if both else []))
    play = start(of=walker)
    until(walker.moves)
    kinds = ["states", "commands"] if both else ["states"]
    walker.send(call="lose", **{"for": dict.fromkeys(kinds, LONGEST)})
    until(lambda: not walker.moves())
    walker.send(call="lose", **{"for": dict.fromkeys(kinds, 0.0)})
    until(walker.moves)
    play.send_signal(signal.SIGINT)
    said = play.communicate(timeout=LONGEST)[1]
    assert play.returncode == 0 and "no reports of listen() for" in said
    assert not walker.moves()


@pytest.mark.slow
def test_a_robot_with_a_camera_walks_while_it_sees_its_opponent(
    start: Callable[..., Any],
) -> None:
    pytest.importorskip("cv2")
    walker = start()
    play = start("--sensing", "cameras", of=walker, robot=SEEING)
    until(walker.moves)
    walker.send(call="lose", **{"for": {"images": LONGEST}})
    until(lambda: not walker.moves())
    walker.send(call="lose", **{"for": {"images": 0.0}})
    until(walker.moves)
    play.send_signal(signal.SIGINT)
    said = play.communicate(timeout=LONGEST)[1]
    assert play.returncode == 0 and "image() returned no new image" in said
