"""Guardian process: makes the robot safe if the control process fails.

The guardian is forked before control loads a robot library or starts
threads. At every tick control reports whether the robot is safe without it.
Silence while it is not safe means that control has died or frozen: the
guardian kills it, so that only one process commands the robot, and then
releases the robot itself.
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
PAUSE = 0.1  # between two attempts to connect, in [s]


class SessionLost(StepAsideError, ConnectionError):
    """The connection to the robot failed or its data cannot be trusted."""


def open_with_retries(
    open_robot: Callable[[], Opened], patience: float
) -> Opened:
    """Connect to a robot, retrying until a timeout.

    Args:
        open_robot: Function that connects, or raises SessionLost.
        patience: Timeout, in [s]; 0 tries once.

    Returns:
        Result of ``open_robot``.

    Raises:
        SessionLost: If the last attempt fails.
    """
    deadline = monotonic() + patience
    is_logged = False
    while True:
        try:
            return open_robot()
        except SessionLost as error:
            if monotonic() >= deadline:
                raise
            if not is_logged:
                log.info("%s; retrying for up to %g s", error, patience)
                is_logged = True
            sleep(PAUSE)


# First byte of a message.
DISMISS, SAFE, UNSAFE, RELEASE = b"\x00", b"\x01", b"\x02", b"\x03"
MAX_MESSAGE = 4096  # size of a message, in bytes
TERMINATION_SIGNALS = (signal.SIGINT, signal.SIGTERM, signal.SIGHUP)


class Guardian:
    """Handle of the control process on its guardian.

    Attributes:
        pid: Number of the guardian process.
    """

    def __init__(
        self,
        let_go: Callable[[bytes], None],
        silence: float,
        *,
        prepare: Callable[[], None] | None = None,
    ) -> None:
        """Fork the guardian, which watches until it is dismissed.

        Args:
            let_go: Function that releases the robot, given the data of the
                last call of :meth:`hold`. Called in the guardian process.
            silence: Time without a message from control after which the
                guardian acts, in [s].
            prepare: Function called once when the guardian process starts,
                so that ``let_go`` needs less time.
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
                if prepare is not None:
                    prepare()
                data = _watch(far, parent, silence)
                if data is not None:
                    let_go(data)
                code = 0
            finally:
                os._exit(code)
        far.close()
        near.setblocking(False)
        self._socket: socket.socket | None = near

    def hold(self, data: bytes = b"") -> None:
        """Report that the robot must be released if control ends now.

        Args:
            data: Argument of ``let_go`` in that case.
        """
        self._send(UNSAFE + data)

    def leave(self) -> None:
        """Report that the robot is safe without control, until ``hold``."""
        self._send(SAFE)

    def release(self, data: bytes = b"") -> None:
        """Have the guardian release the robot now, and wait until it has.

        Args:
            data: Argument of ``let_go``.
        """
        self._end(RELEASE + data)

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


def _watch(
    messages: socket.socket, control: int, silence: float
) -> bytes | None:
    """Wait for dismissal, or for silence while the robot is not safe.

    Args:
        messages: Socket that receives the messages of control.
        control: Process number of control, which is killed if it froze.
        silence: Time after which control counts as frozen, in [s].

    Returns:
        Data of the last ``hold`` if the robot must be released, else None.
    """
    held: bytes | None = None
    while True:
        timeout = None if held is None else silence
        ready, _, _ = select.select([messages], [], [], timeout)
        message = messages.recv(MAX_MESSAGE) if ready else b""
        kind = message[:1]
        if kind == DISMISS or (ready and not message and held is None):
            return None
        if kind == RELEASE:
            return message[1:]
        if not message:
            break
        held = message[1:] if kind == UNSAFE else None
    if os.getppid() == control:
        os.kill(control, signal.SIGKILL)
    return held
