"""Games that a live page plays: a duel, or any game of a file, in physics."""

from collections.abc import Mapping
from math import degrees, inf
from typing import Any, NamedTuple

from ...arena import Room
from ...core.errors import ConfigurationError
from ...core.player_identity import PlayerIdentity, Role
from ...games.duel_circle import circle_of_theory
from ...games.duel_settings import EVADER, PLAYERS, DuelSettings
from ...games.game import GameObserver
from ...games.game_settings import GameSettings
from ...games.implied_settings import EVASION
from ...games.recorded_game import RecordedGame
from ..settling_report import settling_time

LiveSettings = DuelSettings | GameSettings


class LiveTheory(NamedTuple):
    """Predictions of the theory for a game; each None if it has none.

    Attributes:
        circle: Distance [m] and angle between headings [deg] on the circle.
        radius: Radius of the evader's circle, in [m].
        settling: Time constant of the approach to the circle, in [s].
    """

    circle: tuple[float, float] | None
    radius: float | None
    settling: float | None


def predict(settings: LiveSettings) -> LiveTheory:
    """Return the predictions of the theory for some settings.

    Args:
        settings: Settings; only a duel has a theory here.
    """
    if isinstance(settings, GameSettings):
        return LiveTheory(None, None, None)
    circle, settling = circle_of_theory(settings), settling_time(settings)
    if not circle.exists:
        return LiveTheory(None, None, settling)
    values = circle.distance_m, degrees(circle.headings_apart_rad)
    return LiveTheory(values, circle.radius_evader_m, settling)


def room_of(settings: LiveSettings) -> Room | None:
    """Return the room of a game; None for an open floor."""
    if isinstance(settings, GameSettings):
        return settings.room
    return settings.room.plan


def safety_radii(settings: LiveSettings) -> dict[str, float]:
    """Return the safety radius of each player that has one, in [m]."""
    if isinstance(settings, DuelSettings):
        return {EVADER: settings.resolved().strategy.area}
    return settings.safety_radii


def identities_of(settings: LiveSettings) -> Mapping[str, PlayerIdentity]:
    """Return the identities of the players, by name."""
    if isinstance(settings, GameSettings):
        return settings.identities
    return {name: PlayerIdentity(name, Role(name), name) for name in PLAYERS}


def open_match(
    settings: LiveSettings, observers: tuple[GameObserver, ...]
) -> RecordedGame:
    """Return a game for a page, which keeps no whole record.

    Args:
        settings: Settings of the game.
        observers: Its observers.

    Raises:
        ConfigurationError: If it is no game in physics.
        StepAsideError: If the settings are invalid.
    """
    if isinstance(settings, GameSettings) and settings.level != "physics":
        raise ConfigurationError(
            "level must be physics for a live page, got "
            f"{settings.level!r}; `stepaside run` plays it, and `stepaside "
            "replay` shows the run"
        )
    return RecordedGame(
        settings, observers, recorded=False, rendered=True, endless=True
    )


def trigger_distance(settings: DuelSettings) -> float:
    """Return the distance at which the evader begins to move, in [m].

    Infinite for strategies that do not wait for a distance.
    """
    settings = settings.resolved()
    if settings.evader_strategy != EVASION:
        return inf
    if settings.pursuer == "person":
        return settings.strategy.begins_at(settings.person.speed)
    speed = settings.gait.stride / settings.gait.step_duration
    return settings.strategy.begins_at(speed)


def has_cameras(settings: LiveSettings) -> bool:
    """Return whether players of a game see by cameras."""
    if isinstance(settings, GameSettings):
        return bool(settings.sensing_by("cameras"))
    return settings.sensing == "cameras"


def stage_of(settings: LiveSettings) -> tuple[Any, ...]:
    """Return what decides which bodies a game has."""
    if isinstance(settings, GameSettings):
        return ()  # those of its file, whatever the seed
    return (
        settings.room,
        settings.pursuer,
        settings.person.figure,
        *(settings.robot_of(player).robot for player in PLAYERS),
    )
