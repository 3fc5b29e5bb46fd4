"""Test NAO V6 over LoLA: our robot against a peer."""

import os
import signal
import socket
import subprocess
import sys
from collections.abc import Iterator
from contextlib import suppress
from pathlib import Path
from threading import Thread
from time import monotonic, sleep
from typing import Any

import numpy as np
import pytest

pytest.importorskip("msgpack")

from flows.lola_peer import (  # noqa: E402
    JOINTS,
    TICK,
    frame_of,
    listening,
)
from flows.running import until  # noqa: E402
from stepaside.drivers.lola import STALL_CURRENT, LolaRobot  # noqa: E402
from stepaside.drivers.robot import JointTargets  # noqa: E402
from stepaside.drivers.safety import SafetyState  # noqa: E402

import msgpack  # isort: skip  # noqa: E402

REST = [0.0] * 25
REAL = {"RobotConfig": ["P0000073A00000000012", "6.0.0"] * 2}
KNEE = JOINTS.index("LKneePitch")


class Daemon:
    """The robot's daemon, which sends what a test wants."""

    def __init__(self, path: Path) -> None:
        self.listener = listening(path)
        self.robot = LolaRobot(str(path))
        self.answers: list[dict[str, Any]] = []
        self._unpacker = msgpack.Unpacker()

    def meet(self, first: bytes) -> None:
        """Let the robot connect."""
        opening = Thread(target=self.robot.open)
        opening.start()
        self.client, _ = self.listener.accept()
        self.client.settimeout(20.0)
        self.client.sendall(first)
        opening.join()

    def send(self, *frames: bytes) -> None:
        """Send frames at once."""
        self.client.sendall(b"".join(frames))

    def answer(self) -> dict[str, Any]:
        """Return the next answer."""
        while (found := next(self._unpacker, None)) is None:
            self._unpacker.feed(self.client.recv(4096))
        assert isinstance(found, dict)
        return found

    def close(self) -> None:
        """Hang up."""
        self.client.close()
        self.listener.close()
        self.robot.close()


@pytest.fixture
def daemon(tmp_path: Path) -> Iterator[Daemon]:
    made = Daemon(tmp_path / "r")
    made.meet(frame_of(0, REST, **REAL))
    yield made
    made.close()


def test_a_frame_is_a_state_in_our_conventions(daemon: Daemon) -> None:
    first = daemon.robot.listen()
    assert first is not None and first.time == 0.0 and daemon.robot.paced
    position = [0.01 * i for i in range(25)]
    current, touch = [0.0] * 25, [0.0] * 14
    current[KNEE], touch[0], touch[9] = STALL_CURRENT[KNEE], 1.0, 1.0
    daemon.send(
        frame_of(
            1,
            position,
            **REAL,
            Accelerometer=[0.1, 0.2, -9.7],
            Gyroscope=[0.3, 0.4, 0.5],
            Angles=[0.01, 0.02],
            FSR=[0.1 * i for i in range(8)],
            Current=current,
            Touch=touch,
            Battery=[0.4, 0.0, 0.0, 36.0],
            Status=[0] * 24 + [3],
        )
    )
    state = daemon.robot.listen()
    assert state is not None and state.time == pytest.approx(TICK)
    np.testing.assert_allclose(state.joint_positions, position, atol=1e-6)
    assert state.joint_velocities is not None
    np.testing.assert_allclose(
        state.joint_velocities, np.array(position) / TICK, rtol=1e-5
    )
    np.testing.assert_allclose(
        state.accelerometer, [-0.1, -0.2, 9.7], rtol=1e-6
    )
    np.testing.assert_allclose(state.gyro, [0.3, 0.4, 0.5], rtol=1e-6)
    assert state.tilt == pytest.approx((0.01, 0.02))
    assert state.foot_forces[7] == pytest.approx(0.7 * 9.81)
    status = state.status
    assert status is not None and status.pressed and status.bumped
    assert status.current[KNEE] == pytest.approx(1.0)
    assert status.charge == pytest.approx(0.4) and status.heat[24] == 3


def test_commands_are_targets_and_stiffness_with_lights(
    daemon: Daemon,
) -> None:
    robot = daemon.robot
    robot.show(SafetyState.READY, sees=True)
    angles = np.linspace(0.0, 0.24, 25)
    robot.command(JointTargets(angles, np.full(25, 0.5), np.zeros(25)))
    told = daemon.answer()
    np.testing.assert_allclose(told["Position"], angles, atol=1e-7)
    assert told["Stiffness"] == [0.5] * 25
    assert told["Chest"] == [0.0, 1.0, 0.0] and told["LEye"] == [1.0] * 24


