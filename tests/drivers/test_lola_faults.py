"""Test faults: cut sockets, garbage, killed and frozen processes."""

import gc
import os
import signal
import socket
import subprocess
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import numpy as np
import pytest

from lola_fakes import (
    JOINTS,
    STANCE,
    Clock,
    FakeLink,
    MadeUpRobot,
    sensor_frame,
)
from stepaside.drivers.guardian_process import SessionLost
from stepaside.drivers.joint.joint_body import (
    JointBody,
    JointInterface,
    SystemClock,
)
from stepaside.drivers.joint.safety_state_machine import RobotState
from stepaside.drivers.lola.conventions import CODEC
from stepaside.drivers.lola.lola_address import LolaAddress
from stepaside.drivers.lola.lola_connection import open_lola
from stepaside.drivers.lola.lola_frames import (
    ActuatorFrame,
    pack_actuators,
    pack_sensors,
)
from stepaside.drivers.lola.lola_server import LolaServer
from stepaside.drivers.lola.nao_joints import NAO_MOTORS
from stepaside.drivers.lola.served_joints import FADING, SILENT
from stepaside.drivers.lola.socket_link import SocketLink
from stepaside.drivers.lola.wire import SENSOR_BYTES

FRAME = pack_sensors(sensor_frame())
ANSWER = pack_actuators(
    ActuatorFrame(
        np.concatenate([STANCE, [0, 0]]),
        np.ones(25),
        {"Chest": (0.0, 0.0, 1.0)},
    )
)
TO_LIMP = SILENT + round(FADING / 0.012) + 1  # ticks

# Control in a process of its own, that only holds its stance.
CONTROL = f"""
import sys
import numpy as np
from stepaside.drivers.lola.lola_address import LolaAddress
from stepaside.drivers.lola.nao_joints import NAMES
from stepaside.drivers.guardian_process import SessionLost
from stepaside.drivers.lola.lola_connection import open_lola
stance = np.array({STANCE.tolist()})
body = open_lola(LolaAddress(sys.argv[1]), NAMES[:23], stance)
try:
    while True:
        body.read()
        body.write(stance)
except SessionLost as error:
    print(body.state.value, error)
body.close()
"""
# A world in a process of its own, that keeps time.
WORLD = """
import sys, time
from lola_fakes import JOINTS, MadeUpRobot
from stepaside.drivers.lola.lola_address import LolaAddress
from stepaside.drivers.lola.lola_server import LolaServer
server = LolaServer(LolaAddress(sys.argv[1]), MadeUpRobot(), JOINTS)
print("ready", flush=True)
while True:
    server.speak()
    server.hear()
    server.act()
    time.sleep(0.012)
"""


@contextmanager
def process(code: str, *words: str) -> Iterator["subprocess.Popen[str]"]:
    here = str(Path(__file__).parents[1])
    paths = [here, *(p for p in sys.path if p)]
    started = subprocess.Popen(
        [sys.executable, "-c", code, *words],
        stdout=subprocess.PIPE,
        text=True,
        env=os.environ | {"PYTHONPATH": os.pathsep.join(paths)},
    )
    try:
        yield started
    finally:
        started.send_signal(signal.SIGCONT)
        started.kill()
        started.communicate()


def open_files() -> int:
    """Count only sockets that this test has opened."""
    gc.collect()
    return len(os.listdir("/proc/self/fd"))


@contextmanager
def serving(
    folder: Path,
) -> Iterator[tuple[LolaServer, MadeUpRobot, LolaAddress]]:
    robot, address = MadeUpRobot(), LolaAddress(path=str(folder / "r"))
    server = LolaServer(address, robot, JOINTS, lock_step=True)
    try:
        yield server, robot, address
    finally:
        server.close()


def tick(server: LolaServer, timeout: float) -> None:
    """Run one tick, with a timeout for the answer."""
    import select

    server.speak()
    while not server.hear():
        if not select.select([server], [], [], timeout)[0]:
            break
    server.act()


def until_stiff(
    server: LolaServer, robot: MadeUpRobot, control: "subprocess.Popen[str]"
) -> None:
    """Let a client come and take the robot, however long that takes."""
    while not (server.connected and robot.stiffness[0] == 1.0):
        assert control.poll() is None
        tick(server, 10.0)


def test_control_that_is_killed_leaves_no_stiff_robot(tmp_path: Path) -> None:
    with serving(tmp_path) as (server, robot, address):
        with process(CONTROL, address.path) as control:
            until_stiff(server, robot, control)
            control.kill()
            control.wait()
            for _ in range(TO_LIMP + 2):
                tick(server, 0.0)
            assert not server.connected
            assert robot.stiffness.max() == 0.0
        with process(
            CONTROL, address.path
        ) as control:  # and another may take it
            until_stiff(server, robot, control)


