"""Base class of robots that users connect with a few lines of Python."""

from math import isfinite

from ..core.errors import ConfigurationError, shown
from ..perception.measurement import RobotState
from .robot_camera import (
    CameraImage,
    CameraMount,
    HeadLimits,
    check_head_limits,
)
from .velocity_limits import VelocityLimits


class VelocityRobot:
    """Robot with its own walking controller, behind a vendor's interface.

    A subclass calls the robot's SDK in :meth:`open`, :meth:`listen` and
    :meth:`command`, and sets :attr:`limits`. ``stepaside play --robot
    FILE.py:CLASS`` drives it: ramps and limits, watchdog, guardian, record
    and status line are those of every robot with velocity commands.

    All methods are called from one thread, one after the other; only
    :meth:`stop` is also called while another method does not return, and
    :meth:`image` from a thread of its own. The
    guardian process makes its own object of the class and calls
    :meth:`open` and, if control has died, :meth:`stop`.

    Attributes:
        limits: Largest commands, all finite; they are never exceeded.
        keeps_walking: Whether the robot keeps its last command for ever. A
            robot that stops by itself soon after its last command needs no
            second connection for the guardian.
        head: Range of the head, with which :meth:`look` follows the
            opponent with ``--sensing cameras``; None for a fixed camera.
        paced: Whether the robot's clock runs in real time; that of a
            simulator may pause or run faster.
        closing: Longest time that :meth:`close` takes, in [s].
        camera: Pose of a fixed camera that ``--images`` reads; None if
            :meth:`image` returns the images.
    """

    limits: VelocityLimits
    keeps_walking: bool = True
    paced: bool = True
    closing: float = 2.0
    head: HeadLimits | None = None
    camera: CameraMount | None = None

    def open(self) -> None:
        """Connect to the robot, without moving it.

        Raises:
            OSError: If the robot does not answer; connecting is retried.
        """

    def prepare(self) -> None:
        """Make the robot ready to walk; it may stand up. Not in a dry run."""

    def listen(self) -> RobotState | None:
        """Return the newest measured state, or None if there is no newer one.

        It has the pose in odometry, the newest sighting of the opponent and
        a hindrance, if there are any. Return within about 0.1 s. The time is
        that of the measurement, on the robot's clock or this computer's, not
        that of the call: a repeated report means that the robot is silent.
        """
        raise NotImplementedError

    def command(self, forward: float, lateral: float, turn: float) -> None:
        """Walk at a velocity from now on.

        Args:
            forward: In [m/s], negative backward.
            lateral: In [m/s], positive leftward.
            turn: Turning rate, in [rad/s], positive leftward.
        """
        raise NotImplementedError

    def stop(self) -> None:
        """Stop walking and stand; called in place of a zero command."""
        self.command(0.0, 0.0, 0.0)

    def image(self) -> CameraImage | None:
        """Return the newest image of the camera, or None.

        Called with ``--sensing cameras``, from a thread of its own; it may
        wait for an image for about 0.1 s. The time is that of the exposure,
        by the clock of :meth:`listen`: an old or repeated image is not used.
        """
        return None

    def look(self, yaw: float, pitch: float) -> None:
        """Turn the head, within :attr:`head`.

        Args:
            yaw: Direction from the heading, in [rad], positive leftward.
            pitch: Angle below the horizontal, in [rad].
        """

    def close(self) -> None:
        """Disconnect; :meth:`stop` has been called before."""


METHODS = (
    *("open", "prepare", "listen", "command", "stop", "image", "look"),
    "close",
)
REQUIRED = ("listen", "command")


def check_velocity_robot(kind: type[VelocityRobot], where: str) -> None:
    """Check limits and flags of a class.

    Args:
        kind: The class; its methods have been checked.
        where: Its name, for messages.

    Raises:
        ConfigurationError: If one is invalid.
    """
    limits = getattr(kind, "limits", None)
    if not isinstance(limits, VelocityLimits):
        raise ConfigurationError(
            f"{where}: limits must be VelocityLimits(forward=..., "
            f"backward=..., turn=...), got {shown(limits)}"
        )
    for name, unit in (("forward", "m/s"), ("backward", "m/s"),
                       ("turn", "rad/s")):  # fmt: skip
        if not isfinite(getattr(limits, name)):
            raise ConfigurationError(
                f"{where}: limits must give a finite {name} [{unit}], got "
                f"{getattr(limits, name)}"
            )
    for name in ("keeps_walking", "paced"):
        if not isinstance(getattr(kind, name), bool):
            raise ConfigurationError(
                f"{where}: {name} must be True or False, got "
                f"{shown(getattr(kind, name))}"
            )
    if kind.head is not None:
        check_head_limits(kind.head, where)
        if kind.look is VelocityRobot.look:
            raise ConfigurationError(f"{where}: head needs the method look()")
    if kind.camera is not None and not isinstance(kind.camera, CameraMount):
        raise ConfigurationError(
            f"{where}: camera must be CameraMount(forward, left, up, ...), "
            f"got {shown(kind.camera)}"
        )
