"""LoLA of a simulated NAO, for tests and for clients of RoboCup's teams."""

import logging
import os
import socket
import stat
from collections.abc import Sequence
from contextlib import suppress
from typing import Any, Protocol

import numpy as np

from ..core.errors import ConfigurationError
from ..core.poses import Array
from ..perception.attitude import AttitudeFilter
from ..perception.measurement import RobotState, Sighting
from .lola import GRAVITY, JOINTS, LOCK_STEP, SIGHT, SIGHT_SUFFIX, TICK

import msgpack  # isort: skip (the error of .lola names the extra)

REAL_TIME = "stepaside-realtime-0"  # serial number of a simulated robot
LEGS = slice(7, 18)  # joints that bear the robot
SILENT = 8  # ticks without a command before stiffness decays: 0.1 s
FADING = 0.5  # from full stiffness to none, in [s]
SETTLED = 40  # ticks after which constant stiffness counts as final
NO_ECHO = 2.55  # reading of a sonar without an echo, in [m]
MAX_PATH = 107 - len(".early")  # of a socket, in bytes
log = logging.getLogger(__name__)


class ServedJointRobot(Protocol):
    """Simulated robot that can be driven by its joints."""

    def sensors(self) -> RobotState:
        """Return the measurement of this tick."""

    def command(self, targets: Array, stiffness: Array) -> None:
        """Set joint targets, in [rad], and stiffness, from 0 to 1."""


class ClientSocket:
    """Socket at a path, with at most one client."""

    def __init__(self, path: str) -> None:
        """Listen, in place of a socket that nobody listens to.

        Raises:
            ConfigurationError: If the path cannot be listened on.
        """
        self._path, self.client = path, socket.socket(socket.AF_UNIX)
        self.connected = False
        self._socket = socket.socket(socket.AF_UNIX)
        early = f"{path}.early"
        try:
            if len(path.encode()) > MAX_PATH:
                raise OSError(f"a path has at most {MAX_PATH} bytes")
            if os.path.lexists(path):
                if not stat.S_ISSOCK(os.lstat(path).st_mode):
                    raise OSError("a file of that name exists")
                with suppress(ConnectionRefusedError):
                    with socket.socket(socket.AF_UNIX) as probe:
                        probe.connect(path)
                    raise OSError("another program listens there")
            self._socket.bind(early)
            self._socket.listen()
            self._socket.setblocking(False)
            os.rename(early, path)  # it listens already when it appears
        except OSError as error:
            self._socket.close()
            raise ConfigurationError(
                f"cannot listen at {path}: {error}"
            ) from error

    def accept(self) -> bool:
        """Accept one client; return whether there is a new one."""
        is_new = False
        with suppress(BlockingIOError):
            while True:
                arrived, _ = self._socket.accept()
                if self.connected:
                    log.warning("%s: a second client is refused", self._path)
                    arrived.close()
                    continue
                arrived.setblocking(False)
                self.client, self.connected, is_new = arrived, True, True
        return is_new

    def send(self, data: bytes) -> None:
        """Send to the client, if there is one; drop it if it does not read."""
        try:
            if self.connected and self.client.send(data) < len(data):
                self.drop("it does not read")
        except OSError as error:
            self.drop(error)

    def drop(self, why: object) -> None:
        """Disconnect the client, and log why."""
        if self.connected:
            log.warning("%s: client dropped: %s", self._path, why)
            self.client.close()
            self.connected = False

    def close(self) -> None:
        """Disconnect the client, and remove the socket."""
        self.client.close()
        self.connected = False
        self._socket.close()
        with suppress(OSError):
            os.unlink(self._path)


