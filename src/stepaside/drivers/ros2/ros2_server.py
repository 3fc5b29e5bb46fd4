"""The robot's side of the topics, for a robot that is simulated."""

import logging
from collections.abc import Sequence
from math import cos, isfinite, sin
from typing import Any

from ...perception.measurement import Sighting
from ..velocity.velocity_body import REST, VelocityCommand
from ..velocity.walking_robot import WalkerState, WalkingRobot
from .camera_topics import CameraTopics
from .dds_domain import DdsParticipant
from .messages import (
    ClockMessage,
    Header,
    JointState,
    Odometry,
    Point,
    PointStamped,
    PoseWithCovariance,
    TFMessage,
    Time,
    Transform,
    TransformStamped,
    Twist,
    TwistWithCovariance,
)
from .topics import (
    IDEAL,
    JOINTS,
    ODOMETRY,
    about_the_vertical,
    dds_topic,
    frame,
    pose_message,
    vector,
)
from .velocity_commands import CommandReader

EVERY = 4  # ticks from one report to the next: 48 ms
SILENCE = 0.5  # of the commander before the robot rests, in [s]
LOOKS = 400  # for an answer in lock step before it is asked for again
UNKNOWN = (0.0,) * 36  # covariance of what nobody has estimated
log = logging.getLogger(__name__)


class WorldClock:
    """Tells simulated time to everybody on one domain."""

    def __init__(self, dds: DdsParticipant) -> None:
        """Write ``/clock``."""
        self._writer = dds.writer(dds_topic("", "clock"), ClockMessage)
        self._told = -1.0

    def tell(self, time: float) -> None:
        """Say what time it is, in [s], if that is new."""
        if time != self._told:
            self._told = time
            self._writer.write(ClockMessage(Time.of(time)))


class Ros2Server:
    """Speaks ROS 2 topics for one robot.

    The first who commands is the commander until it leaves; what others ask
    for is refused. Commands are ``Twist`` or ``TwistStamped``; a stamp is
    not looked at.

    Attributes:
        refused: Commands that were not followed.
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
    ) -> None:
        """Take part in the topics of a namespace.

        Args:
            dds: Where; it stays with the caller.
            namespace: With a slash before it, or empty.
            robot: Whom to speak for.
            joint_names: Its joints.
            clock: Tells the time of its world.
            tick: Time between two calls of :meth:`speak`, in [s].
            lock_step: Whether its world waits for answers.
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
        self._commands = CommandReader(dds, namespace)
        self._cameras = CameraTopics(dds, namespace)
        self._commander: int | None = None
        self._told: Sighting | None = None
        self._ticks = 0
        self._silent = 0
        self._velocity = REST
        self._closed = False
        self._state: WalkerState | None = None
        self._looks = 0
        self.refused = 0
        self.answered = True

    @property
    def connected(self) -> bool:
        """Whether somebody commands."""
        return self._commander is not None

    @property
    def ready(self) -> bool:
        """Whether somebody commands, so that the game may begin."""
        return self.connected

    def fileno(self) -> int:
        """No descriptor to wait on."""
        return -1

    def press(self, pressed: bool) -> None:
        """Report with the first tick, when the button is let go."""
        if not pressed:
            self._ticks = 0

    def speak(self) -> None:
        """Tell of the robot, when it is time to."""
        self.hear()
        if self._ticks % EVERY == 0:
            self._state = self._robot.state()
            self._tell(self._state)
            self.answered, self._looks = False, 0
        self._ticks += 1

    def hear(self) -> bool:
        """Take commands that have come; whether nobody is waited for."""
        present = self._commands.commanders()
        if self._commander is not None and self._commander not in present:
            log.warning("%s: commander left", self._namespace or "/")
            self._commander, self._velocity = None, REST
        if self._commander is None:
            self._commands.choose()
        for who, twist in self._commands.taken():
            if self._commander is None and who in present:
                self._commander = who
                log.info("%s: commander came", self._namespace or "/")
            if who == self._commander:
                self._take(twist)
            else:
                self.refused += 1
        waits = self._lock_step and self.connected and not self.answered
        if waits:
            self._ask_again()
        return not waits

    def _ask_again(self) -> None:
        """Repeat a report: it, or its answer, may have been lost on its way.

        Readers take what comes, and are sent nothing twice by DDS. Who has
        it already answers as before.
        """
        self._looks += 1
        if self._looks % LOOKS == 0 and self._state is not None:
            self._tell(self._state)

    def act(self) -> VelocityCommand:
        """What the robot is to do at this tick."""
        self._silent += 1
        if self._silent * self._tick > SILENCE and not self._lock_step:
            self._velocity = REST
        return self._velocity

    def drop(self, why: str) -> None:
        """Let go of the commander, and say why; another may come."""
        log.warning("%s: commander dropped: %s", self._namespace or "/", why)
        self._commander, self._velocity = None, REST

    def close(self) -> None:
        """Stop telling and listening."""
        if self._closed:
            return
        self._closed = True
        del self._odometry, self._joints, self._sight
        del self._transforms, self._commands, self._cameras

    def _take(self, twist: Twist) -> None:
        forward, turn = twist.linear.x, twist.angular.z
        if not (isfinite(forward) and isfinite(turn)):
            self.refused += 1
            self._velocity = REST
            return
        self.answered, self._silent = True, 0
        self._velocity = VelocityCommand(forward, turn)

    def _tell(self, state: WalkerState) -> None:
        """Write everything; odometry last, as it is what is waited for."""
        stamp = Time.of(state.time)
        self._clock.tell(state.time)
        self._cameras.tell(state.image)
        own = frame(self._namespace, "base_link")
        fixed = Header(stamp, frame(self._namespace, "odom"))
        seen = state.sighting
        if seen is not None and seen is not self._told:
            self._told = seen
            place = Point(
                seen.distance * cos(seen.bearing),
                seen.distance * sin(seen.bearing),
            )
            self._sight.write(
                PointStamped(Header(Time.of(seen.time), own), place)
            )
        pose, velocity = state.pose, state.velocity
        self._joints.write(
            JointState(
                Header(stamp, ""), self._names, list(state.joints), [], []
            )
        )
        turned = about_the_vertical(pose.theta)
        moved = Transform(vector(pose.x, pose.y), turned)
        self._transforms.write(
            TFMessage([TransformStamped(fixed, own, moved)])
        )
        twist = Twist(vector(velocity.forward), vector(z=velocity.turn))
        self._odometry.write(
            Odometry(
                fixed,
                own,
                PoseWithCovariance(pose_message(pose), UNKNOWN),
                TwistWithCovariance(twist, UNKNOWN),
            )
        )
