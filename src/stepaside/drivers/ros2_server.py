"""Server of ROS 2 topics for a simulated robot.

Frames are those of REP 103, 105 and 120: ``odom``, ``base_footprint``,
``base_link`` (the torso) and ``camera_optical_frame``, with the namespace as
prefix.
"""

import logging
from collections.abc import Sequence
from math import cos, isfinite, sin
from typing import Any, Protocol

import numpy as np

from ..core.rotations import quaternion_of
from ..perception.camera_model import CameraModel
from ..perception.images import ColourImage
from ..perception.measurement import RobotState, Sighting
from ..strategies.velocity_set import BodyVelocity
from .robot import REST
from .ros2 import COMMAND, IDEAL, KINDS, ODOMETRY
from .ros2_dds import (
    DdsParticipant,
    Endpoints,
    header,
    make,
    stamp_of,
    take_messages,
    vector,
)

REPORTS = 0.048  # from one report to the next, in [s]
COMMAND_SILENCE = 0.5  # without a command before the robot stops, in [s]
REPEAT = 400  # polls for an answer in lock step before a report is repeated
HANDLES = 1 << 64  # CycloneDDS has handles as signed and unsigned numbers
# Errors of the odometry after a minute of walking, as standard deviations:
# along both axes [m], about the vertical [rad], and of the velocities [m/s],
# [rad/s]. Height, roll and pitch of the footprint are zero by definition
# (REP 120); a variance of zero would mean an unknown one to some programs.
PLACES, SPEEDS, EXACT = (0.4, 0.4, 0.15), (0.03, 0.13, 0.09), 1e-9
# Position, in [m]; roll, pitch and yaw, in [rad].
BodyPlace = tuple[tuple[float, float, float], tuple[float, float, float]]
log = logging.getLogger(__name__)


class WalkingRobot(Protocol):
    """Simulated robot that follows velocity commands."""

    @property
    def velocity(self) -> BodyVelocity:
        """Velocity that it follows."""

    @property
    def ready(self) -> bool:
        """Whether it can walk."""

    def state(self) -> RobotState:
        """Return pose in odometry, joints, sighting and newest image."""

    def torso(self) -> BodyPlace | None:
        """Return the pose of the torso from the robot's pose on the floor."""

    def command(self, velocity: BodyVelocity) -> None:
        """Walk at a velocity from now on."""


class WorldClock:
    """Publisher of simulated time on one domain."""

    def __init__(self, dds: DdsParticipant) -> None:
        """Create the publisher of ``/clock``."""
        self._writer = dds.writer("/clock", "rosgraph_msgs/msg/Clock")
        self._published = -1.0

    def publish(self, time: float) -> None:
        """Publish the time, in [s], if it has changed."""
        if time != self._published:
            self._published = time
            self._writer.write(make("rosgraph_msgs/Clock", stamp_of(time)))


class CommandReader:
    """Subscriber of the commands to a served robot, one type at a time.

    So a commander that writes each subscribed type sends each command once.
    """

    def __init__(self, dds: DdsParticipant, topic: str) -> None:
        """Subscribe to ``Twist`` on a topic."""
        self._dds, self._topic = dds, topic
        self._publishers = Endpoints(dds, topic, writers=True)
        self._subscribe(KINDS[0])

    def commanders(self) -> set[int]:
        """Return the handles of all publishers of commands."""
        found = self._reader.get_matched_publications()
        return {handle % HANDLES for handle in found}

    def taken(self) -> list[tuple[int, Any]]:
        """Return each command that has arrived, after its sender's handle."""
        return [
            (
                sample.sample_info.publication_handle % HANDLES,
                sample if self._kind == KINDS[0] else sample.twist,
            )
            for sample in take_messages(self._reader)
        ]

    def choose(self) -> None:
        """Subscribe to a type that is published, if the present one is not.

        Call this only while there is no commander.
        """
        written = self._publishers.types
        if self._kind not in written:
            for kind in written.intersection(KINDS):
                self._subscribe(kind)

    def _subscribe(self, kind: str) -> None:
        self._kind = kind
        name = kind.replace("/", "/msg/")
        self._reader = self._dds.reader(self._topic, name)


