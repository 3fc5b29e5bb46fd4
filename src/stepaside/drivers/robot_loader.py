"""Robots by address: NAME:ADDRESS of a protocol, or a user's FILE.py:CLASS."""

from collections.abc import Callable, Sequence
from importlib import import_module
from importlib.metadata import entry_points
from math import isfinite, pi
from typing import Any, NamedTuple

from ..core.errors import FAILURES, ConfigurationError, shown
from ..core.user_file import FILE_AND_NAME, load_user_file
from ..perception.camera_model import CameraModel
from ..robots.description import RobotDescription, load_robot
from .robot import (
    JointRobot,
    Robot,
    VelocityLimits,
    VelocityRobot,
)

RobotClass = type[VelocityRobot] | type[JointRobot]
# Modules of this package; each has make_robot(request).
VENDORS = ("lola", "naoqi", "rcss", "ros2")
GROUP = "stepaside.robots"  # entry points of other packages, likewise


class RobotRequest(NamedTuple):
    """Request for a robot."""

    address: str  # what follows the name of the protocol
    role: str = "evader"
    robot: str = "nao"  # name of its description, or folder
    dry_run: bool = False  # whether nothing will be commanded
    camera: CameraModel | None = None  # optics, where it does not tell them
    latency: float = 0.0  # from exposure to arrival of its images, in [s]
    lateral: float = 0.0  # maximum lateral speed, in [m/s]
    domain: int | None = None  # of ROS 2; None for the environment's
    network: bool = False  # whether ROS 2 topics reach other machines
    remap: tuple[str, ...] = ()  # NAME:=/TOPIC
    opponent: str = ""  # class of the detections that count; empty for any
    people: tuple[str, ...] = ()  # files of further topics with people

    @property
    def description(self) -> RobotDescription:
        """Description of the robot."""
        return load_robot(self.robot)


def find_robot(name: str, request: RobotRequest) -> Callable[[], Any] | None:
    """Return a function that makes the robot of a protocol.

    Returns:
        Function that makes a JointRobot or a VelocityRobot without
        connecting to it; None if there is no such protocol.

    Raises:
        ConfigurationError: If the address is invalid, or a library lacks.
    """
    make: Any = None
    if name in VENDORS:
        make = import_module(f".{name}", __package__).make_robot
    else:
        for entry in entry_points(group=GROUP, name=name):
            make = entry.load()
    found: Callable[[], Any] | None = make and make(request)
    return found


def load_robot_class(name: str) -> RobotClass:
    """Load a robot of a user's file.

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
    if not _is_robot(kind):
        own = [each for each, thing in vars(loaded).items()
               if _is_robot(thing)]  # fmt: skip
        raise ConfigurationError(
            f"{where}: must be a subclass of stepaside.VelocityRobot or "
            "stepaside.JointRobot; the file has "
            f"{', '.join(sorted(own)) or 'no robot'}"
        )
    check_robot_class(kind, where)
    try:
        kind()
    except FAILURES as error:
        raise ConfigurationError(
            f"{where}: {kind.__name__}() must make a robot without "
            f"connecting, got {type(error).__name__}: {error}"
        ) from error
    made: RobotClass = kind
    return made


def _is_robot(kind: Any) -> bool:
    bases = JointRobot, VelocityRobot
    return (
        isinstance(kind, type)
        and issubclass(kind, bases)
        and kind not in bases
    )


def check_robot_class(kind: Any, where: str) -> None:
    """Check methods, flags and values of a robot's class."""

    def refuse(text: str) -> None:
        raise ConfigurationError(f"{where}: {text}")

    joints = issubclass(kind, JointRobot)
    base = JointRobot if joints else VelocityRobot
    for name, own in (vars(Robot) | vars(base)).items():
        value = getattr(kind, name)
        if name.startswith("_"):
            continue
        if callable(own) and not callable(value):
            refuse(f"{name} must be a method")
        if isinstance(own, bool) and not isinstance(value, bool):
            refuse(f"{name} must be True or False, got {shown(value)}")
    for name in sorted(kind.__abstractmethods__):
        refuse(f"lacks the method {name}()")
    fault = _joint_class_fault(kind) if joints else _velocity_class_fault(kind)
    if fault:
        refuse(fault)


def _joint_class_fault(kind: type[JointRobot]) -> str:
    """Return what is wrong with tick, joints or gains; empty if nothing."""
    tick = getattr(kind, "tick", None)
    if not (isinstance(tick, int | float) and 0.001 <= tick <= 0.1):
        return f"tick must be in [0.001, 0.1] s, got {shown(tick)}"
    joints = getattr(kind, "joints", None)
    named = isinstance(joints, Sequence) and not isinstance(joints, str)
    if not named or not all(isinstance(name, str) for name in joints or ()):
        return (
            "joints must be the names of the joints, in the order of all "
            f"arrays, got {shown(joints)}"
        )
    for joint, pair in (kind.gains or {}).items():
        if not _are_numbers(pair, 2):
            return (
                f"gains of {joint} must be a stiffness [N m/rad] and a "
                f"damping [N m s/rad], got {shown(pair)}"
            )
    return ""


def _velocity_class_fault(kind: type[VelocityRobot]) -> str:
    """Return what is wrong with limits or head; empty if nothing."""
    limits, head = getattr(kind, "limits", None), kind.head
    found = {}
    if isinstance(limits, VelocityLimits):
        found = {
            n: getattr(limits, n) for n in ("forward", "backward", "turn")
        }
    if not found or not all(map(isfinite, found.values())):
        return (
            "limits must be VelocityLimits(forward=..., backward=..., "
            f"turn=...), all finite, got {shown(limits)}"
        )
    if head is not None and not _are_numbers(head, 3, pi):
        return (
            "head must be HeadLimits(yaw, up, down), >= 0, in [rad], got "
            f"{shown(head)}"
        )
    if head is not None and kind.look is VelocityRobot.look:
        return "head needs the method look()"
    return ""


def _are_numbers(values: Any, count: int, most: float = 1e12) -> bool:
    """Return whether there are so many numbers from 0 to the greatest."""
    try:
        return len(values) == count and all(0.0 <= v <= most for v in values)
    except TypeError:
        return False
