"""Campaign of games of any number of players: teams, and seeds."""

import json
from collections.abc import Iterable, Sequence
from dataclasses import asdict, replace
from functools import partial
from hashlib import sha256
from time import perf_counter
from typing import Any

import numpy as np

from ..core.player_identity import Role
from ..games.configuration_file import json_settings
from ..games.game_match import run_game
from ..games.game_settings import GameSettings
from ..games.outcome import Outcome
from ..games.run import MatchRun
from ..strategies.registry import file_of
from .case_grid import CaseGrid
from .duel_statistics import proportion
from .study import Study
from .tabulation import Record

TeamGame = tuple[str, str, int]
"""Strategies of all pursuers and of all evaders, and the seed of a game."""


def game_study(
    settings: GameSettings,
    pursuers: Sequence[str],
    evaders: Sequence[str],
    seeds: Sequence[int],
) -> Study[TeamGame]:
    """Return the study of a game with teams of strategies and many seeds.

    Args:
        settings: Settings of every game; the seed is ignored.
        pursuers: Strategy of all pursuers; empty for those of the settings.
        evaders: Strategy of all evaders; empty for those of the settings.
        seeds: Seeds of the games of each pairing of teams.
    """
    own = fingerprint_of(settings)
    return Study(
        "games",
        CaseGrid(pursuers, evaders, seeds),
        partial(play_case, settings),
        lambda case: f"{own}/{'/'.join(map(str, case))}",
    )


def fingerprint_of(settings: GameSettings) -> str:
    """Return a fingerprint of the settings of a game without its seed.

    The content of strategy files is included, that of their imports is not.
    """
    entries = json_settings(replace(settings, seed=0))
    text = json.dumps(entries, sort_keys=True)
    for player in settings.players:
        named = player.strategy
        file = file_of(named) if isinstance(named, str) else None
        if file is not None and file.is_file():
            text += file.read_bytes().hex()
    return sha256(text.encode()).hexdigest()[:12]


def with_team(settings: GameSettings, role: Role, name: str) -> GameSettings:
    """Return the settings with one strategy for all players of a role.

    Args:
        settings: Settings of a game.
        role: The role.
        name: Name of the strategy; empty for those of the settings.
    """
    players = tuple(
        replace(own, strategy=name or own.strategy)
        if own.decides and own.role == role
        else own
        for own in settings.players
    )
    return replace(settings, players=players)


def play_case(settings: GameSettings, case: TeamGame) -> Record:
    """Play one game and return its record.

    Raises:
        KeyboardInterrupt: If the game was interrupted.
    """
    pursuers, evaders, seed = case
    began = perf_counter()
    played = with_team(settings, Role.PURSUER, pursuers)
    played = with_team(played, Role.EVADER, evaders)
    run = run_game(replace(played, seed=seed))
    if run.outcome is Outcome.INTERRUPTED:
        raise KeyboardInterrupt
    summary = run.summary
    return {
        "pursuers": pursuers,
        "evaders": evaders,
        "seed": seed,
        "outcome": run.outcome.value,
        "message": run.message,
        "duration_s": run.duration,
        "captured_at_s": summary.captured_at_s,
        "closest_m": _closest(run),
        "fallen": summary.fallen,
        "touched": summary.touched,
        "crowd": [asdict(each) for each in summary.crowd],
        "wall_s": round(perf_counter() - began, 3),
    }


def _closest(run: MatchRun) -> float | None:
    """Return the closest approach of opponents, in [m]; of any without."""
    opposed = {frozenset(pair) for pair in run.opponents}
    return min(
        (
            pair.closest_m
            for pair in run.summary.pairs
            if frozenset(pair.players) in opposed
        ),
        default=None,
    )


def game_rows(records: Iterable[Record]) -> list[dict[str, Any]]:
    """Summarise the games of each pairing of teams.

    Args:
        records: Records of :func:`play_case`.

    Returns:
        Numbers of games with their 95 % intervals, closest approaches in
        [m], and for each robot among people the measures of crowd
        navigation.
    """
    pairings: dict[tuple[str, str], list[Record]] = {}
    for record in records:
        key = record["pursuers"], record["evaders"]
        pairings.setdefault(key, []).append(record)
    return [
        _row(pursuers, evaders, each)
        for (pursuers, evaders), each in pairings.items()
    ]


def _row(pursuers: str, evaders: str, games: list[Record]) -> dict[str, Any]:
    closest = [g["closest_m"] for g in games if g["closest_m"] is not None]
    among: dict[str, list[Record]] = {}
    for game in games:
        for each in game["crowd"]:
            among.setdefault(each["name"], []).append(each)
    return {
        "pursuers": pursuers,
        "evaders": evaders,
        "games": len(games),
        "captured": proportion(g["captured_at_s"] is not None for g in games),
        "contact": proportion(g["outcome"] == "contact" for g in games),
        "fell": proportion(bool(g["fallen"]) for g in games),
        "mean_closest_m": float(np.mean(closest)) if closest else None,
        "least_closest_m": min(closest, default=None),
        "crowd": [
            crowd_row(name, each, [g["duration_s"] for g in games])
            for name, each in among.items()
        ],
    }


def crowd_row(
    name: str, results: list[Record], durations: list[float]
) -> dict[str, Any]:
    """Summarise one robot among people, as crowd navigation does.

    Args:
        name: Name of the robot.
        results: Its results in each game.
        durations: Duration of each game, in [s].
    """
    times = [r["time_s"] for r in results if r["success"] and r["time_s"]]
    total = max(sum(durations), 1e-9)
    return {
        "name": name,
        "people": results[0]["people"],
        "success": proportion(r["success"] for r in results),
        "collided": proportion(r["collisions"] > 0 for r in results),
        "mean_time_s": float(np.mean(times)) if times else None,
        **{
            f"share_{limit}": sum(r[f"{limit}_m_s"] for r in results) / total
            for limit in ("below_0_45", "below_1_2")
        },
    }
