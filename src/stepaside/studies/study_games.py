"""Games that a study can play: settings from entries, and flat records."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from math import isfinite
from typing import Any, NamedTuple

import numpy as np

from ..core.errors import PlanError
from ..core.player_identity import Role
from ..core.poses import Pose
from ..games.floor_games import play_unicycles
from ..games.game_settings import GameSettings, duel, walk
from ..games.outcome import Outcome
from ..games.recorded_game import run_game
from ..games.run import Run
from ..games.run_archive import results_of
from ..games.settings_reader import read_game, settings_of
from ..games.unicycle_settings import UnicycleSettings
from ..strategies.registry import check_strategy_name
from ..theory.unicycle.adaptive_simulation import simulate
from ..theory.unicycle.certificate import certify
from ..theory.unicycle.unicycle_game import RelativeStart, make_game
from .person_encounters import Encounter, play_encounter
from .push_limit import PushSettings, play_push
from .tabulation import Record, flat
from .tournament import PairingSettings, play_pairing

BEFORE = 2.0 / 3.0  # of a duel; means are taken over the rest


def play_duel(settings: GameSettings) -> Record:
    """Play one duel and return its record: what it came to, by flat names."""
    run = run_game(settings).uninterrupted()
    since, (closest, certified) = run.summary.converged_at_s, _evasion(run)
    both = closest is not None and certified is not None
    return flat(results_of(run)) | {
        "on_circle": since is not None,
        "on_circle_in_time": since is not None
        and since < BEFORE * run.settings.duration,
        "evading_min_distance_m": closest,
        "certified_m": certified,
        "over_certificate_m": closest - certified if both else None,
    }


def _evasion(run: Run) -> tuple[Any, Any]:
    """Return the closest approach while evading, and its certificate, in [m].

    The certificate is that of two unicycles at the poses of the players when
    evasion begins, with an evader that keeps its side.
    """
    triggered = run.summary.triggered_at_s
    if triggered is None or run.settings.pursuer.body != "robot":
        return None, None
    since = run.times >= triggered - 1e-9
    if not since.any():
        return None, None
    closest = float(run.distance[since].min())
    first = int(np.argmax(since))
    start = RelativeStart.from_world(
        Pose(*run.pursuer.unicycle[first].tolist()),
        Pose(*run.evader.unicycle[first].tolist()),
    )
    own = run.settings.evader
    gait, strategy = own.gait, own.evasion
    ends = strategy.trigger == "time" or isfinite(strategy.release_distance)
    if ends or not run.settings.is_of_the_paper:
        return closest, None  # it assumes permanent evasion
    try:
        game = make_game(
            gait.speed,
            gait.speed,
            gait.gain,
            gait.gain,
            strategy.angle,
            "saturated" if strategy.saturated else "proportional",
            side_rule="latched",
        )
        certificate = certify(game, start)
    except PlanError:  # the certificate does not cover this game
        return closest, None
    return closest, certificate.distance_m if certificate.holds else None


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

    settings: Any  # class of its settings, or the game that they change
    play: Callable[[Any], Record]  # plays a game; returns its record
    values: tuple[str, ...]  # values of a record that are tabulated by default


HOLDS = {Encounter: ("duel",), PushSettings: ("walk",)}  # games of others


def settings_of_study(kind: Any, entries: Mapping[str, Any]) -> Any:
    """Return settings from nested entries; see :func:`.read_game`.

    The kind is a class of settings, or the game that they change.
    """
    entries = dict(entries)
    if isinstance(kind, GameSettings):
        return read_game(entries, "the settings", base=kind)
    if kind is TeamGame:
        own = {
            k: entries.pop(k) for k in ("pursuers", "evaders") if k in entries
        }
        return TeamGame(read_game(entries, "the settings"), **own)
    if kind is Encounter:
        game = entries.get("duel", {})
        if not game.get("robot") and not game.get("legs", {}).get("network"):
            game = {"gait": "fast"} | game  # NAO's, if none is chosen
        entries["duel"] = game
    inner = {}
    for name in HOLDS.get(kind, ()):
        base, own = getattr(kind(), name), entries.pop(name, {})
        inner[name] = read_game(own, "the settings", base=base)
    made = settings_of(kind, entries, "the settings")
    return replace(made, **inner)


def _play_walk(settings: GameSettings) -> Record:
    run = run_game(settings).uninterrupted()
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
    "duel": StudyGame(duel(), play_duel, ("outcome", "min_distance_m")),
    "walk": StudyGame(walk(), _play_walk, ("survived", "walking.speed_ratio")),
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
