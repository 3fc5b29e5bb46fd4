"""Test topics when simulation or control freezes or is killed."""

import os
import signal
import subprocess
import sys
from collections.abc import Callable, Iterator
from pathlib import Path
from time import monotonic, sleep

import pytest

pytest.importorskip("cyclonedds")

from stepaside.drivers.guardian_process import SessionLost  # noqa: E402
from stepaside.drivers.ros2.dds_domain import DdsParticipant  # noqa: E402
from stepaside.drivers.ros2.ros2_body import Ros2Body  # noqa: E402
from stepaside.drivers.velocity.template_controller import TemplateController  # noqa: E402
from stepaside.drivers.velocity.velocity_body import REST  # noqa: E402
from stepaside.drivers.velocity.velocity_limits import VelocityLimits  # noqa: E402
from stepaside.drivers.velocity.velocity_loop import (
    DrivingState,
    VelocityLoop,
    VelocityTick,
)
from stepaside.drivers.velocity.watchdog import WatchSettings  # noqa: E402
from stepaside.planning import GaitSettings  # noqa: E402
from stepaside.strategies import Pursuit  # noqa: E402

TAG = f"stepaside-faults-{os.getpid()}"
LONGEST = 30.0  # for what takes a second, in [s]
HERE = str(Path(__file__).parents[1])

# A world in a process of its own: one unicycle with a sighting straight ahead.

WORLD = f"""
import sys
sys.path.insert(0, {HERE!r})
from time import sleep
from stepaside.drivers.ros2.dds_domain import DdsParticipant
from stepaside.drivers.ros2.ros2_server import Ros2Server, WorldClock
from stepaside.perception.measurement import Sighting
from velocity_fakes import SimulatedUnicycle
dds = DdsParticipant(0, tag={TAG!r})
walker = SimulatedUnicycle()
clock = WorldClock(dds)
server = Ros2Server(dds, "/nao", walker, ["a", "b"], clock, tick=0.012)
while True:
    walker.sighting = Sighting(walker.time, 0.3, 2.0)
    server.speak()
    server.hear()
    server.act()
    walker.move(walker.commanded, 0.012)
    sleep(0.012)
"""


@pytest.fixture
def world() -> Iterator[subprocess.Popen[bytes]]:
    words = [sys.executable, "-c", WORLD]
    process = subprocess.Popen(words, stdout=subprocess.DEVNULL)
    yield process
    process.kill()
    process.wait(LONGEST)


@pytest.fixture
def player() -> Iterator[VelocityLoop]:
    body = Ros2Body(DdsParticipant(0, tag=TAG), "/nao")
    yield VelocityLoop(
        body,
        lambda: TemplateController(Pursuit(), GaitSettings()),
        VelocityLimits(),
        WatchSettings(silence=0.25, lead=10.0, forsaken=1.0),
    )
    body.close()


def until(
    player: VelocityLoop, done: Callable[[VelocityTick], bool]
) -> VelocityTick:
    """Play until something is so."""
    end = monotonic() + LONGEST
    while monotonic() < end:
        try:
            tick = player.tick()
        except SessionLost:
            continue  # no peer is there yet
        if done(tick):
            return tick
    raise AssertionError("it never was so")


def walks(tick: VelocityTick) -> bool:
    """Whether the robot goes ahead."""
    return tick.state is DrivingState.WALKING and tick.velocity.forward > 0.05


def test_a_world_that_freezes_is_asked_for_rest_and_found_again(
    world: subprocess.Popen[bytes], player: VelocityLoop
) -> None:
    until(player, walks)
    world.send_signal(signal.SIGSTOP)
    rests = until(player, lambda tick: tick.velocity == REST)
    assert rests.state is DrivingState.WAITING
    assert rests.reason.startswith("no odometry for")
    world.send_signal(signal.SIGCONT)
    until(player, walks)


def test_a_world_that_is_killed_ends_the_session(
    world: subprocess.Popen[bytes], player: VelocityLoop
) -> None:
    until(player, walks)
    world.kill()
    world.wait(LONGEST)
    with pytest.raises(
        SessionLost, match="no new report from the robot for 1 s"
    ):
        while True:
            tick = player.tick()
    assert tick.velocity == REST


def test_control_that_freezes_leaves_a_robot_at_rest() -> None:
    """The world goes on without it, and listens to it again afterwards."""
    words = [sys.executable, "-c", CONTROL]
    control = subprocess.Popen(words)
    scene = Scene()
    try:
        scene.until(lambda forward: forward == 0.04)
        control.send_signal(signal.SIGSTOP)
        scene.until(lambda forward: forward == 0.0)
        control.send_signal(signal.SIGCONT)
        scene.until(lambda forward: forward == 0.04)
    finally:
        control.kill()
        control.wait(LONGEST)
        scene.close()


CONTROL = f"""
from time import sleep
from stepaside.drivers.ros2.ros2_body import Ros2Body
from stepaside.drivers.ros2.dds_domain import DdsParticipant
from stepaside.drivers.velocity.velocity_body import VelocityCommand
body = Ros2Body(DdsParticipant(0, tag={TAG!r}), "/nao")
while True:
    body.command(VelocityCommand(0.04, 0.0))
    sleep(0.01)
"""


class Scene:
    """A served unicycle in this process."""

    def __init__(self) -> None:
        from stepaside.drivers.ros2.ros2_server import Ros2Server, WorldClock
        from velocity_fakes import SimulatedUnicycle

        self.dds = DdsParticipant(0, tag=TAG)
        self.walker = walker = SimulatedUnicycle()
        clock, names = WorldClock(self.dds), ["a", "b"]
        self.server = Ros2Server(
            self.dds, "/nao", walker, names, clock, tick=0.012
        )

    def until(self, done: Callable[[float], bool]) -> None:
        """Go on until the robot is asked for such a speed."""
        end = monotonic() + LONGEST
        while monotonic() < end:
            self.server.speak()
            self.server.act()
            if done(self.walker.commanded.forward):
                return
            sleep(0.012)
        raise AssertionError("it never was asked for that")

    def close(self) -> None:
        """Leave."""
        self.server.close()
        self.dds.close()
