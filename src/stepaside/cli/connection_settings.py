"""Options of ``stepaside play``: one player, and the connection to a robot."""

import re
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from ..core.errors import ConfigurationError
from ..core.ranges import Range
from ..core.setting import check_settings, setting
from ..core.user_file import FILE_AND_NAME
from ..games.play_settings import PYTHON, PlaySettings
from ..games.player_settings import EVADER, PLAYERS
from ..games.unicycle_settings import WHY, positive
from ..locomotion.control_settings import (
    OPEN_LOOP,
    STABILISED,
    ControlSettings,
)
from .settings import CONTROL, GIVEN
from .terminal import echo

if TYPE_CHECKING:
    from collections.abc import Callable

    from ..drivers.ros2_dds import DdsParticipant

LOLA, NAOQI, ROS2, RCSS = "lola:", "naoqi:", "ros2:", "rcss:"
_SWITCH = re.compile(r"key|gamepad(:.+)?|ros2:/.+")


@dataclass(frozen=True, slots=True)
class ConnectionSettings:
    """Player of ``stepaside play`` and the connection to its robot."""

    address: str = setting("", "Address of the robot")
    role: str = setting(EVADER, "Role of the robot", names=PLAYERS)
    robot: str = setting(
        "nao", "Name of a robot, or folder of its description"
    )
    delay_ticks: int = setting(
        3,
        "Delay from command to motion, in ticks of 12 ms",
        Range(0, 20, "ticks", "longer, balance is lost", whole=True),
    )
    images: str | None = setting(
        None,
        "Source of images with sensing by cameras and joint control: "
        "v4l2:DEVICE; the robot's own camera by default",
    )
    max_speed: float | None = setting(
        None,
        "Maximum speed of a robot with velocity commands",
        positive("m/s", None),
    )
    max_turn: float | None = setting(
        None,
        "Maximum turning rate of a robot with velocity commands",
        positive("rad/s", None),
    )
    max_lateral: float | None = setting(
        None,
        "Maximum lateral speed of a ROS 2 robot that steps sideways; requires "
        "max_speed and max_turn, and without it no lateral velocity is "
        "commanded",
        positive("m/s", None),
    )
    domain: int | None = setting(
        None,
        "ROS 2 domain; ROS_DOMAIN_ID by default, or 0 if that is not set",
        Range(0, 232, "1", "of ROS 2", whole=True, also=(None,)),
    )
    network: bool = setting(
        False,
        "Make the ROS 2 topics visible to other machines. Without it, ROS 2 "
        "programs on this machine require "
        "ROS_AUTOMATIC_DISCOVERY_RANGE=LOCALHOST",
    )
    remap: tuple[str, ...] = setting(
        (),
        "Another name of a topic of a ROS 2 robot, NAME:=/TOPIC, with NAME "
        "odom, cmd_vel or a topic of people; repeatable",
    )
    opponent: str = setting(
        "",
        "Class of the detections (vision_msgs/Detection3DArray) that are "
        "the opponent; any by default",
    )
    people: tuple[str, ...] = setting(
        (),
        "TOML file of further topics with people on ROS 2 "
        "(docs/robots-real.md); repeatable",
    )
    sim_time: bool = setting(
        False,
        "The robot is simulated: its clock may pause or run at any rate",
    )
    duration: float | None = setting(
        None,
        "Walk for this time, then rest",
        positive("s", None),
    )
    wait: float = setting(
        10.0,
        "Maximum time to wait for the first connection",
        Range(1e-9, 1e9, "s", WHY, also=(0.0,)),
    )
    record: Path | None = setting(
        None,
        "Record all measurements, targets and state changes to a run folder "
        "for stepaside show",
    )
    dry_run: bool = setting(
        False,
        "Connect, measure and plan, but do not move: only set LEDs",
    )
    dead_man: str | None = setting(
        None,
        "Walk only while an operator holds a switch: key (any key of the "
        "terminal), gamepad or gamepad:DEVICE (any button), or ros2:/TOPIC "
        "(std_msgs/Bool, true at 4 Hz or more)",
    )
    check: bool = setting(
        False,
        "Check a robot in Python instead of playing: rates, latency, units, "
        "signs and stopping. The robot moves, and must hang in the air if it "
        "is driven by its joints; the exit status is 1 if a check fails",
    )

    def __post_init__(self) -> None:
        """Validate ranges, names and combinations."""
        check_settings(self)
        switch = self.dead_man
        if switch is not None and not _SWITCH.fullmatch(switch):
            raise ConfigurationError(
                "dead_man must be key, gamepad, gamepad:DEVICE or "
                f"ros2:/TOPIC, got {switch!r}"
            )
        limited = self.max_speed and self.max_turn
        if self.address.startswith(ROS2) and self.max_lateral and not limited:
            raise ConfigurationError(
                "max_lateral requires max_speed and max_turn"
            )

    @property
    def in_python(self) -> bool:
        """Whether the robot is a class in a user's file."""
        known = self.address.startswith((LOLA, NAOQI, ROS2, RCSS))
        return not known and FILE_AND_NAME.fullmatch(self.address) is not None

    @property
    def language(self) -> str:
        """Protocol of the robot, as in the settings of a play."""
        return PYTHON if self.in_python else self.address.partition(":")[0]

    @property
    def on_nao(self) -> bool:
        """Whether the protocol is that of a NAO, with its chest button."""
        return self.address.startswith((LOLA, NAOQI))

    def robot_maker(self, settings: PlaySettings) -> "Callable[[], Any]":
        """Return a function that makes the robot, without connecting."""
        if self.in_python:
            from ..drivers.robot_loader import load_robot_class

            return load_robot_class(self.address)
        from ..drivers.robot_loader import RobotRequest, find_robot

        name, _, address = self.address.partition(":")
        if self.address.startswith(ROS2) and not self.network:
            from ..drivers.ros2_dds import LOCAL

            echo(f"stepaside: {LOCAL}", err=True)
        colour = settings.cameras.colour
        make = find_robot(
            name,
            RobotRequest(
                address,
                self.role,
                self.robot,
                dry_run=self.dry_run,
                camera=colour.model(),
                latency=colour.latency + settings.cameras.added_latency,
                lateral=self.max_lateral or 0.0,
                domain=self.domain,
                network=self.network,
                remap=self.remap,
                opponent=self.opponent,
                people=self.people,
            ),
        )
        if make is None:
            raise ConfigurationError(
                f"the address must begin with {LOLA}, {NAOQI}, {ROS2} or "
                f"{RCSS}, or be FILE.py:CLASS, got {self.address!r}"
            )
        return make

    def join_domain(self) -> "DdsParticipant":
        """Join the ROS 2 domain."""
        return join_domain(self.domain, network=self.network)


def join_domain(domain: int | None, *, network: bool) -> "DdsParticipant":
    """Join a ROS 2 domain; print what other programs need to discover it."""
    from ..drivers.ros2_dds import LOCAL, DdsParticipant

    dds = DdsParticipant(domain, beyond=network)
    if not network:
        echo(f"stepaside: {LOCAL}", err=True)
    return dds


def with_feedback(control: ControlSettings) -> ControlSettings:
    """Return control with feedback unless options or settings choose it."""
    given = click.get_current_context().meta[GIVEN]
    chosen = any(path.endswith(CONTROL) for path in given)
    return control if chosen or control != OPEN_LOOP else STABILISED
