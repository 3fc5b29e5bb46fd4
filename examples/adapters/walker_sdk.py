"""Stand-in for a vendor's SDK: a client of ``simulated_walker.py``.

It has what the SDKs of walking humanoids have: connect, move at a velocity,
stop, and a state that arrives by itself. All values are in SI units.
"""

import json
import socket
from dataclasses import dataclass

ADDRESS = ("127.0.0.1", 29600)


@dataclass(frozen=True)
class WalkerState:
    """Measured state.

    Attributes:
        time: Time of the measurement on the robot's clock, in [s].
        x: Position in odometry, in [m].
        y: Position in odometry, in [m].
        yaw: Heading in odometry, in [rad].
        person: Position of the nearest person ahead and to the left of the
            robot, in [m]; None if none is detected.
    """

    time: float
    x: float
    y: float
    yaw: float
    person: tuple[float, float] | None


@dataclass(frozen=True)
class WalkerImage:
    """Image of the camera in the head.

    Attributes:
        time: Time of the exposure on the robot's clock, in [s].
        width: Columns, in [px].
        height: Rows, in [px].
        focal: Focal length, in [px].
        up: Height of the camera, in [m].
        head: Yaw to the left and pitch downward at the exposure, in [rad].
        pixels: Red, green and blue, row by row.
    """

    time: float
    width: int
    height: int
    focal: float
    up: float
    head: tuple[float, float]
    pixels: bytes


class WalkerClient:
    """Connection to the robot."""

    def __init__(self, address: tuple[str, int] = ADDRESS) -> None:
        """Make a client; it connects later."""
        self._address = address
        self._socket = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        self._camera = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)

    def Connect(self, timeout: float) -> None:
        """Subscribe to the state.

        Raises:
            ConnectionError: If the robot does not answer.
        """
        self._socket.connect(self._address)
        self._camera.connect(self._address)
        self._socket.settimeout(timeout)
        try:
            self._send(call="subscribe")
            self._socket.recv(1024)
        except OSError as error:
            raise ConnectionError(
                f"no robot answers at {self._address[0]}:{self._address[1]}"
            ) from error

    def Move(self, vx: float, vy: float, vyaw: float) -> None:
        """Walk at a velocity until the next command."""
        self._send(call="move", velocity=(vx, vy, vyaw))

    def StopMove(self) -> None:
        """Stand."""
        self.Move(0.0, 0.0, 0.0)

    def ReadState(self, timeout: float) -> WalkerState | None:
        """Return the newest state that has arrived, or None."""
        newest, wait = None, timeout
        while True:
            self._socket.settimeout(wait)
            try:
                newest = self._socket.recv(1024)
            except (BlockingIOError, TimeoutError):
                break
            wait = 0.0
        if newest is None:
            return None
        entries = json.loads(newest)
        return WalkerState(**entries)

    def MoveHead(self, yaw: float, pitch: float) -> None:
        """Turn the head, to the left and downward."""
        self._send(call="head", angles=(yaw, pitch))

    def ReadImage(self, timeout: float) -> WalkerImage | None:
        """Return an image, or None; another thread may call the rest."""
        self._camera.settimeout(timeout)
        try:
            self._camera.send(b'{"call": "image"}')
            entries, _, pixels = self._camera.recv(1 << 16).partition(b"\n")
        except (ConnectionError, TimeoutError):
            return None
        return WalkerImage(**json.loads(entries), pixels=pixels)

    def Close(self) -> None:
        """Disconnect."""
        self._send(call="unsubscribe")
        self._socket.close()
        self._camera.close()

    def _send(self, **call: object) -> None:
        self._socket.send(json.dumps(call).encode())
