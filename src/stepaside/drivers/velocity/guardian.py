"""A second process that stops the robot if control dies or freezes.

Some robots walk on for ever when nobody tells them to stop. The guardian is
forked before control loads what speaks to the robot, and hears from control
whether the robot moves. Silence while it does means that control is dead or
frozen: the guardian ends it, so that two never speak at once, opens a line
of its own and asks for rest.
"""

import os
import select
import signal
import socket
from collections.abc import Callable
from contextlib import suppress

from .body import REST, Report, Velocity, VelocityBody

SILENCE = 0.5  # of control before the guardian acts, in [s]
RESTS, MOVES, GOODBYE = b"\x01", b"\x02", b"\x00"
ENDINGS = (signal.SIGINT, signal.SIGTERM, signal.SIGHUP)


class Guardian:
    """Control's end of the line to the guardian."""

    def __init__(self, let_go: Callable[[], None]) -> None:
        """Fork the guardian, which watches until it hears goodbye.

        Args:
            let_go: Makes the robot rest, over a line of its own. It is
                called in the other process.
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
                if watch(far, parent):
                    let_go()
                code = 0
            finally:
                os._exit(code)
        far.close()
        near.setblocking(False)
        self._line: socket.socket | None = near

    def tell(self, moves: bool) -> None:
        """Say whether the robot was asked to move."""
        if self._line is not None:
            with suppress(OSError):  # a full line: it has words enough
                self._line.send(MOVES if moves else RESTS)

    def dismiss(self) -> None:
        """Say goodbye: the robot rests."""
        if self._line is None:
            return
        self._line.setblocking(True)
        with suppress(OSError):
            self._line.send(GOODBYE)
        self._line.close()
        self._line = None
        with suppress(ChildProcessError):
            os.waitpid(self._pid, 0)


def watch(line: socket.socket, control: int) -> bool:
    """Wait for goodbye, or for silence while the robot moves.

    Args:
        line: Where control says whether it does.
        control: Number of its process, which is ended if it froze.

    Returns:
        Whether the robot must be told to rest.
    """
    moves = False
    while True:
        ready, _, _ = select.select([line], [], [], SILENCE if moves else None)
        word = line.recv(1) if ready else b""
        if word == GOODBYE:
            return False
        if not word:
            break
        moves = word == MOVES
    if os.getppid() == control:
        os.kill(control, signal.SIGKILL)
    return moves


class GuardedBody:
    """A robot whose guardian hears what it is asked for."""

    def __init__(self, body: VelocityBody, guardian: Guardian) -> None:
        """Join both."""
        self._body, self._guardian = body, guardian

    def listen(self, patience: float) -> Report | None:
        """Newest report since the last."""
        return self._body.listen(patience)

    def command(self, velocity: Velocity) -> None:
        """Ask for a velocity, and say so."""
        self._guardian.tell(velocity != REST)
        self._body.command(velocity)

    def close(self) -> None:
        """Let the robot rest, and the guardian go."""
        self._body.close()
        self._guardian.dismiss()
