"""Robots that are found by the name of their protocol, as NAME:ADDRESS."""

from collections.abc import Callable
from importlib import import_module
from importlib.metadata import entry_points
from typing import Any, NamedTuple

from ..perception.camera_model import CameraModel
from ..robots.description import RobotDescription, load_robot

# Modules of this package; each has make_robot(request).
VENDORS = ("lola", "naoqi", "rcss", "ros2")
GROUP = "stepaside.robots"  # entry points of other packages, likewise


class RobotRequest(NamedTuple):
    """Request for a robot.

    Attributes:
        address: What follows the name of the protocol.
        role: Role of the player.
        robot: Name of its description, or folder.
        dry_run: Whether nothing will be commanded.
        camera: Optics of its camera, where it does not tell them.
        latency: Time from exposure to arrival of its images, in [s].
        lateral: Maximum lateral speed, in [m/s]; 0 without one.
        domain: ROS 2 domain; None for that of the environment.
        network: Whether ROS 2 topics are visible to other machines.
        remap: Other names of topics, as NAME:=/TOPIC.
        opponent: Class of the detections that are the opponent; empty for
            any.
        people: Files of further topics with people.
    """

    address: str
    role: str = "evader"
    robot: str = "nao"
    dry_run: bool = False
    camera: CameraModel | None = None
    latency: float = 0.0
    lateral: float = 0.0
    domain: int | None = None
    network: bool = False
    remap: tuple[str, ...] = ()
    opponent: str = ""
    people: tuple[str, ...] = ()

    @property
    def description(self) -> RobotDescription:
        """Description of the robot."""
        return load_robot(self.robot)


def find_robot(name: str, request: RobotRequest) -> Callable[[], Any] | None:
    """Return a function that makes the robot of a protocol.

    Args:
        name: Name of the protocol, such as lola.
        request: The robot.

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
