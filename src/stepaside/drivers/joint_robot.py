"""Base class of robots whose joints take targets and gains."""

from collections.abc import Mapping, Sequence
from math import isfinite
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..core.errors import ConfigurationError, shown
from ..core.poses import Array
from ..perception.measurement import RobotState
from ..robots.description import RobotDescription
from ..robots.tree_cache import load_tree
from .robot_camera import CameraImage
from .safety_states import SafetyState


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


class JointRobot:
    """Robot whose joints take targets and gains, behind a vendor's interface.

    ``stepaside play --robot FILE.py:CLASS --description FOLDER`` drives it.
    The description gives ranges, speeds, soles and masses of the joints;
    states, limits, safety conditions, guardian, record and status line are
    those of every robot that is driven by its joints.

    All methods are called from one thread, one after the other; only
    :meth:`release` is also called while another method does not return, and
    :meth:`image` from a thread of its own. The
    guardian process makes its own object of the class and calls
    :meth:`open` and, if control has died, :meth:`release`.

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
        paced: Whether the robot's clock runs in real time; that of a
            simulator may pause or run faster. Read after :meth:`open`.
        stands: Whether the robot begins standing by its own controller, and
            is given back to it by :meth:`release`; else it begins limp, and
            stiffness rises and falls slowly.
        shares_connection: Whether the robot has one client only: the
            guardian then uses the connection of control.
        takes_gains: Whether the robot takes gains; else stiffness is a share
            from 0 to 1, and learned legs cannot walk it.
        crouch: Angles from which the robot can go limp, in [rad], by joint;
            other joints keep their targets.
    """

    tick: float
    joints: Sequence[str]
    gains: Mapping[str, tuple[float, float]] | None = None
    keeps_targets: bool = True
    paced: bool = True
    stands: bool = True
    shares_connection: bool = False
    takes_gains: bool = True
    crouch: Mapping[str, float] = {}

    def open(self) -> None:
        """Connect to the robot, without moving it.

        Raises:
            OSError: If the robot does not answer; connecting is retried.
        """

    def listen(self) -> RobotState | None:
        """Return the newest measured state, or None if there is no newer one.

        It has joint angles and velocities, gyro, accelerometer and tilt.
        Return within about one tick. The time is that of the measurement,
        not that of the call: a repeated report means that the robot is
        silent.
        """
        raise NotImplementedError

    def command(self, targets: JointTargets) -> None:
        """Command the joints until the next call."""
        raise NotImplementedError

    def release(self) -> None:
        """Give the joints back to the robot's own controller, or damp them.

        Called at the end, after a fall, and when control fails.
        """
        raise NotImplementedError

    def show(self, state: SafetyState, *, sees: bool) -> None:
        """Show the state on a display of the robot, if it has one.

        Args:
            state: State of the robot, whenever it or ``sees`` changes.
            sees: Whether there is a sighting of the opponent.
        """

    def image(self) -> CameraImage | None:
        """Return the newest image of the camera in the head, or None.

        Called with ``--sensing cameras``, from a thread of its own; it may
        wait for an image for about 0.1 s. The time is that of the exposure,
        by the clock of :meth:`listen`. The head of the description says
        where the camera is.
        """
        return None

    def close(self) -> None:
        """Disconnect; :meth:`release` has been called before."""


METHODS = ("open", "listen", "command", "release", "show", "image", "close")
REQUIRED = ("listen", "command", "release")
FLAGS = (
    *("keeps_targets", "paced", "stands", "shares_connection"),
    "takes_gains",
)


def check_joint_robot(kind: type[JointRobot], where: str) -> None:
    """Check tick, joints, gains and flags of a class.

    Args:
        kind: The class; its methods have been checked.
        where: Its name, for messages.

    Raises:
        ConfigurationError: If one is invalid.
    """
    tick = getattr(kind, "tick", None)
    if not (isinstance(tick, int | float) and 0.001 <= tick <= 0.1):
        raise ConfigurationError(
            f"{where}: tick must be in [0.001, 0.1] s, got {shown(tick)}"
        )
    joints = getattr(kind, "joints", None)
    named = isinstance(joints, Sequence) and not isinstance(joints, str)
    if not named or not all(isinstance(name, str) for name in joints or ()):
        raise ConfigurationError(
            f"{where}: joints must be the names of the joints, in the order "
            f"of all arrays, got {shown(joints)}"
        )
    for name in FLAGS:
        if not isinstance(getattr(kind, name), bool):
            raise ConfigurationError(
                f"{where}: {name} must be True or False, got "
                f"{shown(getattr(kind, name))}"
            )
    for joint, pair in (kind.gains or {}).items():
        try:
            good = all(isfinite(v) and v >= 0.0 for v in pair)
        except TypeError:
            good = False
        if not good or len(pair) != 2:
            raise ConfigurationError(
                f"{where}: gains of {joint} must be a stiffness [N m/rad] "
                f"and a damping [N m s/rad], got {shown(pair)}"
            )


class Motors(NamedTuple):
    """Motors of a described robot, in the order of the joint targets.

    Attributes:
        names: Names of their joints.
        low: Minimum angles, in [rad]. Shape (motors,).
        high: Maximum angles, in [rad]. Shape (motors,).
        speed: Maximum speeds, in [rad/s]. Shape (motors,).
        legs: Indices of the motors that carry the robot. Shape (legs,).
        order: Index of each motor among the joints of the robot's class.
            Shape (motors,).
        stiffness: Gains that hold a posture, in [N m/rad]. Shape (motors,).
        damping: Likewise, in [N m s/rad]. Shape (motors,).
    """

    names: tuple[str, ...]
    low: Array
    high: Array
    speed: Array
    legs: NDArray[np.intp]
    order: NDArray[np.intp]
    stiffness: Array
    damping: Array


def motors_of(robot: JointRobot, description: RobotDescription) -> Motors:
    """Return the motors of a robot with ranges, speeds and gains.

    Args:
        robot: The robot.
        description: Its description.

    Raises:
        ConfigurationError: If the robot lacks a joint, or gains of one.
    """
    tree, kind = load_tree(description), type(robot).__name__
    names, joints = tree.motors, list(robot.joints)
    missing = [name for name in names if name not in joints]
    if missing:
        raise ConfigurationError(
            f"{kind}: joints lack {', '.join(missing)} of the description; "
            f"they are {', '.join(joints)}"
        )
    servos = description.overlay.servos.items()
    gains = {name: (own.stiffness, own.damping) for name, own in servos}
    gains |= dict(robot.gains or {})
    missing = [name for name in names if name not in gains]
    if missing:
        raise ConfigurationError(f"{kind}: gains lack {', '.join(missing)}")
    links = [tree.links[tree.link_of(name)] for name in names]
    pairs = np.array([gains[name] for name in names], dtype=np.float64)
    speeds = [description.speed_limits.get(name, np.inf) for name in names]
    return Motors(
        names,
        low=np.array([link.low for link in links]),
        high=np.array([link.high for link in links]),
        speed=np.array(speeds),
        # Legs may share a motor.
        legs=np.array(
            [names.index(leg) for leg in description.legs if leg in names]
        ),
        order=np.array([joints.index(name) for name in names]),
        stiffness=pairs[:, 0],
        damping=pairs[:, 1],
    )