def diagonal(x: float, y: float, turn: float) -> list[float]:
    """Return a covariance of planar motion by standard deviations."""
    values = (x * x, y * y, EXACT, EXACT, EXACT, turn * turn)
    return [float(value) for value in np.diag(values).ravel()]


def rotation_message(roll: float, pitch: float, yaw: float) -> Any:
    """Return the rotation Rz(yaw) Ry(pitch) Rx(roll), angles in [rad]."""
    w, x, y, z = quaternion_of(roll, pitch, yaw)
    return make("geometry_msgs/Quaternion", x, y, z, w)


def camera_info_message(head: Any, camera: CameraModel) -> Any:
    """Return the calibration of a camera without distortion."""
    matrix = camera.calibration_matrix
    projection = np.column_stack([matrix, np.zeros(3)])
    arrays = [m.ravel().tolist() for m in (matrix, np.eye(3), projection)]
    whole = make("sensor_msgs/RegionOfInterest", 0, 0, 0, 0, False)
    return make(
        "sensor_msgs/CameraInfo",
        *(head, camera.height, camera.width, "plumb_bob", [0.0] * 5),
        *(*arrays, 0, 0, whole),
    )


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
        """Create the topics."""
        self._robot, self._namespace, self._clock = robot, namespace, clock
        self._names, self._tick = list(joint_names), tick
        self._every = max(1, round(REPORTS / tick))
        self._lock_step = lock_step

        def writer(name: str, kind: str) -> Any:
            return dds.writer(f"{namespace}/{name}", kind)

        self._odometry = writer(ODOMETRY, "nav_msgs/msg/Odometry")
        self._joints = writer("joint_states", "sensor_msgs/msg/JointState")
        self._sight = writer(IDEAL, "geometry_msgs/msg/PointStamped")
        self._transforms = dds.writer("/tf", "tf2_msgs/msg/TFMessage", 100)
        self._raw = writer("camera/image_raw", "sensor_msgs/msg/Image")
        self._squeezed = writer(
            "camera/image_raw/compressed", "sensor_msgs/msg/CompressedImage"
        )
        self._optics = writer(
            "camera/camera_info", "sensor_msgs/msg/CameraInfo"
        )
        self._description: Any = None
        if urdf:
            self._description = dds.writer(
                f"{namespace}/robot_description",
                "std_msgs/msg/String",
                latched=True,
            )
            self._description.write(make("std_msgs/String", urdf))
        self._commands = CommandReader(dds, f"{namespace}/{COMMAND}")
        self._commander: int | None = None
        self._seen: Sighting | None = None  # that was published
        self._image: ColourImage | None = None  # likewise
        self._ticks = self._silent = self._polls = 0
        self._velocity = REST
        self._state: RobotState | None = None
        self.refused, self.answered = 0, True

    @property
    def connected(self) -> bool:
        """Whether there is a commander."""
        return self._commander is not None

    def begin(self) -> None:
        """Align the reports with the next tick."""
        self._ticks = 0

    def speak(self) -> None:
        """Publish a report, if one is due at this tick.

        A client that commands a robot waits until the robot can walk: it would
        take odometry that does not change for frozen.
        """
        self.hear()
        waits = self.connected and not self._robot.ready
        if self._ticks % self._every == 0 and not waits:
            self._state = self._robot.state()
            self._publish(self._state)
            self.answered, self._polls = False, 0
        self._ticks += 1

    def hear(self) -> bool:
        """Take commands that have arrived; return whether time may go on."""
        present = self._commands.commanders()
        if self._commander is not None and self._commander not in present:
            self.drop("it left")
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
        if waits and self._state is not None:
            # The report or its answer may be lost, as readers are best-effort;
            # a client that has the report already answers as before.
            self._polls += 1
            if self._polls % REPEAT == 0:
                self._publish(self._state)
        return not waits

    def act(self) -> None:
        """Command the robot for one tick."""
        self._silent += 1
        if self._silent * self._tick > COMMAND_SILENCE and not self._lock_step:
            self._velocity = REST
        self._robot.command(self._velocity)

    def drop(self, why: str) -> None:
        """Disconnect the commander, and log why; another may connect."""
        log.warning("%s: commander dropped: %s", self._namespace or "/", why)
        self._commander, self._velocity = None, REST

    def close(self) -> None:
        """Remove the topics."""
        del self._odometry, self._joints, self._sight, self._transforms
        del (
            self._raw,
            self._squeezed,
            self._optics,
            self._commands,
            self._description,
        )

    def _take(self, twist: Any) -> None:
        velocity = BodyVelocity(
            twist.linear.x, twist.linear.y, twist.angular.z
        )
        if not all(map(isfinite, velocity)):
            self.refused += 1
            self._velocity = REST
            return
        self.answered, self._silent = True, 0
        self._velocity = velocity

    def _frame(self, name: str) -> str:
        return f"{self._namespace}/{name}".lstrip("/")

    def _publish(self, state: RobotState) -> None:
        """Publish the state; odometry last, as clients wait for it."""
        time, pose, velocity = state.time, state.pose, self._robot.velocity
        self._clock.publish(time)
        for image in state.percepts:
            if isinstance(image, ColourImage):
                self._publish_image(image)
        own = self._frame("base_footprint")
        fixed = header(time, self._frame(ODOMETRY))
        self._publish_sight(state.sighting, own)
        angles = state.joint_positions.tolist()
        self._joints.write(
            make("sensor_msgs/JointState", header(time, ""), self._names,
                 angles, [], [])
        )  # fmt: skip
        turn = rotation_message(0.0, 0.0, pose.theta)
        links = [(fixed, own, vector(pose.x, pose.y), turn)]
        if (torso := self._robot.torso()) is not None:
            position, tilt = torso
            base = self._frame("base_link")
            links.append(
                (header(time, own), base, vector(*position),
                 rotation_message(*tilt))
            )  # fmt: skip
        transforms = [
            make(
                "geometry_msgs/TransformStamped",
                *(head, child),
                make("geometry_msgs/Transform", move, rotation),
            )
            for head, child, move, rotation in links
        ]
        self._transforms.write(make("tf2_msgs/TFMessage", transforms))
        place = make("geometry_msgs/Point", pose.x, pose.y, 0.0)
        twist = make(
            "geometry_msgs/Twist",
            vector(velocity.forward, velocity.lateral),
            vector(z=velocity.turn),
        )
        self._odometry.write(
            make(
                "nav_msgs/Odometry",
                *(fixed, own),
                make(
                    "geometry_msgs/PoseWithCovariance",
                    make("geometry_msgs/Pose", place, turn),
                    diagonal(*PLACES),
                ),
                make(
                    "geometry_msgs/TwistWithCovariance",
                    *(twist, diagonal(*SPEEDS)),
                ),
            )
        )

    def _publish_sight(self, sighting: Sighting | None, own: str) -> None:
        """Publish a sighting that is new, in the robot's frame."""
        if sighting is None or sighting is self._seen:
            return
        self._seen = sighting
        point = make(
            "geometry_msgs/Point",
            sighting.distance * cos(sighting.bearing),
            sighting.distance * sin(sighting.bearing),
            0.0,
        )
        head = header(sighting.time, own)
        self._sight.write(make("geometry_msgs/PointStamped", head, point))

    def _publish_image(self, image: ColourImage) -> None:
        """Publish an image that is new; x is to the right, y down, z ahead."""
        if image is self._image:
            return
        self._image = image
        head = header(image.time, self._frame("camera_optical_frame"))
        self._optics.write(camera_info_message(head, image.camera))
        if self._raw.get_matched_subscriptions():
            height, width = image.pixels.shape[:2]
            data = "rgb8", 0, 3 * width, image.pixels.tobytes()
            self._raw.write(
                make("sensor_msgs/Image", head, height, width, *data)
            )
        if self._squeezed.get_matched_subscriptions():
            import cv2

            bgr = cv2.cvtColor(image.pixels, cv2.COLOR_RGB2BGR)
            jpeg = cv2.imencode(".jpg", bgr)[1].tobytes()
            self._squeezed.write(
                make("sensor_msgs/CompressedImage", head, "jpeg", jpeg)
            )