class LolaServer:
    """LoLA interface of one simulated robot.

    A tick is :meth:`speak`, which sends a sensor frame, then :meth:`hear`
    until the answer has arrived or time is up, then :meth:`act`. No method
    waits or reads a clock. Stiffness decays if it is not commanded.
    """

    def __init__(
        self,
        path: str,
        robot: ServedJointRobot,
        joint_names: Sequence[str],
        *,
        lock_step: bool = False,
        ideal_sight: bool = True,
    ) -> None:
        """Listen for a client.

        Raises:
            ConfigurationError: If the path cannot be listened on.
        """
        self._robot, self._lock_step = robot, lock_step
        self._order = [JOINTS.index(name) for name in joint_names]
        # First, so that a client that finds the robot finds it, too.
        self._sight: ClientSocket | None = None
        if ideal_sight:
            self._sight = ClientSocket(f"{path}{SIGHT_SUFFIX}")
        try:
            self._link = ClientSocket(path)
        except ConfigurationError:
            if self._sight is not None:
                self._sight.close()
            raise
        self._serial = LOCK_STEP if lock_step else REAL_TIME
        self._attitude = AttitudeFilter(0.5, 0.0, calibration=0.0)
        self._sent: Sighting | None = None
        self._targets = np.zeros(len(JOINTS))
        self._commanded = np.zeros(len(JOINTS))
        self._has_targets = self._pressed = self._answered = False
        self._count, self._silent, self._unchanged = -1, 0, 0
        self._share = 0.0
        self._unpacker = msgpack.Unpacker(max_buffer_size=1 << 16)
        self.stiffness: Array = np.zeros(len(JOINTS))

    @property
    def connected(self) -> bool:
        """Whether a client is connected."""
        return self._link.connected

    @property
    def ready(self) -> bool:
        """Whether a client holds the legs as stiff as it wants them."""
        least = float(self.stiffness[LEGS].min())
        settled = self._unchanged >= SETTLED
        return self.connected and (least > 0.99 or (least > 0.0 and settled))

    def fileno(self) -> int:
        """Return the descriptor to wait on; -1 without a client."""
        return self._link.client.fileno() if self.connected else -1

    def press(self, pressed: bool) -> None:
        """Press the chest button, or release it."""
        self._pressed = pressed

    def speak(self) -> None:
        """Accept a waiting client, and send a frame."""
        self.hear()  # a late answer must not count for the next frame
        if self._link.accept():
            self._unpacker = msgpack.Unpacker(max_buffer_size=1 << 16)
            self._count, self._sent = -1, None
            log.info("client connected")
        measured = self._robot.sensors()
        self._attitude.update(
            measured.gyro, measured.accelerometer, (0.0, 0.0), TICK
        )
        if not self._has_targets:
            self._targets[self._order] = measured.joint_positions
        self._answered = False
        if self.connected:
            self._count += 1
            self._send_sight(measured)
            self._link.send(self._frame(measured))

    def hear(self) -> bool:
        """Take answers; return whether none is awaited any more."""
        if self.connected:
            try:
                data = self._link.client.recv(1 << 14)
                if not data:
                    raise ConnectionResetError("closed by the client")
                self._unpacker.feed(data)
                for answer in self._unpacker:
                    self._take(answer)
            except BlockingIOError:
                pass
            except (
                *(OSError, TypeError, ValueError, AttributeError),
                msgpack.exceptions.UnpackException,
            ) as error:
                self._link.drop(error)
        return self._answered or not self.connected

    def act(self) -> None:
        """Apply the newest commands for one tick."""
        if self._silent >= SILENT:
            self._share = max(0.0, self._share - TICK / FADING)
        self._silent += 1
        stiffness = self._share * self._commanded
        stays = np.array_equal(stiffness, self.stiffness)
        self._unchanged = self._unchanged + 1 if stays else 0
        self.stiffness = stiffness
        self._robot.command(self._targets[self._order], stiffness[self._order])

    def drop(self, why: str) -> None:
        """Disconnect the client, and log why; another may connect."""
        self._link.drop(why)

    def close(self) -> None:
        """Disconnect the client and stop the server."""
        self._link.close()
        if self._sight is not None:
            self._sight.close()

    def _take(self, answer: dict[str, Any]) -> None:
        """Take a client's command; lights are of no use here."""
        position, stiffness = answer.get("Position"), answer.get("Stiffness")
        if position is not None:
            self._targets = _of_all_joints("Position", position)
            self._has_targets = True
        if stiffness is not None:
            values = _of_all_joints("Stiffness", stiffness)
            self._commanded = np.clip(values, 0.0, 1.0)
            self._silent, self._share = 0, 1.0
        self._answered = True

    def _send_sight(self, measured: RobotState) -> None:
        """Send the sighting, if it is new or the client is."""
        if self._sight is None:
            return
        if self._sight.accept():
            self._sent = None
        sighting = measured.sighting
        if sighting is not None and sighting is not self._sent:
            self._sent = sighting
            age = max(measured.time - sighting.time, 0.0)
            place = sighting.bearing, sighting.distance
            self._sight.send(SIGHT.pack(b"SGHT", self._count, age, *place))

    def _frame(self, measured: RobotState) -> bytes:
        """Return the sensor frame of a measurement."""
        position = np.zeros(len(JOINTS))
        position[self._order] = measured.joint_positions
        number = float(self._count % (1 << 16))
        frame = {
            "Position": position.tolist(),
            "Stiffness": self.stiffness.tolist(),
            "Current": [0.0] * len(JOINTS),
            "Temperature": [25.0] * len(JOINTS),
            "Status": [0] * len(JOINTS),
            "Accelerometer": (-measured.accelerometer).tolist(),
            "Gyroscope": measured.gyro.tolist(),
            "Angles": [self._attitude.roll, self._attitude.pitch],
            "FSR": (measured.foot_forces / GRAVITY).tolist(),
            "Sonar": [NO_ECHO] * 2,
            "Touch": [float(self._pressed)] + [0.0] * 13,
            "Battery": [1.0, 0.0, 0.0, number],
            "RobotConfig": [self._serial, "6.0.0", self._serial, "6.0.0"],
        }
        data: bytes = msgpack.packb(frame, use_single_float=True)
        return data


def _of_all_joints(key: str, values: Any) -> Array:
    found = np.array(values, dtype=np.float64)
    if found.shape != (len(JOINTS),) or not np.isfinite(found).all():
        raise ValueError(f"{key} must have {len(JOINTS)} finite values")
    return found
