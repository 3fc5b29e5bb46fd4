"""Settings of gait, control and games from a robot description."""

from collections.abc import Mapping
from dataclasses import dataclass, fields, replace
from pathlib import Path
from typing import Any

from ..core.errors import ConfigurationError, check_positive
from ..locomotion.control_settings import ControlSettings, LegsSettings
from ..planning import GaitSettings
from ..robots.description import FILE, RobotDescription, load_robot
from ..sim.body_settings import BODIES, BodySettings
from ..strategies import Evasion
from .configuration_file import parse_settings
from .game_settings import GameSettings
from .player_settings import PLAYERS, PlayerSettings

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
UNITS = {"push_unit": "N s", "force_unit": "N"}  # other fields are in [m]


@dataclass(frozen=True, slots=True)
class RobotGameSettings:
    """Distances of a robot's games, and its scales relative to NAO.

    Attributes:
        safety_radius: Safety radius of the robot as evader, in [m].
        start_least: Smallest distance at which a game may begin, in [m].
        start_near: Smallest distance that is drawn for a start, in [m].
        start_far: Greatest distance that is drawn for a start, in [m].
        push_unit: Impulse equivalent to 1 N s on NAO, in [N s].
        force_unit: Force equivalent to 1 N on NAO, by weight, in [N].
        length_unit: Length equivalent to 1 m for NAO, by CoM height, in [m].
    """

    safety_radius: float
    start_least: float
    start_near: float
    start_far: float
    push_unit: float
    force_unit: float = 1.0
    length_unit: float = 1.0

    def __post_init__(self) -> None:
        """Check that values are positive and distances in order."""
        for field in fields(self):
            unit = UNITS.get(field.name, "m")
            value = getattr(self, field.name)
            check_positive(value, f"game.{field.name}", unit)
        if not self.start_least <= self.start_near <= self.start_far:
            raise ConfigurationError(
                "game.start_least, start_near and start_far must not "
                f"decrease [m], got {self.start_least}, {self.start_near} "
                f"and {self.start_far}"
            )


def settings_of_robot(robot: str) -> dict[str, Any]:
    """Return robot, gait, control, legs and safety radius by a description.

    Raises:
        StepAsideError: If the description is invalid.
    """
    description = load_robot(robot)
    own = settings_from_description(description)
    if not own.control.feedback:  # the robot needs none, but a body may
        control = replace(own.control, method=None, feedback=None)
        own = replace(own, control=control)
    found = {name: getattr(own, name) for name in ("gait", "control", "legs")}
    game = game_settings_from_description(description)
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
        gait=parse_settings(GaitSettings, gait, f"{source}, gait"),
        control=parse_settings(
            ControlSettings, dict(description.control), f"{source}, control"
        ),
        legs=LegsSettings(network),
    )


def body_of_robot(robot: str | Path, name: str) -> BodySettings:
    """Return the body of a preset, with the errors of a robot.

    The ideal body is that of all robots; in others the ``[body]`` of the
    robot's description replaces values of NAO.

    Raises:
        StepAsideError: If the description is invalid.
    """
    preset = BODIES[name]
    description = load_robot(robot)
    if name == "ideal" or not description.body:
        return preset
    source = f"{description.folder / FILE}, body"
    return parse_settings(
        BodySettings, dict(description.body), source, base=preset
    )


def game_settings_from_description(
    description: RobotDescription,
) -> RobotGameSettings | None:
    """Return the game settings of a description; None if it has none."""
    if not description.game:
        return None
    source = f"{description.folder / FILE}, game"
    return parse_settings(RobotGameSettings, dict(description.game), source)


def with_distances(settings: GameSettings) -> GameSettings:
    """Return a duel with the distances of its robots, the greater of each.

    Raises:
        StepAsideError: If a description is invalid.
    """
    found = [
        game_settings_from_description(load_robot(player.robot))
        for player in settings.players
        if player.body == "robot"
    ]
    games = [game for game in found if game is not None]
    if settings.names != PLAYERS or not games:
        return settings
    radius = max(game.safety_radius for game in games)
    evasion = replace(settings.evader.evasion, safety_radius=radius)
    start = replace(
        settings.start,
        least=max(game.start_least for game in games),
        near=max(game.start_near for game in games),
        far=max(game.start_far for game in games),
    )
    return settings.changed(start=start, evader={"evasion": evasion})