def test_control_that_is_frozen_leaves_no_stiff_robot(tmp_path: Path) -> None:
    with serving(tmp_path) as (server, robot, address):
        with process(CONTROL, address.path) as control:
            until_stiff(server, robot, control)
            control.send_signal(signal.SIGSTOP)
            os.waitpid(control.pid, os.WUNTRACED)
            for _ in range(TO_LIMP + 2):
                tick(server, 0.0)
            assert robot.stiffness.max() == 0.0


def test_a_world_that_is_killed_ends_control(tmp_path: Path) -> None:
    address = LolaAddress(path=str(tmp_path / "r"))
    with process(WORLD, address.path) as world:
        assert world.stdout is not None and world.stdout.readline()
        body = open_lola(address, JOINTS, STANCE)
        body.read()
        body.write(STANCE)
        world.kill()
        world.wait()
        with pytest.raises(SessionLost):
            while True:
                body.read()
                body.write(STANCE)
        assert body.state is RobotState.LIMP
        body.close()


def test_a_world_that_is_frozen_ends_control(tmp_path: Path) -> None:
    address = LolaAddress(path=str(tmp_path / "r"))
    with process(WORLD, address.path) as world:
        assert world.stdout is not None and world.stdout.readline()
        body = open_lola(address, JOINTS, STANCE)
        body.read()
        world.send_signal(signal.SIGSTOP)
        with pytest.raises(SessionLost, match="no valid frame for"):
            while True:
                body.read()
                body.write(STANCE)
        body.close()


def body_on(near: socket.socket) -> JointBody:
    clock = Clock()
    return JointBody(
        JointInterface(SocketLink(near, SENSOR_BYTES), NAO_MOTORS, CODEC),
        dict(zip(JOINTS, STANCE, strict=True)),
        clock=SystemClock(clock, clock.pause),
    )


def test_a_session_cut_at_any_byte_of_a_frame_ends_with_a_reason() -> None:
    before = open_files()
    for length in range(SENSOR_BYTES + 1):
        near, far = socket.socketpair()
        body = body_on(near)
        far.sendall(FRAME)
        body.read()
        body.write(STANCE)
        assert far.recv(4096)
        far.sendall(FRAME[:length])
        far.close()
        with pytest.raises(SessionLost) as lost:
            for _ in range(2):
                body.read()
        inside = 0 < length < SENSOR_BYTES
        assert ("in the middle of a frame" in str(lost.value)) == inside
        body.close()
    assert open_files() == before


def test_a_session_cut_at_any_byte_of_an_answer_does_not_hurt_the_world(
    tmp_path: Path,
) -> None:
    with serving(tmp_path) as (server, robot, address):
        before = open_files()
        for length in range(len(ANSWER) + 1):
            client = address.open()
            client.connect(address.path)
            client.sendall(ANSWER[:length])
            server.speak()
            server.hear()
            assert server.answered == (length == len(ANSWER))
            client.close()
            server.hear()
            server.act()
            assert not server.connected
        for _ in range(TO_LIMP):
            tick(server, 0.0)
        assert robot.stiffness.max() == 0.0
        assert open_files() == before


def test_garbage_frames_from_a_robot_are_passed_over() -> None:
    """As long as every other frame is good."""
    random = np.random.default_rng(3)
    script = (
        frame
        for _ in range(1000)
        for frame in (random.bytes(SENSOR_BYTES), FRAME)
    )
    clock = Clock()
    link = FakeLink(clock, script)
    body = JointBody(
        JointInterface(link, NAO_MOTORS, CODEC),
        dict(zip(JOINTS, STANCE, strict=True)),
        clock=SystemClock(clock, clock.pause),
    )
    for _ in range(1000):
        time = body.read().time
        body.write(STANCE)
    assert body.refused == 1000
    assert body.state is RobotState.READY
    assert time == pytest.approx(1998 * 0.012)
    body.close()


def test_garbage_clients_do_not_hurt_the_world(
    tmp_path: Path,
) -> None:
    random = np.random.default_rng(4)
    with serving(tmp_path) as (server, robot, address):
        before = open_files()
        for _ in range(1000):
            client = socket.socket(socket.AF_UNIX)
            client.connect(address.path)
            client.send(random.bytes(786))
            server.speak()  # accepts it
            server.hear()
            server.hear()
            if server.connected:  # a rare whole frame's beginning
                server.drop("test")
            client.close()
        assert open_files() == before
        tick(server, 0.0)
        assert not robot.stiffness.any()
        with process(CONTROL, address.path) as control:
            until_stiff(server, robot, control)
