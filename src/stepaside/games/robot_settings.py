"""Settings of gait, control and games from a robot description."""

from collections.abc import Mapping
from dataclasses import dataclass, fields, replace
from pathlib import Path
from typing import Any, TypeVar

from ..core.errors import ConfigurationError, check_positive
from ..locomotion.control_settings import ControlSettings, LegsSettings
from ..planning import GaitSettings
from ..robots.description import FILE, RobotDescription, load_robot
from ..sim.body_settings import BODIES, BodySettings
from .configuration_file import parse_settings
from .duel_settings import DuelSettings, RobotSettings, StartSettings

S = TypeVar("S")
# Template of learned legs: speed [m/s], gain [1/s], and 0.4 s from decision to
# decision, in path time as in gait time. Their CoM is over the feet.
LEGS_GAIT: Mapping[str, float] = {
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


def settings_of_robot(robot: str) -> RobotSettings:
    """Return gait and control of a robot, from its description.

    Raises:
        StepAsideError: If the description is invalid.
    """
    own = settings_from_description(load_robot(robot))
    if not own.control.feedback:  # the robot needs none, but a body may
        control = replace(own.control, method=None, feedback=None)
        own = replace(own, control=control)
    return replace(own, robot=robot)


def settings_from_description(description: RobotDescription) -> RobotSettings:
    """Return gait and control from a description."""
    source = str(description.folder / FILE)
    gait: dict[str, Any] = dict(description.gait)
    network = description.locomotion.get("network", "")
    if network:
        network = str(description.path_of(network))
        gait |= LEGS_GAIT
    if description.sole:
        gait["sole"] = dict(description.sole)
    return RobotSettings(
        str(description.folder),
        parse_settings(GaitSettings, gait, f"{source}, gait"),
        parse_settings(
            ControlSettings, dict(description.control), f"{source}, control"
        ),
        LegsSettings(network),
    )


def body_of_robot(robot: str | Path, name: str) -> BodySettings:
    """Return the body of a preset, with the errors of a robot.

    Args:
        robot: Name of the robot, or folder of its description, whose
            ``[body]`` replaces values of NAO.
        name: Name of the preset; the ideal body is that of all robots.

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


def with_legs(settings: S, network: str) -> S:
    """Return settings for a walking policy and its usual game."""
    changed: S = replace(
        settings,  # type: ignore[type-var]
        gait=replace(settings.gait, **LEGS_GAIT),  # type: ignore[attr-defined]
        legs=LegsSettings(network),
    )
    return changed


def game_settings_from_description(
    description: RobotDescription,
) -> RobotGameSettings | None:
    """Return the game settings of a description; None if it has none."""
    if not description.game:
        return None
    source = f"{description.folder / FILE}, game"
    return parse_settings(RobotGameSettings, dict(description.game), source)


def with_robot(settings: S, robot: str) -> S:
    """Return settings for another robot, from its description.

    Gait and control are replaced, and in a duel also the distances.

    Raises:
        StepAsideError: If there is no such robot, or its description is
            invalid.
    """
    own = settings_of_robot(robot)
    names = {field.name for field in fields(settings)}  # type: ignore[arg-type]
    values: dict[str, Any] = {
        field.name: getattr(own, field.name) for field in fields(own)
    }
    game = game_settings_from_description(load_robot(robot))
    if isinstance(settings, DuelSettings) and game is not None:
        values["strategy"] = _with_radius(settings.strategy, game)
        values["start"] = _with_distances(settings.start, game)
    changes = {k: v for k, v in values.items() if k in names}
    changed: S = replace(settings, **changes)  # type: ignore[type-var]
    return changed


def with_players(
    settings: DuelSettings, robots: Mapping[str, str]
) -> DuelSettings:
    """Return settings of a duel whose players are different robots.

    Of each distance the greater of both robots is used.
    """
    for player, robot in robots.items():
        own = settings_of_robot(robot)
        change: dict[str, Any] = {f"{player}_robot": own}
        settings = replace(settings, **change)
        game = game_settings_from_description(load_robot(robot))
        if game is None:
            continue
        start, strategy = settings.start, settings.strategy
        larger = RobotGameSettings(
            max(game.safety_radius, strategy.safety_radius),
            max(game.start_least, start.least),
            max(game.start_near, start.near),
            max(game.start_far, start.far),
            game.push_unit,
        )
        settings = replace(
            settings,
            strategy=_with_radius(strategy, larger),
            start=_with_distances(start, larger),
        )
    return settings


def _with_radius(strategy: Any, game: RobotGameSettings) -> Any:
    return replace(strategy, safety_radius=game.safety_radius)


def _with_distances(
    start: StartSettings, game: RobotGameSettings
) -> StartSettings:
    return replace(
        start,
        least=game.start_least,
        near=game.start_near,
        far=game.start_far,
    )
