"""A second process that lets go of the robot if control dies or freezes.

It is forked before control loads anything that speaks to the robot or starts
threads, and hears from control at every tick whether the robot may be left
to itself. Silence while it may not means that control is dead or frozen: the
guardian ends it, so that two never speak at once, and lets go by itself.
"""

import logging
import os
import select
import signal
import socket
from collections.abc import Callable
from contextlib import suppress
from time import monotonic, sleep
from typing import TypeVar

from ..core.errors import StepAsideError

log = logging.getLogger(__name__)

Opened = TypeVar("Opened")
PAUSE = 0.1  # between two tries to connect, in [s]


class SessionLost(StepAsideError, ConnectionError):
    """The robot cannot be heard or reached any more."""


def open_within(open_robot: Callable[[], Opened], patience: float) -> Opened:
    """Connect to a robot that may not be there yet.

    Args:
        open_robot: Connects, or raises SessionLost.
        patience: How long to try again, in [s]; 0 tries once.

    Raises:
        SessionLost: If the last try fails.
    """
    until, said = monotonic() + patience, False
    while True:
        try:
            return open_robot()
        except SessionLost as error:
            if monotonic() >= until:
                raise
            if not said:
                log.info("%s; waits up to %g s for it", error, patience)
                said = True
            sleep(PAUSE)


GOODBYE, SAFE, HELD = b"\x00", b"\x01", b"\x02"  # first byte of a word
LONGEST = 4096  # of a word, in bytes
ENDINGS = (signal.SIGINT, signal.SIGTERM, signal.SIGHUP)


class Guardian:
    """Control's end of the line to the guardian."""

    def __init__(
        self,
        let_go: Callable[[bytes], None],
        silence: float,
        *,
        prepare: Callable[[], None] | None = None,
    ) -> None:
        """Fork the guardian, which watches until it hears goodbye.

        Args:
            let_go: Lets go of the robot, given the last that was told of
                it. It is called in the other process.
            silence: Of control before the guardian acts, in [s].
            prepare: Called there at once, so that letting go is quick.
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
                if prepare is not None:
                    prepare()
                word = _watch(far, parent, silence)
                if word is not None:
                    let_go(word)
                code = 0
            finally:
                os._exit(code)
        far.close()
        near.setblocking(False)
        self._line: socket.socket | None = near

    def hold(self, word: bytes = b"") -> None:
        """Say that the robot must be let go of if control ends now.

        Args:
            word: What the guardian needs to know for that.
        """
        self._send(HELD + word)

    def leave(self) -> None:
        """Say that the robot may be left for as long as control likes."""
        self._send(SAFE)

    def dismiss(self) -> None:
        """Say goodbye to a guardian that is not needed any more."""
        if self._line is None:
            return
        self._line.setblocking(True)
        self._send(GOODBYE)
        self._line.close()
        self._line = None
        with suppress(ChildProcessError):
            os.waitpid(self._pid, 0)

    def _send(self, word: bytes) -> None:
        if self._line is not None:
            with suppress(OSError):  # a full line: it has words enough
                self._line.send(word)


def _watch(line: socket.socket, control: int, silence: float) -> bytes | None:
    """Wait for goodbye, or for silence while the robot is held.

    Args:
        line: Where control says what there is to say.
        control: Number of its process, which is ended if it froze.
        silence: After which control counts as frozen, in [s].

    Returns:
        The last word about a robot that must be let go of.
    """
    held: bytes | None = None
    while True:
        patience = None if held is None else silence
        ready, _, _ = select.select([line], [], [], patience)
        word = line.recv(LONGEST) if ready else b""
        kind = word[:1]
        if kind == GOODBYE or (ready and not word and held is None):
            return None
        if not word:
            break
        held = word[1:] if kind == HELD else None
    if os.getppid() == control:
        os.kill(control, signal.SIGKILL)
    return held
