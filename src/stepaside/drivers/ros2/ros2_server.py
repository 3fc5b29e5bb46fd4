"""Server of ROS 2 topics for a simulated robot."""

import logging
from collections.abc import Sequence
from math import cos, isfinite, sin
from typing import Any

from ...perception.images import ColourImage
from ...perception.measurement import Sighting
from ..velocity.velocity_body import REST, VelocityCommand
from ..velocity.walking_robot import WalkerState, WalkingRobot
from .dds_domain import DdsParticipant
from .messages import (
    CameraInfo,
    ClockMessage,
    CompressedImage,
    Header,
    Image,
    JointState,
    Odometry,
    Point,
    PointStamped,
    PoseWithCovariance,
    String,
    TFMessage,
    Time,
    Transform,
    TransformStamped,
    Twist,
    TwistWithCovariance,
)
from .odometry_covariance import OdometryCovariance
from .topics import (
    CALIBRATION,
    COMPRESSED,
    DESCRIPTION,
    IDEAL,
    IMAGE,
    JOINTS,
    ODOMETRY,
    dds_topic,
    frame,
    pose_message,
    rotation_message,
    vector,
    yaw_rotation,
)
from .velocity_commands import CommandReader

EVERY = 4  # ticks from one report to the next: 48 ms
SILENCE = 0.5  # without a command before the robot stops, in [s]
REPEAT = 400  # polls for an answer in lock step before a report is repeated
log = logging.getLogger(__name__)


class WorldClock:
    """Publisher of simulated time on one domain."""

    def __init__(self, dds: DdsParticipant) -> None:
        """Create the publisher of ``/clock``."""
        self._writer = dds.writer(dds_topic("", "clock"), ClockMessage)
        self._published = -1.0

    def publish(self, time: float) -> None:
        """Publish the time, in [s], if it has changed."""
        if time != self._published:
            self._published = time
            self._writer.write(ClockMessage(Time.of(time)))


class CameraTopics:
    """Publisher of raw and compressed images with their calibration.

    The frame of the images is an optical one, as REP 103 has it: x to the
    right, y down, z ahead.
    """

    def __init__(self, dds: DdsParticipant, namespace: str) -> None:
        """Create the publishers.

        Args:
            dds: DDS participant; the caller closes it.
            namespace: Namespace of the robot, with a leading slash; or empty.
        """
        self._frame = frame(namespace, "camera_optical_frame")
        self._calibration = dds.writer(
            dds_topic(namespace, CALIBRATION), CameraInfo
        )
        self._raw = dds.writer(dds_topic(namespace, IMAGE), Image)
        self._compressed = dds.writer(
            dds_topic(namespace, COMPRESSED), CompressedImage
        )
        self._published: ColourImage | None = None

    def publish(self, image: ColourImage | None) -> None:
        """Publish an image that is new, on topics with a subscriber."""
        if image is None or image is self._published:
            return
        # Imported here, as only images need OpenCV.
        from .image_messages import (
            camera_info_message,
            compressed_message,
            image_message,
        )

        self._published = image
        header = Header(Time.of(image.time), self._frame)
        if self._calibration.get_matched_subscriptions():
            self._calibration.write(camera_info_message(header, image.camera))
        if self._raw.get_matched_subscriptions():
            self._raw.write(image_message(header, image.pixels))
        if self._compressed.get_matched_subscriptions():
            self._compressed.write(compressed_message(header, image.pixels))


