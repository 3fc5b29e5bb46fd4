"""Base classes of robots: users and the files of vendors subclass them."""

from abc import ABC, abstractmethod
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from math import inf
from typing import NamedTuple

from ..core.errors import ConfigurationError, check_positive, check_within
from ..core.poses import Array
from ..perception.images import Pixels
from ..perception.measurement import RobotState
from ..strategies.velocity_set import BodyVelocity, VelocitySet
from .safety import SafetyState

REST = BodyVelocity(0.0, 0.0, 0.0)


@dataclass(frozen=True, slots=True)
class VelocityLimits:
    """Limits of a robot's velocity commands.

    Attributes:
        forward: Maximum forward speed, in [m/s].
        backward: Maximum backward speed, in [m/s].
        turn: Maximum turning rate, in [rad/s].
        acceleration: Maximum linear acceleration, in [m/s^2].
        turn_acceleration: Maximum angular acceleration, in [rad/s^2].
        lateral: Maximum lateral speed, in [m/s]; 0 for a robot that does not
            walk sideways.
    """

    forward: float = inf
    backward: float = inf
    turn: float = inf
    acceleration: float = 0.5
    turn_acceleration: float = 2.0
    lateral: float = 0.0

    def __post_init__(self) -> None:
        """Validate the limits."""
        error = ConfigurationError
        for name, unit in (("forward", "m/s"), ("backward", "m/s"),
                           ("turn", "rad/s"), ("acceleration", "m/s^2"),
                           ("turn_acceleration", "rad/s^2")):  # fmt: skip
            if getattr(self, name) != inf or "acceleration" in name:
                check_positive(getattr(self, name), name, unit, error)
        check_within(self.lateral, 0.0, 100.0, "lateral", "m/s", error)

    def within(self, speed: float, turn: float) -> "VelocityLimits":
        """Return the limits, at most a speed [m/s] and a rate [rad/s]."""
        return replace(
            self,
            forward=min(self.forward, speed),
            backward=min(self.backward, speed),
            turn=min(self.turn, turn),
            lateral=min(self.lateral, speed),
        )

    @property
    def velocities(self) -> VelocitySet | None:
        """Velocities of a robot that walks sideways; None for a unicycle."""
        if self.lateral == 0.0:
            return None
        return VelocitySet(
            (-self.backward, self.forward),
            (-self.lateral, self.lateral),
            (-self.turn, self.turn),
        )

    def scale(self, wanted: BodyVelocity) -> BodyVelocity:
        """Scale a velocity into the limits.

        All components are scaled by the same factor, so that the path keeps
        its curvature, and with it the circle its radius. A robot that does
        not walk sideways is commanded no lateral velocity.
        """
        speed, rate = abs(wanted.forward), abs(wanted.turn)
        top = self.forward if wanted.forward > 0.0 else self.backward
        aside = abs(wanted.lateral) if self.lateral > 0.0 else 0.0
        factor = min(
            1.0,
            top / speed if speed > 0.0 else 1.0,
            self.lateral / aside if aside > 0.0 else 1.0,
            self.turn / rate if rate > 0.0 else 1.0,
        )
        return BodyVelocity(
            factor * wanted.forward,
            factor * wanted.lateral if aside > 0.0 else 0.0,
            factor * wanted.turn,
        )


class CameraMount(NamedTuple):
    """Pose of a camera from the robot's reference point on the floor.

    Attributes:
        forward: Position ahead, in [m].
        left: Position to the left, in [m].
        up: Height above the floor, in [m].
        yaw: Direction of view from the heading, in [rad], positive leftward.
        pitch: Direction of view below the horizontal, in [rad].
        roll: Turn about the direction of view, in [rad].
    """

    forward: float
    left: float
    up: float
    yaw: float = 0.0
    pitch: float = 0.0
    roll: float = 0.0


class CameraImage(NamedTuple):
    """Image of a robot's camera, without distortion.

    Attributes:
        time: Middle of the exposure, by the clock of the reports, in [s].
        pixels: Red, green and blue, 0 to 255. Shape (height, width, 3).
        focal_x: Horizontal focal length at this size, in [px].
        focal_y: Vertical focal length at this size, in [px].
        mount: Pose of the camera at the exposure. A robot that is driven by
            its joints needs none: its description says where the camera is.
    """

    time: float
    pixels: Pixels
    focal_x: float
    focal_y: float
    mount: CameraMount | None = None


class HeadLimits(NamedTuple):
    """Range of a head that turns toward the opponent.

    Attributes:
        yaw: To each side, in [rad].
        up: Upward, in [rad].
        down: Downward, in [rad].
    """

    yaw: float
    up: float
    down: float


class JointTargets(NamedTuple):
    """Command to all joints: torque by target and gains.

    Attributes:
        angles: Targets, in [rad]. Shape (joints,).
        stiffness: Gains from angle to torque, in [N m/rad]. Shape (joints,).
        damping: Gains from velocity to torque, in [N m s/rad].
            Shape (joints,).
    """

    angles: Array
    stiffness: Array
    damping: Array


