"""Base class of joint-driven robots that users connect in Python."""

from collections.abc import Mapping, Sequence
from math import isfinite
from typing import ClassVar, NamedTuple

from ...core.errors import ConfigurationError
from ...core.user_file import shown_briefly
from ...perception.measurement import Sighting
from ..cameras.robot_camera import CameraImage


class JointReport(NamedTuple):
    """Measured state of a robot at one instant.

    Attributes:
        time: Time of the measurement on the robot's clock, in [s].
        positions: Joint angles, in [rad], by joint; further joints are
            ignored.
        velocities: Joint velocities, in [rad/s], by joint.
        gyro: Angular velocity of the torso in its frame (x forward, y left,
            z up), in [rad/s].
        accelerometer: Specific force in the same frame, in [m/s^2]: about
            (0, 0, 9.8) when standing.
        tilt: Roll and pitch of the torso, in [rad].
        foot_forces: Normal force at the corners of the soles, in [N]: left
            front-left, front-right, rear-left, rear-right, then right; None
            for a robot that does not measure them.
        sighting: Newest sighting of the opponent, timed by the same clock,
            its bearing from the heading of the torso; None without one.
        hindrance: Reason why the robot must not walk now; empty if it may.
    """

    time: float
    positions: Mapping[str, float]
    velocities: Mapping[str, float]
    gyro: Sequence[float]
    accelerometer: Sequence[float]
    tilt: tuple[float, float]
    foot_forces: Sequence[float] | None = None
    sighting: Sighting | None = None
    hindrance: str = ""


class JointTarget(NamedTuple):
    """Command of one joint: torque by target and gains.

    Attributes:
        angle: Target, in [rad].
        stiffness: Gain from angle to torque, in [N m/rad].
        damping: Gain from velocity to torque, in [N m s/rad].
    """

    angle: float
    stiffness: float
    damping: float


class JointRobot:
    """Robot whose joints take targets and gains, behind a vendor's interface.

    ``stepaside play --robot FILE.py:CLASS --description FOLDER`` drives it.
    The description gives joints, ranges, speeds, soles and masses;
    states, limits, safety conditions, guardian, record and status line are
    those of every robot that is driven by its joints. The robot begins
    standing by its own controller, and is given back to it by
    :meth:`release`.

    All methods are called from one thread, one after the other; only
    :meth:`release` is also called while another method does not return, and
    :meth:`image` from a thread of its own. The
    guardian process makes its own object of the class and calls
    :meth:`open` and, if control has died, :meth:`release`.

    Attributes:
        tick: Time from one command to the next, in [s]. Learned legs need
            one that divides the period of their network.
        gains: Stiffness [N m/rad] and damping [N m s/rad] by joint, which
            hold a posture; those of the description by default. Learned
            legs bring gains for their own joints.
        keeps_targets: Whether the robot holds the last targets for ever. A
            robot that releases itself soon after its last command needs no
            second connection for the guardian.
        paced: Whether the robot's clock runs in real time; that of a
            simulator may pause or run faster.
    """

    tick: ClassVar[float]
    gains: Mapping[str, tuple[float, float]] | None = None
    keeps_targets: ClassVar[bool] = True
    paced: ClassVar[bool] = True

    def open(self) -> None:
        """Connect to the robot, without moving it.

        Raises:
            OSError: If the robot does not answer; connecting is retried.
        """

    def listen(self) -> JointReport | None:
        """Return the newest measured state, or None if there is no newer one.

        Return within about one tick. The time is that of the measurement,
        not that of the call: a repeated report means that the robot is
        silent.
        """
        raise NotImplementedError

    def command(self, targets: Mapping[str, JointTarget]) -> None:
        """Command the joints until the next call.

        Args:
            targets: Target of each joint of the description.
        """
        raise NotImplementedError

    def release(self) -> None:
        """Give the joints back to the robot's own controller, or damp them.

        Called at the end, after a fall, and when control fails.
        """
        raise NotImplementedError

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


METHODS = ("open", "listen", "command", "release", "image", "close")
REQUIRED = ("listen", "command", "release")


def check_joint_robot(kind: type[JointRobot], where: str) -> None:
    """Check tick, gains and flags of a class.

    Args:
        kind: The class; its methods have been checked.
        where: Its name, for messages.

    Raises:
        ConfigurationError: If one is invalid.
    """
    tick = getattr(kind, "tick", None)
    if not (isinstance(tick, int | float) and 0.001 <= tick <= 0.1):
        raise ConfigurationError(
            f"{where}: tick must be in [0.001, 0.1] s, got "
            f"{shown_briefly(tick)}"
        )
    for name in ("keeps_targets", "paced"):
        if not isinstance(getattr(kind, name), bool):
            raise ConfigurationError(
                f"{where}: {name} must be True or False, got "
                f"{shown_briefly(getattr(kind, name))}"
            )
    for joint, pair in (kind.gains or {}).items():
        try:
            good = all(isfinite(v) and v >= 0.0 for v in pair)
        except TypeError:
            good = False
        if not good or len(pair) != 2:
            raise ConfigurationError(
                f"{where}: gains of {joint} must be a stiffness [N m/rad] "
                f"and a damping [N m s/rad], got {shown_briefly(pair)}"
            )
