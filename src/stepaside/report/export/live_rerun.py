"""Live game for the Rerun viewer, served on this machine."""

import socket
from pathlib import Path
from subprocess import DEVNULL, Popen, TimeoutExpired
from time import monotonic, sleep
from typing import Any

from ...core.errors import ConfigurationError
from .live_recording import LivePiece
from .rerun_recording import (
    APPLICATION,
    log_models,
    log_room,
    log_samples,
    rerun_blueprint,
)

HOST = "127.0.0.1"
STARTING = 10.0  # longest time that the server takes to start, in [s]
MEMORY = "500MB"  # of what is kept for viewers that connect later


class LiveRerun:
    """Server to which Rerun viewers connect; each game is a recording.

    It is Rerun's own program, in a process of its own, as the server inside
    its library listens on all interfaces.

    Attributes:
        address: Address for the command ``rerun``.
    """

    def __init__(self, port: int) -> None:
        """Serve on a port of this machine.

        Raises:
            ConfigurationError: If the port is in use.
        """
        import rerun_cli

        if _answers(port):
            raise ConfigurationError(
                f"Rerun cannot be served at port {port}: it is in use"
            )
        options = ("--serve-grpc", "--bind", HOST, "--port", str(port))
        memory = ("--server-memory-limit", MEMORY)
        self._server = Popen(
            [Path(rerun_cli.__path__[0]) / "rerun", *options, *memory],
            stdout=DEVNULL,
            stderr=DEVNULL,
            start_new_session=True,  # Ctrl-C is for this process only
        )
        self.address = f"rerun+http://{HOST}:{port}/proxy"
        self._stream: Any = None
        deadline = monotonic() + STARTING
        while not _answers(port):
            if self._server.poll() is not None or monotonic() > deadline:
                self.close()
                raise ConfigurationError(
                    f"Rerun cannot be served at port {port}: its server has "
                    "ended"
                )
            sleep(0.05)

    def show(self, piece: LivePiece) -> None:
        """Log a piece; the first of a game begins a new recording."""
        recording, begins = piece
        if begins:
            self._begin(piece)
        if begins or recording.run.robots != recording.run.players:
            log_room(self._stream, recording)
        log_samples(self._stream, recording)
        self._stream.flush()

    def _begin(self, piece: LivePiece) -> None:
        import rerun

        self._stream = rerun.RecordingStream(APPLICATION)
        self._stream.connect_grpc(self.address)
        self._stream.send_blueprint(
            rerun_blueprint(piece.recording), make_active=True
        )
        log_models(self._stream, piece.recording)

    def close(self) -> None:
        """End the server."""
        if self._stream is not None:
            self._stream.disconnect()
        self._server.terminate()
        try:
            self._server.wait(STARTING)
        except TimeoutExpired:
            self._server.kill()


def _answers(port: int) -> bool:
    """Return whether a program listens on a port."""
    try:
        socket.create_connection((HOST, port), timeout=1.0).close()
    except OSError:
        return False
    return True
