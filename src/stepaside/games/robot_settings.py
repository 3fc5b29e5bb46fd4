"""Settings of gait, control and games from a robot description."""

from collections.abc import Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

from ..core.entries import read_entries
from ..core.errors import LARGEST, LEAST, ConfigurationError
from ..core.ranges import Range
from ..core.setting import REQUIRED, check_settings, setting
from ..locomotion.control_settings import ControlSettings, LegsSettings
from ..planning import GaitSettings
from ..robots.description import FILE, RobotDescription, load_robot
from ..sim.body_settings import BODIES, BodySettings
from ..strategies import Evasion
from .player_settings import PlayerSettings

# Template of learned legs: speed [m/s], gain [1/s], and 0.4 s from decision to
# decision, in path time as in gait time. Their CoM is over the feet.
LEGS_GAIT: Mapping[str, Any] = {
    "speed": 0.5,
    "gain": 0.4,
    "stride": 0.2,
    "single_support": 0.3,
    "double_support": 0.1,
    "zmp_forward": 0.0,
}


def _positive(unit: str) -> Range:
    return Range(LEAST, LARGEST, unit, "others may overflow a double")


@dataclass(frozen=True, slots=True)
class RobotGameSettings:
    """Distances of a robot's games, and its scales relative to NAO."""

    safety_radius: float = setting(
        REQUIRED, "Safety radius of the robot as evader", _positive("m")
    )
    start_least: float = setting(
        REQUIRED, "Smallest distance at which it may begin", _positive("m")
    )
    start_near: float = setting(
        REQUIRED, "Smallest distance that is drawn", _positive("m")
    )
    start_far: float = setting(
        REQUIRED, "Greatest distance that is drawn", _positive("m")
    )
    push_unit: float = setting(
        REQUIRED, "Impulse like 1 N s on NAO", _positive("N s")
    )
    force_unit: float = setting(
        1.0, "Force like 1 N on NAO, by weight", _positive("N")
    )
    length_unit: float = setting(
        1.0, "Length like 1 m for NAO, by CoM height", _positive("m")
    )

    def __post_init__(self) -> None:
        """Check that values are positive and distances in order."""
        check_settings(self, prefix="game.")
        if not self.start_least <= self.start_near <= self.start_far:
            raise ConfigurationError(
                "game.start_least, start_near and start_far must not "
                f"decrease [m], got {self.start_least}, {self.start_near} "
                f"and {self.start_far}"
            )


def settings_of_robot(robot: str) -> dict[str, Any]:
    """Return robot, gait, control, legs and safety radius by a description."""
    own = settings_from_description(load_robot(robot))
    if not own.control.feedback:  # the robot needs none, but a body may
        control = replace(own.control, method=None, feedback=None)
        own = replace(own, control=control)
    found = {name: getattr(own, name) for name in ("gait", "control", "legs")}
    game = game_of_robot(robot)
    if game is not None:
        found["evasion"] = Evasion(safety_radius=game.safety_radius)
    return found | {"robot": robot}


def settings_from_description(description: RobotDescription) -> PlayerSettings:
    """Return a player with robot, gait, control and legs of a description."""
    source = str(description.folder / FILE)
    gait: dict[str, Any] = dict(description.gait)
    network = description.locomotion.get("network", "")
    if network:
        network = str(description.path_of(network))
        gait |= LEGS_GAIT
    if description.sole:
        gait["sole"] = dict(description.sole)
    return PlayerSettings(
        "robot",
        robot=str(description.folder),
        gait=read_entries(GaitSettings, gait, f"{source}, gait"),
        control=read_entries(
            ControlSettings, dict(description.control), f"{source}, control"
        ),
        legs=LegsSettings(network),
    )


def body_of_robot(robot: str | Path, name: str) -> BodySettings:
    """Return the body of a preset, with the errors of a robot.

    The ideal body is that of all robots; in others the ``[body]`` of the
    robot's description replaces values of NAO.
    """
    preset = BODIES[name]
    description = load_robot(robot)
    if name == "ideal" or not description.body:
        return preset
    source = f"{description.folder / FILE}, body"
    return read_entries(
        BodySettings, dict(description.body), source, base=preset
    )


def game_of_robot(robot: str | Path) -> RobotGameSettings | None:
    """Return the distances and scales of a robot; None if it has none."""
    description = load_robot(robot)
    if not description.game:
        return None
    source = f"{description.folder / FILE}, game"
    return read_entries(RobotGameSettings, dict(description.game), source)
