"""A second process that lets go of the robot if control dies or freezes.

It is forked before control loads anything, holds the same socket, and
hears from control at every tick what the joints were told. Silence means
that control is dead or frozen: the guardian ends it, so that two never
speak at once, and sends falling stiffness by itself. A robot need not
watch over its client for this to work.
"""

import os
import select
import signal
import socket
from contextlib import suppress
from time import sleep

import numpy as np

from ...poses import Array
from .frame_clock import TICK
from .frames import ActuatorFrame, pack_actuators
from .joints import JOINT_COUNT
from .lights import lights_for
from .safety import State

SILENCE = 0.3  # of control before the guardian acts, in [s]
FADING = 0.5  # from full stiffness to none, in [s]
GOODBYE = b"\x00"  # the robot is limp: nobody needs to watch
ENDINGS = (signal.SIGINT, signal.SIGTERM, signal.SIGHUP)
WORD_BYTES = 2 * JOINT_COUNT * 4  # targets and stiffness, as float32


class Guardian:
    """Control's end of the line to the guardian."""

    def __init__(self, robot: socket.socket) -> None:
        """Fork the guardian, which watches until it hears goodbye.

        Args:
            robot: Connected socket to the robot; stays with the caller.
        """
        near, far = socket.socketpair(socket.AF_UNIX, socket.SOCK_SEQPACKET)
        parent = os.getpid()
        self._pid = os.fork()
        if self._pid == 0:
            code = 1
            try:
                near.close()
                for ending in ENDINGS:  # control's, and it will hear of it
                    signal.signal(ending, signal.SIG_IGN)
                watch(robot, far, parent)
                code = 0
            finally:
                os._exit(code)
        far.close()
        near.setblocking(False)
        self._line: socket.socket | None = near

    def tell(self, targets: Array, stiffness: Array) -> None:
        """Say what the joints were told. Shapes (25,)."""
        if self._line is not None:
            word = np.concatenate([targets, stiffness]).astype(np.float32)
            with suppress(OSError):  # a full line: it has words enough
                self._line.send(word.tobytes())

    def dismiss(self) -> None:
        """Say goodbye to a guardian that is not needed any more."""
        if self._line is None:
            return
        self._line.setblocking(True)
        with suppress(OSError):
            self._line.send(GOODBYE)
        self._line.close()
        self._line = None
        with suppress(ChildProcessError):
            os.waitpid(self._pid, 0)


def watch(robot: socket.socket, line: socket.socket, control: int) -> None:
    """Wait for goodbye; let go of the robot if there is silence instead.

    Args:
        robot: Connected socket to the robot.
        line: Where control says what the joints were told.
        control: Number of its process, which is ended if it froze.
    """
    last: Array | None = None
    while True:
        patience = None if last is None else SILENCE
        ready, _, _ = select.select([line], [], [], patience)
        word = line.recv(WORD_BYTES) if ready else b""
        if word == GOODBYE:
            return
        if len(word) == WORD_BYTES:
            told = np.frombuffer(word, np.float32).astype(np.float64)
            # Who is limp may be left for as long as control likes.
            last = told if told[JOINT_COUNT:].any() else None
            continue
        if ready and last is None:
            return  # control is gone, and the robot limp already
        break
    if os.getppid() == control:
        os.kill(control, signal.SIGKILL)
    assert last is not None
    let_go(robot, last[:JOINT_COUNT], last[JOINT_COUNT:])


def let_go(robot: socket.socket, targets: Array, stiffness: Array) -> None:
    """Send falling stiffness to a robot, as far as it can be sent."""
    robot.setblocking(False)
    count = round(FADING / TICK)
    for left in range(count - 1, -1, -1):
        frame = ActuatorFrame(
            targets,
            stiffness * (left / count),
            lights_for(State.LIMP, sees=False, charge=0.0),
        )
        with suppress(BlockingIOError):
            while robot.recv(1 << 16):
                pass  # what it says does not matter now
        try:
            robot.send(pack_actuators(frame))
        except BlockingIOError:
            pass
        except OSError:
            return
        sleep(TICK)
