"""Base class of robots that users connect with a few lines of Python."""

from math import isfinite
from typing import Any, ClassVar

from ...core.errors import ConfigurationError
from ...core.user_file import (
    FAILURES,
    FILE_AND_NAME,
    load_user_file,
    shown_briefly,
)
from .velocity_body import VelocityReport
from .velocity_limits import VelocityLimits

METHODS = ("open", "prepare", "listen", "command", "stop", "close")


class VelocityRobot:
    """Robot with its own walking controller, behind a vendor's interface.

    A subclass calls the robot's SDK in :meth:`open`, :meth:`listen` and
    :meth:`command`, and sets :attr:`limits`. ``stepaside play --robot
    FILE.py:CLASS`` drives it: ramps and limits, watchdog, guardian, record
    and status line are those of every robot with velocity commands.

    All methods are called from one thread, one after the other; only
    :meth:`stop` is also called while another method does not return. The
    guardian process makes its own object of the class and calls
    :meth:`open` and, if control has died, :meth:`stop`.

    Attributes:
        limits: Largest commands, all finite; they are never exceeded.
        keeps_walking: Whether the robot keeps its last command for ever. A
            robot that stops by itself soon after its last command needs no
            second connection for the guardian.
    """

    limits: ClassVar[VelocityLimits]
    keeps_walking: ClassVar[bool] = True

    def open(self) -> None:
        """Connect to the robot, without moving it.

        Raises:
            OSError: If the robot does not answer; connecting is retried.
        """

    def prepare(self) -> None:
        """Make the robot ready to walk; it may stand up. Not in a dry run."""

    def listen(self) -> VelocityReport | None:
        """Return the newest measured state, or None if there is no newer one.

        Return within about 0.1 s. The time is that of the measurement, on
        the robot's clock or this computer's, not that of the call: a repeated
        report means that the robot is silent.
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

    def close(self) -> None:
        """Disconnect; :meth:`stop` has been called before."""


def load_velocity_robot(name: str) -> type[VelocityRobot]:
    """Load a robot of a user's file.

    Args:
        name: FILE.py:CLASS. The file is executed.

    Returns:
        The class, which makes a robot without connecting to it.

    Raises:
        ConfigurationError: If there is no such class, or it is invalid.
    """
    found = FILE_AND_NAME.fullmatch(name)
    if not (found and found["name"].isidentifier()):
        raise ConfigurationError(f"robot must be FILE.py:CLASS, got {name!r}")
    where = f"robot {name}"
    loaded = load_user_file(found["file"], where)
    kind = getattr(loaded, found["name"], None)
    if not (isinstance(kind, type) and issubclass(kind, VelocityRobot)):
        offered = ", ".join(_robots_in(loaded)) or "no VelocityRobot"
        raise ConfigurationError(
            f"{where}: must be a subclass of stepaside.VelocityRobot; the "
            f"file has {offered}"
        )
    _check_class(kind, where)
    try:
        kind()
    except FAILURES as error:
        raise ConfigurationError(
            f"{where}: {kind.__name__}() must make a robot without "
            f"connecting, got {type(error).__name__}: {error}"
        ) from error
    return kind


def _check_class(kind: type[VelocityRobot], where: str) -> None:
    """Check methods, limits and flags of a class."""
    for name in METHODS:
        if not callable(getattr(kind, name)):
            raise ConfigurationError(f"{where}: {name} must be a method")
    for name in ("listen", "command"):
        if getattr(kind, name) is getattr(VelocityRobot, name):
            raise ConfigurationError(f"{where}: lacks the method {name}()")
    limits = getattr(kind, "limits", None)
    if not isinstance(limits, VelocityLimits):
        raise ConfigurationError(
            f"{where}: limits must be VelocityLimits(forward=..., "
            f"backward=..., turn=...), got {shown_briefly(limits)}"
        )
    for name, unit in (("forward", "m/s"), ("backward", "m/s"),
                       ("turn", "rad/s")):  # fmt: skip
        if not isfinite(getattr(limits, name)):
            raise ConfigurationError(
                f"{where}: limits must give a finite {name} [{unit}], got "
                f"{getattr(limits, name)}"
            )
    if not isinstance(kind.keeps_walking, bool):
        raise ConfigurationError(
            f"{where}: keeps_walking must be True or False, got "
            f"{shown_briefly(kind.keeps_walking)}"
        )


def _robots_in(loaded: Any) -> list[str]:
    return sorted(
        name
        for name, thing in vars(loaded).items()
        if isinstance(thing, type)
        and issubclass(thing, VelocityRobot)
        and thing is not VelocityRobot
    )