class Ros2Server:
    """ROS 2 interface of one simulated robot.

    The first participant that sends a command is the commander until it
    leaves; commands of others are refused. Commands are ``Twist`` or
    ``TwistStamped``, whose stamp is ignored.

    Attributes:
        refused: Number of commands that were refused.
        answered: Whether the last report has been answered.
    """

    def __init__(
        self,
        dds: DdsParticipant,
        namespace: str,
        robot: WalkingRobot,
        joint_names: Sequence[str],
        clock: WorldClock,
        *,
        tick: float,
        lock_step: bool = False,
        urdf: str = "",
    ) -> None:
        """Create the topics.

        Args:
            dds: DDS participant; the caller closes it.
            namespace: Namespace of the robot, with a leading slash; or empty.
            robot: The simulated robot.
            joint_names: Names of its joints.
            clock: Publisher of simulated time.
            tick: Time between two calls of :meth:`speak`, in [s].
            lock_step: Whether the simulation waits for answers.
            urdf: URDF of the robot; empty for none.
        """
        self._robot, self._namespace = robot, namespace
        self._clock = clock
        self._names = list(joint_names)
        self._tick, self._lock_step = tick, lock_step

        def writer(name: str, kind: type[Any]) -> Any:
            return dds.writer(dds_topic(namespace, name), kind)

        self._odometry = writer(ODOMETRY, Odometry)
        self._joints = writer(JOINTS, JointState)
        self._sight = writer(IDEAL, PointStamped)
        self._transforms = dds.writer(dds_topic("", "tf"), TFMessage, 100)
        self._covariance = OdometryCovariance()
        self._description: Any = None
        if urdf:
            self._description = dds.writer(
                dds_topic(namespace, DESCRIPTION), String, latched=True
            )
            self._description.write(String(urdf))
        self._commands = CommandReader(dds, namespace)
        self._cameras = CameraTopics(dds, namespace)
        self._commander: int | None = None
        self._published: Sighting | None = None
        self._ticks = 0
        self._silent = 0
        self._velocity = REST
        self._closed = self._ignores_lateral = False
        self._state: WalkerState | None = None
        self._polls = 0
        self.refused = 0
        self.answered = True

    @property
    def connected(self) -> bool:
        """Whether there is a commander."""
        return self._commander is not None

    @property
    def ready(self) -> bool:
        """Whether there is a commander, so that the game may begin."""
        return self.connected

    def fileno(self) -> int:
        """Return -1: there is no descriptor to wait on."""
        return -1

    def press(self, pressed: bool) -> None:
        """Align the reports with the tick at which the button is released."""
        if not pressed:
            self._ticks = 0

    def speak(self) -> None:
        """Publish a report, if one is due at this tick."""
        self.hear()
        if self._ticks % EVERY == 0:
            self._state = self._robot.state()
            self._publish(self._state)
            self.answered, self._polls = False, 0
        self._ticks += 1

    def hear(self) -> bool:
        """Take commands that have arrived.

        Returns:
            Whether the simulation may go on.
        """
        present = self._commands.commanders()
        if self._commander is not None and self._commander not in present:
            log.warning("%s: commander left", self._namespace or "/")
            self._commander, self._velocity = None, REST
        if self._commander is None:
            self._commands.choose()
        for sender, twist in self._commands.taken():
            if self._commander is None and sender in present:
                self._commander = sender
                log.info("%s: commander connected", self._namespace or "/")
            if sender == self._commander:
                self._take(twist)
            else:
                self.refused += 1
        waits = self._lock_step and self.connected and not self.answered
        if waits:
            self._repeat()
        return not waits

    def _repeat(self) -> None:
        """Repeat a report from time to time while its answer is missing.

        Readers are best-effort, so the report or the answer may be lost. A
        client that has the report already answers as before.
        """
        self._polls += 1
        if self._polls % REPEAT == 0 and self._state is not None:
            self._publish(self._state)

    def act(self) -> None:
        """Command the robot for one tick."""
        self._silent += 1
        if self._silent * self._tick > SILENCE and not self._lock_step:
            self._velocity = REST
        self._robot.command(self._velocity)

    def drop(self, why: str) -> None:
        """Disconnect the commander, and log why; another may connect."""
        log.warning("%s: commander dropped: %s", self._namespace or "/", why)
        self._commander, self._velocity = None, REST

    def close(self) -> None:
        """Remove the topics."""
        if self._closed:
            return
        self._closed = True
        del self._odometry, self._joints, self._sight
        del self._transforms, self._commands, self._cameras
        del self._description

    def _take(self, twist: Twist) -> None:
        forward, turn = twist.linear.x, twist.angular.z
        if not (isfinite(forward) and isfinite(turn)):
            self.refused += 1
            self._velocity = REST
            return
        if twist.linear.y and not self._ignores_lateral:
            self._ignores_lateral = True
            log.warning(
                "%s: the robot does not step sideways; linear.y is ignored",
                self._namespace or "/",
            )
        self.answered, self._silent = True, 0
        self._velocity = VelocityCommand(forward, turn)

    def _publish(self, state: WalkerState) -> None:
        """Publish the state; odometry last, as clients wait for it."""
        stamp = Time.of(state.time)
        self._clock.publish(state.time)
        self._cameras.publish(state.image)
        own = frame(self._namespace, "base_footprint")
        fixed = Header(stamp, frame(self._namespace, "odom"))
        sighting = state.sighting
        if sighting is not None and sighting is not self._published:
            self._published = sighting
            point = Point(
                sighting.distance * cos(sighting.bearing),
                sighting.distance * sin(sighting.bearing),
            )
            self._sight.write(
                PointStamped(Header(Time.of(sighting.time), own), point)
            )
        pose, velocity = state.pose, state.velocity
        self._joints.write(
            JointState(
                Header(stamp, ""), self._names, list(state.joints), [], []
            )
        )
        rotation = yaw_rotation(pose.theta)
        transform = Transform(vector(pose.x, pose.y), rotation)
        transforms = [TransformStamped(fixed, own, transform)]
        if state.torso is not None:
            position, angles = state.torso
            torso = Transform(vector(*position), rotation_message(*angles))
            base = frame(self._namespace, "base_link")
            transforms.append(
                TransformStamped(Header(stamp, own), base, torso)
            )
        self._transforms.write(TFMessage(transforms))
        twist = Twist(vector(velocity.forward), vector(z=velocity.turn))
        covariance: Any = self._covariance.note(pose)
        speeds: Any = OdometryCovariance.twist
        self._odometry.write(
            Odometry(
                fixed,
                own,
                PoseWithCovariance(pose_message(pose), covariance),
                TwistWithCovariance(twist, speeds),
            )
        )
