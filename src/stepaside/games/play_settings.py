"""Settings of ``stepaside play``: one player at a robot."""

import re
from dataclasses import dataclass
from typing import ClassVar, Self

from ..core.errors import ConfigurationError
from ..core.ranges import Range, positive
from ..core.setting import check_settings, setting
from ..core.user_file import FILE_AND_NAME
from ..sim.camera_settings import CameraSettings
from ..strategies.registry import check_strategy_name
from .player_settings import EVADER, PLAYERS, RobotSettings

LOLA, NAOQI, ROS2, RCSS = "lola:", "naoqi:", "ros2:", "rcss:"
PYTHON = "python"  # language of a robot that is a class
_SWITCH = re.compile(r"key|gamepad(:.+)?|ros2:/.+")


@dataclass(frozen=True, slots=True, kw_only=True)
class PlaySettings(RobotSettings):
    """Settings of one player at one robot, and the connection to it."""

    game: ClassVar[str] = "play"
    role: str = setting(EVADER, "Role of the player", names=PLAYERS)
    address: str = setting("", "Address of the robot")
    senses: str = setting(
        "ideal",
        "Sensing of the opponent: as the robot reports it (ideal), or "
        "detection in camera images",
        names=("ideal", "cameras"),
    )
    cameras: CameraSettings = setting(
        CameraSettings(),
        "Cameras, with camera sensing",
        needs=("senses", "cameras"),
    )
    dry_run: bool = setting(
        False,
        "Connect, measure and plan, but do not move: only set LEDs",
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
        positive("s", 0.0),
    )
    dead_man: str | None = setting(
        None,
        "Walk only while an operator holds a switch: key (any key of the "
        "terminal), gamepad or gamepad:DEVICE (any button), or ros2:/TOPIC "
        "(std_msgs/Bool, true at 4 Hz or more)",
    )

    def __post_init__(self) -> None:
        """Validate ranges, names and combinations."""
        check_settings(self)
        if self.strategy:
            check_strategy_name(self.strategy)
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

    def player(self, name: str) -> Self:
        """Return the settings of a player's robot: both have the same."""
        return self

    def resolved(self) -> Self:
        """Return the settings with nothing left open."""
        return self.resolved_as(self.role)

    @property
    def cycle(self) -> float:
        """Duration of a gait cycle, two steps, in [s]."""
        return 2.0 * self.gait.step_duration