class Robot(ABC):
    """Robot behind a vendor's interface.

    ``stepaside play FILE.py:CLASS`` drives it: limits, safety,
    guardian, record and status line are those of every robot.

    All methods are called from one thread, one after the other; only the
    method that halts the robot is also called while another method does not
    return, and :meth:`image` from a thread of its own. The guardian process
    makes its own object of the class, and calls :meth:`open` and, if control
    has died, the method that halts the robot.

    Attributes:
        paced: Whether the robot's clock runs in real time; that of a
            simulator may pause or run faster. Read after :meth:`open`.
        stamped: Whether the times of reports are stamps; counted times may
            fall behind the clock.
        shares_connection: Whether the robot has one client only: the
            guardian then uses the connection of control.
        closing: Longest time that :meth:`close` takes, in [s].
    """

    paced: bool = True
    stamped: bool = True
    shares_connection: bool = False
    closing: float = 2.0

    def open(self) -> None:  # noqa: B027 (optional)
        """Connect to the robot, without moving it.

        Raises:
            OSError: If the robot does not answer; connecting is retried.
        """

    @abstractmethod
    def listen(self) -> RobotState | None:
        """Return the newest measured state, or None if there is no newer one.

        The time is that of the measurement, on the robot's clock or this
        computer's, not that of the call: a repeated report means that the
        robot is silent.
        """

    def image(self) -> CameraImage | None:
        """Return the newest image of the camera, or None.

        Called with ``--sensing cameras``; it may wait for an image for about
        0.1 s. The time is that of the exposure, by the clock of
        :meth:`listen`: an old or repeated image is not used.
        """
        return None

    def close(self) -> None:  # noqa: B027 (optional)
        """Disconnect; the robot has been halted before."""


class VelocityRobot(Robot):
    """Robot with its own walking controller.

    Its reports have the pose in odometry, and the newest sighting of the
    opponent and a hindrance, if there are any. :meth:`listen` returns within
    about 0.1 s.

    Attributes:
        limits: Largest commands, all finite; they are never exceeded.
        keeps_walking: Whether the robot keeps its last command for ever. A
            robot that stops by itself soon after its last command needs no
            second connection for the guardian.
        head: Range of the head, with which :meth:`look` follows the
            opponent with ``--sensing cameras``; None for a fixed camera.
    """

    limits: VelocityLimits
    keeps_walking: bool = True
    head: HeadLimits | None = None

    def prepare(self) -> None:
        """Make the robot ready to walk; it may stand up. Not in a dry run."""

    @abstractmethod
    def command(self, forward: float, lateral: float, turn: float) -> None:
        """Walk at a velocity from now on.

        Args:
            forward: In [m/s], negative backward.
            lateral: In [m/s], positive leftward.
            turn: Turning rate, in [rad/s], positive leftward.
        """

    def stop(self) -> None:
        """Stop walking and stand; called in place of a zero command."""
        self.command(0.0, 0.0, 0.0)

    def look(self, yaw: float, pitch: float) -> None:
        """Turn the head, within :attr:`head`.

        Args:
            yaw: Direction from the heading, in [rad], positive leftward.
            pitch: Angle below the horizontal, in [rad].
        """


class JointRobot(Robot):
    """Robot whose joints take targets and gains.

    Its description (``--robot``) gives ranges, speeds, soles and masses of the
    joints. Its reports have joint angles and velocities, gyro, accelerometer
    and tilt. :meth:`listen` returns within about one tick.

    Attributes:
        tick: Time from one command to the next, in [s]. Learned legs need
            one that divides the period of their network.
        joints: Joints in the order of all arrays, by their names in the
            description. Joints that it lacks get no torque.
        gains: Stiffness [N m/rad] and damping [N m s/rad] by joint, which
            hold a posture; those of the description by default. Learned
            legs bring gains for their own joints.
        keeps_targets: Whether the robot holds the last targets for ever. A
            robot that releases itself soon after its last command needs no
            second connection for the guardian.
        stands: Whether the robot begins standing by its own controller, and
            is given back to it by :meth:`release`; else it begins limp, and
            stiffness rises and falls slowly.
        takes_gains: Whether the robot takes gains; else stiffness is a share
            from 0 to 1, and learned legs cannot walk it.
        crouch: Angles from which the robot can go limp, in [rad], by joint;
            other joints keep their targets.
    """

    tick: float
    joints: Sequence[str]
    gains: Mapping[str, tuple[float, float]] | None = None
    keeps_targets: bool = True
    stands: bool = True
    takes_gains: bool = True
    crouch: Mapping[str, float] = {}

    @abstractmethod
    def command(self, targets: JointTargets) -> None:
        """Command the joints until the next call."""

    @abstractmethod
    def release(self) -> None:
        """Give the joints back to the robot's own controller, or damp them.

        Called at the end, after a fall, and when control fails.
        """

    def show(self, state: SafetyState, *, sees: bool) -> None:
        """Show the state on a display of the robot, if it has one.

        Args:
            state: State of the robot, whenever it or ``sees`` changes.
            sees: Whether there is a sighting of the opponent.
        """
