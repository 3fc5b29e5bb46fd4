"""Guardian process: makes the robot safe if the control process fails.

The guardian is forked before control loads a robot library or starts
threads. At every tick control reports whether the robot is safe without it.
Silence while it is not safe means that control has died or frozen: the
guardian kills it, so that only one process commands the robot, and then
releases the robot itself.
"""

import os
import select
import signal
import socket
from collections.abc import Callable
from contextlib import suppress
from typing import Any

from ..core.errors import StepAsideError
from .method_thread import CLOSE_TIMEOUT, MethodThread
from .robot import JointRobot

DISMISS, SAFE, UNSAFE, RELEASE = b"\x00", b"\x01", b"\x02", b"\x03"
TERMINATION_SIGNALS = (signal.SIGINT, signal.SIGTERM, signal.SIGHUP)
JOINT_SILENCE, VELOCITY_SILENCE = 0.3, 0.5  # without control, in [s]
FEEDING = 0.1  # between two messages while control waits, in [s]


class Guardian:
    """Handle of the control process on its guardian."""

    def __init__(
        self, join: Callable[[], Callable[[], None]], silence: float
    ) -> None:
        """Fork the guardian, which acts after a silence of control [s].

        A function connects to the robot and returns one that halts it. It is
        called in the guardian process at once, as connecting takes longer
        than halting; and again, if it failed, when the robot is to be halted.
        """
        near, far = socket.socketpair(socket.AF_UNIX, socket.SOCK_SEQPACKET)
        parent = os.getpid()
        self.pid = os.fork()
        if self.pid == 0:
            code = 1
            try:
                near.close()
                # Control handles these, and dismisses the guardian.
                for number in TERMINATION_SIGNALS:
                    signal.signal(number, signal.SIG_IGN)
                halt = None
                with suppress(StepAsideError):
                    halt = join()
                if _must_halt(far, parent, silence):
                    (halt or join())()
                code = 0
            finally:
                os._exit(code)
        far.close()
        near.setblocking(False)
        self._socket: socket.socket | None = near

    def hold(self) -> None:
        """Report that the robot must be released if control ends now."""
        self._send(UNSAFE)

    def leave(self) -> None:
        """Report that the robot is safe without control, until ``hold``."""
        self._send(SAFE)

    def release(self) -> None:
        """Have the guardian release the robot now, and wait until it has."""
        self._end(RELEASE)

    def dismiss(self) -> None:
        """End the guardian process; the robot is not released."""
        self._end(DISMISS)

    def _end(self, message: bytes) -> None:
        if self._socket is None:
            return
        self._socket.setblocking(True)
        self._send(message)
        self._socket.close()
        self._socket = None
        with suppress(ChildProcessError):
            os.waitpid(self.pid, 0)

    def _send(self, message: bytes) -> None:
        if self._socket is not None:
            with suppress(OSError):  # full: enough messages are queued
                self._socket.send(message)


def _must_halt(messages: socket.socket, control: int, silence: float) -> bool:
    """Wait for dismissal, or for a silence in [s] while not safe."""
    held = False
    while True:
        timeout = silence if held else None
        ready, _, _ = select.select([messages], [], [], timeout)
        message = messages.recv(1) if ready else b""
        if message == DISMISS or (ready and not message and not held):
            return False
        if message == RELEASE:
            return True
        if not message:
            break
        held = message == UNSAFE
    if os.getppid() == control:
        os.kill(control, signal.SIGKILL)
    return True


def fork_guardian(
    make: Callable[[], Any], robot: Any, silence: float | None = None
) -> Guardian | None:
    """Fork the guardian of a robot, before connecting starts threads."""
    joints = isinstance(robot, JointRobot)
    silence = silence or (JOINT_SILENCE if joints else VELOCITY_SILENCE)
    if robot.shares_connection:
        return Guardian(lambda: robot.release, silence)
    if robot.keeps_targets if joints else robot.keeps_walking:
        return Guardian(lambda: join_halter(make), silence)
    if joints:
        return None
    # It stops by itself when the guardian has ended a frozen control.
    return Guardian(lambda: lambda: None, silence)


def join_halter(make: Callable[[], Any]) -> Callable[[], None]:
    """Connect to a robot in advance, and return a function that halts it."""
    methods = MethodThread(make())
    methods.open()
    halting = halting_method(methods.robot)
    return lambda: methods.run(halting, CLOSE_TIMEOUT)


def halting_method(robot: Any) -> str:
    """Return the name of the method that stops or releases a robot."""
    return "release" if isinstance(robot, JointRobot) else "stop"
