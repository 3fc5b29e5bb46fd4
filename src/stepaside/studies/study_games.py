"""Games that a study can play: settings from entries, and flat records."""

from collections.abc import Callable, Mapping
from dataclasses import fields
from math import isfinite
from typing import Any, NamedTuple

import numpy as np

from ..core.errors import PlanError
from ..core.player_identity import Role
from ..core.poses import Pose
from ..games.game import Outcome
from ..games.game_settings import GameSettings, duel, read_game, walk
from ..games.player_settings import settings_of
from ..games.recorded_game import run_game
from ..games.run import Run
from ..theory.unicycle.certificate import certify
from ..theory.unicycle.simulation import RelativeStart, simulate
from ..theory.unicycle.unicycle_game import Unicycles
from ..theory.unicycle.unicycle_settings import UnicycleSettings
from .person_encounters import Encounter, play_encounter
from .push_limit import PushTrial, play_push
from .tabulation import Record, flat
from .tournament import TOURNAMENT, PairingSettings, play_pairing

BEFORE = 2.0 / 3.0  # of a duel; means are taken over the rest


def play_duel(settings: GameSettings) -> Record:
    """Play one duel and return its record: what it came to, by flat names."""
    run = run_game(settings).uninterrupted()
    since, (closest, certified) = run.summary.converged_at_s, _evasion(run)
    over = None
    if closest is not None and certified is not None:
        over = closest - certified
    return flat(run.results()) | {
        "on_circle": since is not None,
        "on_circle_in_time": since is not None
        and since < BEFORE * run.settings.duration,
        "evading_min_distance_m": closest,
        "certified_m": certified,
        "over_certificate_m": over,
        "nearer_than_certified": None if over is None else bool(over < 0),
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
        game = Unicycles(
            gait.speed,
            gait.speed,
            gait.gain,
            gait.gain,
            strategy.angle,
            "saturated" if strategy.saturated else "proportional",
            side_rule="latched",
        )
        return closest, certify(game, start)
    except PlanError:  # the certificate does not cover this game
        return closest, None


class StudyGame(NamedTuple):
    """Game that a study can play."""

    base: Any  # game that the settings change; or the class of all settings
    play: Callable[[Any], Record]  # plays a game; returns its record
    values: tuple[str, ...]  # values of a record that are tabulated by default
    # class of settings that stand beside those of the game, its first field
    own: type[Any] | None = None

    def settings_of(self, entries: Mapping[str, Any]) -> Any:
        """Return settings from nested entries; see :func:`.read_game`.

        In a game of many, ``pursuers`` and ``evaders`` are the strategy of
        all of a role.
        """
        rest, source = dict(entries), "the settings"
        if isinstance(self.base, type):
            return settings_of(self.base, rest, source)
        if self.base is None:
            teams = {role: rest.pop(f"{role}s", "") for role in Role}
            made = read_game(rest, source)
            return made.with_players(
                {
                    own.name: {"strategy": teams[Role(own.role)]}
                    for own in made.players
                    if own.decides and teams[Role(own.role)]
                }
            )
        if self.own is None:
            return read_game(rest, source, base=self.base)
        names = [each.name for each in fields(self.own)[1:]]
        own = {name: rest.pop(name) for name in names if name in rest}
        chosen = rest.get("robot") or rest.get("legs", {}).get("network")
        if self.own is Encounter and not chosen:
            rest = {"gait": "fast"} | rest  # NAO's
        made = self.own(read_game(rest, source, base=self.base))
        return settings_of(self.own, own, source, base=made)


def _play_walk(settings: GameSettings) -> Record:
    run = run_game(settings).uninterrupted()
    survived = run.outcome is Outcome.COMPLETED
    return flat(run.results()) | {"survived": survived}


def _play_unicycles(settings: UnicycleSettings) -> Record:
    played = simulate(
        settings.game,
        settings.start,
        settings.time,
        capture_distance=settings.capture,
    )
    return {
        "outcome": "captured" if played.captured else "completed",
        "duration_s": played.end_time,
        "closest_m": played.closest_distance,
        "closest_at_s": played.closest_time,
        "distance_m": float(played.states([played.end_time])[0, 0]),
    }


def _play_game(settings: GameSettings) -> Record:
    """Play a game of any number of players; return its record.

    For robots among people the measures of crowd navigation have their name
    in front.
    """
    run = run_game(settings).uninterrupted()
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
                f"{name}.intimate_share": met.intimate_s / run.duration,
                f"{name}.personal_share": met.personal_s / run.duration,
            }
    return record


GAMES: Mapping[str, StudyGame] = {
    "duel": StudyGame(duel(), play_duel, ("outcome", "min_distance_m")),
    "walk": StudyGame(walk(), _play_walk, ("survived", "walking.speed_ratio")),
    "push": StudyGame(
        walk(), play_push, ("limit_n_s", "bound_n_s", "of_bound"), PushTrial
    ),
    "person": StudyGame(
        duel(pursuer={"body": "person"}),
        play_encounter,
        ("contact", "fell", "closest_m"),
        Encounter,
    ),
    "game": StudyGame(
        None, _play_game, ("captured", "contact", "fell", "closest_m")
    ),
    "tournament": StudyGame(
        TOURNAMENT,
        play_pairing,
        ("survived", "captured", "touched_obstacle", "closest_m"),
        PairingSettings,
    ),
    "unicycles": StudyGame(
        UnicycleSettings, _play_unicycles, ("outcome", "closest_m")
    ),
}
"""Games by the entry ``game`` of a study."""
