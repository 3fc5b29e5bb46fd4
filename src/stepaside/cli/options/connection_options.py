"""Options for connections to robots with their own walking controller."""

import click

from ..value_types import NumberType
from .declaration import OptionDeclaration

DOMAIN = OptionDeclaration(
    "--domain",
    "ROS 2 domain; ROS_DOMAIN_ID by default, or 0 if that is not set.",
    kind=click.IntRange(0, 232),
)
NETWORK = OptionDeclaration(
    "--network/--no-network",
    "Make the ROS 2 topics visible to other machines. Without it, ROS 2 "
    "programs on this machine require "
    "ROS_AUTOMATIC_DISCOVERY_RANGE=LOCALHOST.",
)
MAX_SPEED = OptionDeclaration(
    "--max-speed",
    "Maximum speed of a robot with velocity commands",
    unit="m/s",
    kind=NumberType("m/s"),
)
MAX_TURN = OptionDeclaration(
    "--max-turn",
    "Maximum turning rate of a robot with velocity commands",
    unit="rad/s",
    kind=NumberType("rad/s"),
)
SIM_TIME = OptionDeclaration(
    "--sim-time/--no-sim-time",
    "The robot is simulated: its clock may pause or run at any rate.",
)
MOTION_INTERFACES = ("velocity", "footsteps", "joints")
BY = OptionDeclaration(
    "--by",
    "Commands sent to a robot over NAOqi.  [default: velocity]",
    registry=lambda: MOTION_INTERFACES,
)
