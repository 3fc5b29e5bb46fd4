"""What a robot's description says of its games, as settings."""

from collections.abc import Mapping
from dataclasses import dataclass, fields, replace
from typing import Any, TypeVar

from ..core.errors import ConfigurationError, check_positive
from ..locomotion.zmp.control_settings import ControlSettings
from ..planning import GaitSettings
from ..robots.description import FILE, RobotDescription, load_robot
from .configuration_file import parse_settings
from .duel_settings import DuelSettings, RobotSettings, StartSettings

S = TypeVar("S")
UNITS = {"push_unit": "N s", "force_unit": "N"}  # of what is no length


@dataclass(frozen=True, slots=True)
class RobotGameSettings:
    """Distances of a robot's games, and its unit of pushes.

    Attributes:
        safety_radius: Distance at which it evades, in [m].
        start_least: Least distance at which a game may begin, in [m].
        start_near: Least distance that is drawn for a start, in [m].
        start_far: Greatest one, in [m].
        push_unit: Impulse that does to it what 1 N s does to NAO, in [N s].
        force_unit: Force that is to its weight what 1 N is to NAO's, in [N].
        length_unit: Length that is to it what 1 m is to NAO, in [m].
    """

    safety_radius: float
    start_least: float
    start_near: float
    start_far: float
    push_unit: float
    force_unit: float = 1.0
    length_unit: float = 1.0

    def __post_init__(self) -> None:
        """Refuse what is no distance."""
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
    """Gait and control of a robot, as its description says.

    Args:
        robot: Its name, or the folder of its description.

    Raises:
        StepAsideError: If the description says what no robot can do.
    """
    return replace(settings_of(load_robot(robot)), robot=robot)


def settings_of(description: RobotDescription) -> RobotSettings:
    """Gait and control of a robot, as its description says; see above."""
    source = str(description.folder / FILE)
    gait: dict[str, Any] = dict(description.gait)
    if description.sole:
        gait["sole"] = dict(description.sole)
    return RobotSettings(
        str(description.folder),
        parse_settings(GaitSettings, gait, f"{source}, gait"),
        parse_settings(
            ControlSettings, dict(description.control), f"{source}, control"
        ),
    )


def game_of(description: RobotDescription) -> RobotGameSettings | None:
    """Distances of a robot's games; None if its file does not say."""
    if not description.game:
        return None
    source = f"{description.folder / FILE}, game"
    return parse_settings(RobotGameSettings, dict(description.game), source)


def with_robot(settings: S, robot: str) -> S:
    """Settings of another robot, with what its description says.

    That is its gait and its control, and of a duel the distances, too.

    Args:
        settings: Of a walk, a duel or something else with a robot; what is
            not the robot's stays.
        robot: Name of a robot, or the folder of its description.

    Raises:
        StepAsideError: If there is none, or its description says what no
            robot can do.
    """
    own = settings_of_robot(robot)
    known = {field.name for field in fields(settings)}  # type: ignore[arg-type]
    values: dict[str, Any] = {
        field.name: getattr(own, field.name) for field in fields(own)
    }
    game = game_of(load_robot(robot))
    if isinstance(settings, DuelSettings) and game is not None:
        values["strategy"] = _widened(settings.strategy, game)
        values["start"] = _drawn_from(settings.start, game)
    changed = {k: v for k, v in values.items() if k in known}
    made: S = replace(settings, **changed)  # type: ignore[type-var]
    return made


def with_players(
    settings: DuelSettings, robots: Mapping[str, str]
) -> DuelSettings:
    """Settings of a duel whose players are different robots.

    The greater distances of both hold for the two.

    Args:
        settings: Of the duel.
        robots: Robot of each player that has one of its own, by player.
    """
    for player, robot in robots.items():
        own = settings_of_robot(robot)
        change: dict[str, Any] = {f"{player}_robot": own}
        settings = replace(settings, **change)
        game = game_of(load_robot(robot))
        if game is None:
            continue
        start, strategy = settings.start, settings.strategy
        wide = RobotGameSettings(
            max(game.safety_radius, strategy.safety_radius),
            max(game.start_least, start.least),
            max(game.start_near, start.near),
            max(game.start_far, start.far),
            game.push_unit,
        )
        settings = replace(
            settings,
            strategy=_widened(strategy, wide),
            start=_drawn_from(start, wide),
        )
    return settings


def _widened(strategy: Any, game: RobotGameSettings) -> Any:
    return replace(strategy, safety_radius=game.safety_radius)


def _drawn_from(
    start: StartSettings, game: RobotGameSettings
) -> StartSettings:
    return replace(
        start,
        least=game.start_least,
        near=game.start_near,
        far=game.start_far,
    )
