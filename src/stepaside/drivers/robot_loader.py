"""Loader of robots that users connect in Python, as FILE.py:CLASS."""

from collections.abc import Callable, Sequence
from typing import Any, NamedTuple

from ..core.errors import ConfigurationError
from ..core.user_file import FAILURES, FILE_AND_NAME, load_user_file
from . import joint_robot, velocity_robot
from .joint_robot import JointRobot, check_joint_robot
from .velocity_robot import VelocityRobot, check_velocity_robot

RobotClass = type[VelocityRobot] | type[JointRobot]


class _Base(NamedTuple):
    """Base class with its methods and its check."""

    kind: Any
    methods: Sequence[str]
    required: Sequence[str]
    check: Callable[[Any, str], None]


BASES = (
    _Base(
        VelocityRobot,
        velocity_robot.METHODS,
        velocity_robot.REQUIRED,
        check_velocity_robot,
    ),
    _Base(
        JointRobot,
        joint_robot.METHODS,
        joint_robot.REQUIRED,
        check_joint_robot,
    ),
)


def load_robot_class(name: str) -> RobotClass:
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
    kind: Any = getattr(loaded, found["name"], None)
    base = _base_of(kind)
    if base is None:
        offered = ", ".join(_robots_in(loaded)) or "no robot"
        raise ConfigurationError(
            f"{where}: must be a subclass of stepaside.VelocityRobot or "
            f"stepaside.JointRobot; the file has {offered}"
        )
    _check_methods(kind, base, where)
    base.check(kind, where)
    try:
        kind()
    except FAILURES as error:
        raise ConfigurationError(
            f"{where}: {kind.__name__}() must make a robot without "
            f"connecting, got {type(error).__name__}: {error}"
        ) from error
    made: RobotClass = kind
    return made


def _base_of(kind: Any) -> _Base | None:
    """Return the base of a class; None if it is no robot."""
    if not isinstance(kind, type):
        return None
    return next((base for base in BASES if issubclass(kind, base.kind)), None)


def _check_methods(kind: Any, base: _Base, where: str) -> None:
    """Check that all methods are methods, and the required ones written."""
    for name in base.methods:
        if not callable(getattr(kind, name)):
            raise ConfigurationError(f"{where}: {name} must be a method")
    for name in base.required:
        if getattr(kind, name) is getattr(base.kind, name):
            raise ConfigurationError(f"{where}: lacks the method {name}()")


def _robots_in(loaded: Any) -> list[str]:
    kinds = [base.kind for base in BASES]
    return sorted(
        name
        for name, thing in vars(loaded).items()
        if _base_of(thing) is not None and thing not in kinds
    )