def test_a_frame_without_a_command_is_answered_by_lights(
    daemon: Daemon,
) -> None:
    """A silent client would stop some worlds."""
    daemon.robot.listen()
    daemon.robot.show(SafetyState.LIMP, sees=False)
    daemon.robot.listen()
    told = daemon.answer()
    assert "Position" not in told and told["Chest"] == [1.0, 0.0, 0.0]


def test_a_queue_that_was_left_is_read_to_its_newest_frame(
    daemon: Daemon,
) -> None:
    frames = [frame_of(i, [0.1 * i] * 25, **REAL) for i in range(1, 6)]
    daemon.robot.listen()
    daemon.send(*frames)
    state = daemon.robot.listen()
    assert state is not None and state.time == pytest.approx(5 * TICK)
    assert state.joint_positions[0] == pytest.approx(0.5)
    assert state.joint_velocities is not None
    assert state.joint_velocities[0] == pytest.approx(0.1 / TICK)


@pytest.mark.parametrize(
    "damaged", [b"\x00" * 896, b"\xff" * 896, msgpack.packb(["x" * 892])]
)
def test_a_damaged_frame_is_none_and_counts(
    damaged: bytes, daemon: Daemon
) -> None:
    daemon.robot.listen()
    daemon.send(damaged[:896].ljust(896, b"\x00"))
    assert daemon.robot.listen() is None
    daemon.send(frame_of(2, REST, **REAL))
    state = daemon.robot.listen()
    assert state is not None and state.time == pytest.approx(2 * TICK)


def test_silence_is_none_and_an_end_is_an_error(daemon: Daemon) -> None:
    daemon.robot.listen()
    assert daemon.robot.listen() is None
    daemon.client.shutdown(socket.SHUT_RDWR)
    with pytest.raises(ConnectionError, match="the robot closed"):
        daemon.robot.listen()


def test_a_robot_that_is_stiff_is_released_within_half_a_second(
    daemon: Daemon,
) -> None:
    """By the guardian, which has commanded nothing itself."""
    stiff = [0.8] * 25
    daemon.send(frame_of(1, [0.2] * 25, **REAL, Stiffness=stiff))
    began = monotonic()
    daemon.robot.release()
    assert monotonic() - began > 0.3
    told = [daemon.answer() for _ in range(42)]
    shares = [each["Stiffness"][0] for each in told]
    assert shares == sorted(shares, reverse=True) and shares[-1] == 0.0
    assert shares[0] == pytest.approx(0.8 * 41 / 42)
    assert told[0]["Position"][3] == pytest.approx(0.2)


def test_a_robot_that_is_limp_already_is_released_at_once(
    daemon: Daemon,
) -> None:
    robot = daemon.robot
    robot.command(JointTargets(np.zeros(25), np.full(25, 0.01), np.zeros(25)))
    robot.release()
    daemon.answer()
    assert set(daemon.answer()["Stiffness"]) == {0.0}
    daemon.client.setblocking(False)
    with pytest.raises(BlockingIOError):  # by one command, not by a ramp
        daemon.client.recv(1)


def played(path: Path, *words: str) -> "subprocess.Popen[str]":
    command = [sys.executable, "-m", "stepaside", "play"]
    return subprocess.Popen(
        [*command, f"lola:{path}", *words], stderr=subprocess.PIPE, text=True
    )


class TimedDaemon(Thread):
    """A robot that keeps time, and is where it was told to be."""

    def __init__(self, path: Path) -> None:
        super().__init__(daemon=True)
        self.listener, self.stiffness = listening(path), REST
        self.position, self.ends, self.number = REST, False, 0

    def run(self) -> None:
        """Send a frame every 12 ms, whether it is answered or not."""
        client, _ = self.listener.accept()
        client.setblocking(False)
        answers = msgpack.Unpacker()
        with client, suppress(OSError):
            while not self.ends:
                told = {"Stiffness": self.stiffness, **REAL}
                with suppress(BlockingIOError):
                    client.send(frame_of(self.number, self.position, **told))
                    data = client.recv(1 << 16)
                    answers.feed(data)
                for answer in answers:
                    self.position = answer.get("Position", self.position)
                    self.stiffness = answer.get("Stiffness", self.stiffness)
                self.number += 1
                sleep(TICK)


@pytest.mark.slow
@pytest.mark.parametrize("fate", [signal.SIGKILL, signal.SIGSTOP])
def test_the_guardian_releases_a_robot_that_has_one_client(
    fate: signal.Signals, tmp_path: Path
) -> None:
    robot = TimedDaemon(tmp_path / "t")
    robot.start()
    play = played(tmp_path / "t")
    try:
        until(lambda: robot.stiffness[KNEE] > 0.3)
        play.send_signal(fate)
        until(lambda: max(robot.stiffness) == 0.0)
        assert play.wait(60.0) == -signal.SIGKILL
    finally:
        robot.ends = True
        with suppress(ProcessLookupError):
            os.kill(play.pid, signal.SIGCONT)
        play.kill()
        play.communicate()
