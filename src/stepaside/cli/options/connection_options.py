"""Options of the ways to robots that walk by themselves."""

import click

from ..value_types import NumberType
from .declaration import OptionDeclaration

DOMAIN = OptionDeclaration(
    "--domain",
    "ROS 2 domain; that of ROS_DOMAIN_ID, or 0, by default.",
    kind=click.IntRange(0, 232),
)
NETWORK = OptionDeclaration(
    "--network/--no-network",
    "Let other machines take part in ROS 2 topics, not this one alone; "
    "without it ROS 2 programs of this machine need "
    "ROS_AUTOMATIC_DISCOVERY_RANGE=LOCALHOST.",
)
MAX_SPEED = OptionDeclaration(
    "--max-speed",
    "Greatest speed that a robot driven by velocity accepts",
    unit="m/s",
    kind=NumberType("m/s"),
)
MAX_TURN = OptionDeclaration(
    "--max-turn",
    "Greatest turning rate that it accepts",
    unit="rad/s",
    kind=NumberType("rad/s"),
)
SIM_TIME = OptionDeclaration(
    "--sim-time/--no-sim-time",
    "Its time is simulated, and may stand still or run.",
)
WAYS = ("velocity", "footsteps", "joints")
BY = OptionDeclaration(
    "--by",
    "How a robot on NAOqi is moved; by velocity by default.",
    registry=lambda: WAYS,
)
