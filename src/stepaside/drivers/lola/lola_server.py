"""Server of LoLA for a simulated robot."""

import logging
from collections.abc import Sequence
from typing import Any

import msgpack

from ...core.poses import Array
from .listener import ClientListener
from .lola_address import LolaAddress
from .lola_frames import ActuatorFrame, clip_actuators, pack_sensors
from .served_joints import ServedJointRobot, ServedJoints
from .sight_socket import SightServer
from .wire import LIMITS, LONGEST_ANSWER, WireError


class ActuatorFrameReader:
    """Incremental decoder of a client's actuator frames.

    The frames have no fixed length: some clients write whole numbers as
    integers. An invalid stream cannot be continued.
    """

    def __init__(self) -> None:
        """Start with an empty buffer."""
        self._unpacker: Any = msgpack.Unpacker(
            max_buffer_size=16 * LONGEST_ANSWER, **LIMITS
        )
        self._pending = 0

    def feed(self, data: bytes) -> list[ActuatorFrame]:
        """Add received bytes, and return the frames that are complete.

        Raises:
            WireError: If the stream is not one of actuator frames.
        """
        frames = []
        try:
            self._unpacker.feed(data)
            decoded = list(self._unpacker)
        except Exception as error:  # msgpack raises many kinds of errors
            name = type(error).__name__
            raise WireError(
                f"cannot decode an actuator frame: {name} {error}".strip()
            ) from error
        for answer in decoded:
            frames.append(clip_actuators(answer))
        self._pending = len(data) + (0 if frames else self._pending)
        if self._pending > 2 * LONGEST_ANSWER and not frames:
            raise WireError(
                "an actuator frame must end within "
                f"{2 * LONGEST_ANSWER} bytes, got {self._pending}"
            )
        return frames


log = logging.getLogger(__name__)


class LolaServer:
    """LoLA interface of one simulated robot.

    A tick is :meth:`speak`, which sends a sensor frame, then :meth:`hear`
    until the answer has arrived or time is up, then :meth:`act`. No method
    waits or reads a clock.

    Attributes:
        count: Number of the last frame sent in this session; -1 before.
        answered: Whether the last frame has been answered.
    """

    def __init__(
        self,
        address: LolaAddress,
        robot: ServedJointRobot,
        joint_names: Sequence[str],
        *,
        lock_step: bool = False,
        ideal_sight: bool = True,
    ) -> None:
        """Listen for a client.

        Args:
            address: Address to listen on.
            robot: The simulated robot.
            joint_names: Its joints, in the order of its measurements.
            lock_step: Whether the simulation waits for answers.
            ideal_sight: Whether the true line of sight is offered.

        Raises:
            ConfigurationError: If the address cannot be listened on.
            ModelError: If LoLA has no motor for one of the joints.
        """
        self._joints = ServedJoints(robot, joint_names)
        self._lock_step = lock_step
        # First, so that a client that finds the robot finds it, too.
        self._sight: SightServer | None = None
        try:
            if ideal_sight and address.sight is not None:
                self._sight = SightServer(address.sight)
            self._listener = ClientListener(address)
        except BaseException:
            self._close_sight()
            raise
        self._reader = ActuatorFrameReader()
        self._chest_pressed = False
        self.count = -1
        self.answered = False

    @property
    def share(self) -> float:
        """Fraction of the commanded stiffness, which decays in silence."""
        return self._joints.share

    @property
    def stiffness(self) -> Array:
        """Stiffness of the motors now. Shape (25,)."""
        return self._joints.stiffness

    @property
    def connected(self) -> bool:
        """Whether a client is connected."""
        return self._listener.client is not None

    @property
    def ready(self) -> bool:
        """Whether a client is connected and holds the robot stiff."""
        return self.connected and self._joints.stiff

    @property
    def refused(self) -> int:
        """Number of clients refused because one was connected."""
        return self._listener.refused

    def fileno(self) -> int:
        """Return the descriptor to wait on; -1 without a client."""
        client = self._listener.client
        return -1 if client is None else client.fileno()

    def press(self, pressed: bool) -> None:
        """Press the chest button, or release it."""
        self._chest_pressed = pressed

    def speak(self) -> None:
        """Accept a waiting client, and send a frame."""
        self.hear()  # a late answer must not count for the next frame
        if self._listener.accept():
            self._reader, self.count = ActuatorFrameReader(), -1
            if self._sight is not None:
                self._sight.restart()
            log.info("%s: client connected", self._listener.address)
        measurement = self._joints.sense()
        self.answered = False
        if not self.connected:
            return
        self.count += 1
        if self._sight is not None:
            self._sight.send(measurement, self.count)
        frame = self._joints.frame(
            self.count,
            chest_pressed=self._chest_pressed,
            lock_step=self._lock_step,
        )
        self._try(pack_sensors(frame))

    def hear(self) -> bool:
        """Take answers that have arrived.

        Returns:
            Whether the last frame was answered, or no client is connected.
        """
        try:
            data = self._listener.receive(LONGEST_ANSWER)
            frames = self._reader.feed(data) if data else []
        except (OSError, WireError) as error:
            self._listener.drop(error)
            frames = []
        for frame in frames:
            self._joints.take(frame)
            self.answered = True
        return self.answered or not self.connected

    def act(self) -> None:
        """Apply the newest commands for one tick."""
        self._joints.act()

    def drop(self, why: str) -> None:
        """Disconnect the client, and log why; another may connect."""
        self._listener.drop(why)

    def close(self) -> None:
        """Disconnect the client and stop the server."""
        self._listener.close()
        self._close_sight()

    def _close_sight(self) -> None:
        if self._sight is not None:
            self._sight.close()

    def _try(self, data: bytes) -> None:
        try:
            self._listener.send(data)
        except OSError as error:
            self._listener.drop(error)
