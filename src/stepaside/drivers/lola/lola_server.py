"""The robot's side of LoLA, for a robot that is simulated."""

import logging
from collections.abc import Sequence
from typing import Any

import msgpack

from ...core.poses import Array
from ..joint.frames import ActuatorFrame, pack_sensors, take_actuators
from ..joint.listener import ClientListener
from ..joint.served_joints import ServedJointRobot, ServedJoints
from .camera_offer import CameraOffer
from .lola_address import LolaAddress
from .sight_offer import SightOffer
from .wire import LIMITS, LONGEST_ANSWER, WireError


class ActuatorFrameReader:
    """Cuts a client's stream into frames.

    Answers have no fixed length: some peers write whole numbers as
    integers. A stream that held anything but answers cannot be read on.
    """

    def __init__(self) -> None:
        """Begin with an empty stream."""
        self._unpacker: Any = msgpack.Unpacker(
            max_buffer_size=16 * LONGEST_ANSWER, **LIMITS
        )
        self._pending = 0

    def feed(self, data: bytes) -> list[ActuatorFrame]:
        """Take bytes, give the frames that they complete.

        Raises:
            WireError: If the stream holds anything else.
        """
        frames = []
        try:
            self._unpacker.feed(data)
            decoded = list(self._unpacker)
        except Exception as error:  # whatever foreign bytes make it raise
            name = type(error).__name__
            raise WireError(f"no answer: {name} {error}".strip()) from error
        for answer in decoded:
            frames.append(take_actuators(answer))
        self._pending = len(data) + (0 if frames else self._pending)
        if self._pending > 2 * LONGEST_ANSWER and not frames:
            raise WireError(
                f"no answer ends within {2 * LONGEST_ANSWER} bytes"
            )
        return frames


log = logging.getLogger(__name__)


class LolaServer:
    """Speaks LoLA for one robot: a frame out, an answer in, every tick.

    A tick is :meth:`speak`, then :meth:`hear` until the answer is there or
    time is up, then :meth:`act`. Nothing here waits or looks at a clock.

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
        cameras: bool = False,
    ) -> None:
        """Listen for a client.

        Args:
            address: Where.
            robot: Whom to speak for.
            joint_names: Its joints, in the order of its measurements.
            lock_step: Whether its world waits for answers.
            ideal_sight: Whether the true line of sight is offered beside.
            cameras: Whether what its cameras see is offered beside.

        Raises:
            ConfigurationError: If the address cannot be listened on.
            ModelError: If LoLA has no motor for one of the joints.
        """
        self._joints = ServedJoints(robot, joint_names)
        self._lock_step = lock_step
        # First, so that who finds the robot finds what is beside it.
        self._beside: list[SightOffer | CameraOffer] = []
        try:
            if ideal_sight and address.sight is not None:
                self._beside.append(SightOffer(address.sight))
            if cameras and address.cameras is not None:
                self._beside.append(CameraOffer(address.cameras))
            self._listener = ClientListener(address)
        except BaseException:
            self._close_beside()
            raise
        self._reader = ActuatorFrameReader()
        self._chest_pressed = False
        self.count = -1
        self.answered = False

    @property
    def share(self) -> float:
        """What is left of the commanded stiffness without answers."""
        return self._joints.share

    @property
    def stiffness(self) -> Array:
        """Of the motors now. Shape (25,)."""
        return self._joints.stiffness

    @property
    def connected(self) -> bool:
        """Whether a client is there."""
        return self._listener.client is not None

    @property
    def ready(self) -> bool:
        """Whether a client is there and holds the robot stiff."""
        return self.connected and self._joints.stiff

    @property
    def refused(self) -> int:
        """Clients that came while there was one."""
        return self._listener.refused

    def fileno(self) -> int:
        """Descriptor to wait on for answers; -1 without a client."""
        client = self._listener.client
        return -1 if client is None else client.fileno()

    def press(self, pressed: bool) -> None:
        """Press the chest button, or let it go."""
        self._chest_pressed = pressed

    def speak(self) -> None:
        """Take a client that has come, and send it a frame."""
        self.hear()  # what comes too late is no answer to the next frame
        if self._listener.accept():
            self._reader, self.count = ActuatorFrameReader(), -1
            for offer in self._beside:
                offer.forget()
            log.info("%s: client connected", self._listener.address)
        measurement = self._joints.sense()
        self.answered = False
        if not self.connected:
            return
        self.count += 1
        for offer in self._beside:
            offer.tell(measurement, self.count)
        frame = self._joints.frame(
            self.count,
            chest_pressed=self._chest_pressed,
            lock_step=self._lock_step,
        )
        self._try(pack_sensors(frame))

    def hear(self) -> bool:
        """Take answers that have come; whether nobody is waited for."""
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
        """Let the robot do what was asked, as stiff as it may be."""
        self._joints.act()

    def drop(self, why: str) -> None:
        """Let go of a client, and say why; another may come."""
        self._listener.drop(why)

    def close(self) -> None:
        """Let go of the client."""
        self._listener.close()
        self._close_beside()

    def _close_beside(self) -> None:
        for offer in self._beside:
            offer.close()

    def _try(self, data: bytes) -> None:
        try:
            self._listener.send(data)
        except OSError as error:
            self._listener.drop(error)
