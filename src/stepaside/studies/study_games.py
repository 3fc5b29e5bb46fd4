"""Games that a study can play: settings from entries, and flat records."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, fields, replace
from typing import Any, NamedTuple, get_type_hints

from ..core.player_identity import Role
from ..games.duel_settings import DuelSettings
from ..games.floor_games import play_unicycles
from ..games.game_file import parse_game
from ..games.game_settings import GameSettings
from ..games.outcome import Outcome
from ..games.recorded_game import run_game, run_walk
from ..games.run_archive import results_of
from ..games.settings_reader import settings_of
from ..games.unicycle_settings import UnicycleSettings
from ..games.walk_settings import WalkSettings
from ..strategies.registry import check_strategy_name
from ..theory.unicycle.adaptive_simulation import simulate
from .duel_record import play_duel
from .person_encounters import Encounter, play_encounter
from .push_limit import PushSettings, play_push
from .tabulation import Record, flat
from .tournament import PairingSettings, play_pairing


@dataclass(frozen=True)
class TeamGame:
    """A game, with one strategy for all of a role."""

    game: GameSettings  # settings of the game
    pursuers: str = ""  # strategy of all pursuers; empty for those of the game
    evaders: str = ""  # strategy of all evaders; empty for those of the game

    def __post_init__(self) -> None:
        """Validate the strategies."""
        for name, role in (
            (self.pursuers, "pursuer"),
            (self.evaders, "evader"),
        ):
            if name:
                check_strategy_name(name, role)

    @property
    def settings(self) -> GameSettings:
        """Settings of the game with these strategies."""
        names: dict[str, str] = {
            Role.PURSUER: self.pursuers,
            Role.EVADER: self.evaders,
        }
        players = tuple(
            replace(own, strategy=names.get(own.role) or own.strategy)
            if own.decides
            else own
            for own in self.game.players
        )
        return replace(self.game, players=players)


class StudyGame(NamedTuple):
    """Game that a study can play."""

    settings: type[Any]  # class of its settings
    play: Callable[[Any], Record]  # plays a game; returns its record
    values: tuple[str, ...]  # values of a record that are tabulated by default


def settings_of_study(kind: type[Any], entries: Mapping[str, Any]) -> Any:
    """Return settings from nested entries; see :func:`.settings_of`."""
    entries = dict(entries)
    if kind is TeamGame:
        own = {
            k: entries.pop(k) for k in ("pursuers", "evaders") if k in entries
        }
        return TeamGame(parse_game(entries, "the settings"), **own)
    if kind is Encounter:
        duel = {"pursuer": "person", **entries.get("duel", {})}
        if not duel.get("robot") and not duel.get("legs", {}).get("network"):
            duel.setdefault("gait", "fast")  # NAO's, if none is chosen
        entries["duel"] = duel
    names, hints = {each.name for each in fields(kind)}, get_type_hints(kind)
    inner = {
        name: settings_of_study(hints[name], entries.pop(name, {}))
        for name in ("walk", "duel")
        if name in names
    }
    made = settings_of(kind, entries, "the settings")
    return replace(made, **inner)


def _play_walk(settings: WalkSettings) -> Record:
    run = run_walk(settings).uninterrupted()
    survived = run.outcome is Outcome.COMPLETED
    return flat(results_of(run)) | {"survived": survived}


def _play_unicycles(settings: UnicycleSettings) -> Record:
    game, start, names = settings.game, settings.start, settings.strategies
    if names is not None:
        times = settings.time, settings.period
        track = play_unicycles(game, start, names, times, settings.capture)
        nearest = int(track.distances.argmin())
        ended, distance = track.times, float(track.distances[-1])
        return {
            "outcome": track.outcome.value,
            "duration_s": float(ended[-1]),
            "closest_m": track.closest_distance,
            "closest_at_s": float(ended[nearest]),
            "distance_m": distance,
        }
    played = simulate(
        game, start, settings.time, capture_distance=settings.capture
    )
    (end,) = played.states([played.end_time])
    return {
        "outcome": "captured" if played.captured else "completed",
        "duration_s": played.end_time,
        "closest_m": played.closest_distance,
        "closest_at_s": played.closest_time,
        "distance_m": float(end[0]),
    }


def _play_game(settings: TeamGame) -> Record:
    """Play a game of any number of players; return its record.

    For robots among people the measures of crowd navigation have their name
    in front.
    """
    run = run_game(settings.settings).uninterrupted()
    summary = run.summary
    record: Record = {
        "outcome": run.outcome.value,
        "message": run.message,
        "duration_s": run.duration,
        "captured": summary.captured_at_s is not None,
        "captured_at_s": summary.captured_at_s,
        "contact": run.outcome is Outcome.CONTACT,
        "fell": bool(summary.fallen),
        "closest_m": summary.min_distance_m,
        "fallen": list(summary.fallen),
        "touched": list(summary.touched),
    }
    for name, own in summary.players.items():
        if (met := own.crowd) is not None:
            record |= {
                f"{name}.success": met.success,
                f"{name}.collided": met.collisions > 0,
                f"{name}.time_s": own.goal_at_s if met.success else None,
                f"{name}.below_0_45_m": met.intimate_s / run.duration,
                f"{name}.below_1_2_m": met.personal_s / run.duration,
            }
    return record


GAMES: Mapping[str, StudyGame] = {
    "duel": StudyGame(DuelSettings, play_duel, ("outcome", "min_distance_m")),
    "walk": StudyGame(
        WalkSettings, _play_walk, ("survived", "walking.speed_ratio")
    ),
    "push": StudyGame(
        PushSettings, play_push, ("limit_n_s", "bound_n_s", "of_bound")
    ),
    "person": StudyGame(
        Encounter,
        play_encounter,
        ("contact", "fell", "closest_m"),
    ),
    "game": StudyGame(
        TeamGame, _play_game, ("captured", "contact", "fell", "closest_m")
    ),
    "tournament": StudyGame(
        PairingSettings,
        play_pairing,
        ("survived", "captured", "touched_obstacle", "closest_m"),
    ),
    "unicycles": StudyGame(
        UnicycleSettings, _play_unicycles, ("outcome", "closest_m")
    ),
}
"""Games by the entry ``game`` of a study."""
