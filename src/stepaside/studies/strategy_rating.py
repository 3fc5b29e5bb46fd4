"""Rating of strategies against a fixed suite of opponents and worlds."""

from collections.abc import Sequence
from dataclasses import replace
from functools import partial
from math import sqrt
from typing import Any

import numpy as np

from ..arena import Room, RoomRecipe, draw_any_start
from ..core.errors import ConfigurationError
from ..planning import Direction
from ..strategies import load_strategy
from ..strategies.strategy_game import StepGame
from ..strategies.table_cache import pursuit_bound
from .case_grid import CaseGrid
from .study import Study
from .tabulation import Record, half_interval, wilson_interval
from .tournament_record import CELLS, play_record
from .tournament_settings import TournamentSettings
from .tournament_strategies import ALPHA, ASIDE

ROLES = ("evader", "pursuer")
OPPONENTS = {
    "evader": ("pursuit", "pursuit(gain=2)", "sharp", "lead"),
    "pursuer": (ASIDE, ALPHA, "optimal"),
}
"""Opponents of each role."""
ANY_HEADING = "any heading"
WORLDS: dict[str, RoomRecipe | None] = {
    "open floor": RoomRecipe(None, None),
    ANY_HEADING: None,
    "3 x 3 m": RoomRecipe(),
    "3 x 3 m, 3 discs": RoomRecipe(discs=3),
}
"""Rooms of the suite; "any heading" is an open floor, too."""
THE_PAPERS = "pursuit"  # the pursuer that the bound holds against
EARLIEST_CAPTURE = 0.02  # with any heading capture ends no game, in [m]

RatedGame = tuple[tuple[str, str, str], int]
"""Strategy, opponent and world; and the seed."""


def role_of(name: str, role: str | None = None) -> str:
    """Return the role in which a strategy is rated.

    Args:
        name: Name of a strategy, or a file.
        role: The role, if its direction does not decide.

    Raises:
        ConfigurationError: If there is no such strategy of that role.
    """
    if role is not None and role not in ROLES:
        raise ConfigurationError(
            f"role must be one of {', '.join(ROLES)}, got {role!r:.40}"
        )
    loaded = load_strategy(name)
    if role is not None:
        return role
    backward = loaded.direction is Direction.BACKWARD
    return "evader" if backward else "pursuer"


def rating_study(
    strategies: Sequence[tuple[str, str]],
    games: int,
    duration: float,
    worlds: Sequence[str] = tuple(WORLDS),
) -> Study[RatedGame]:
    """Return the study of all games of a rating.

    Args:
        strategies: Name and role of each strategy.
        games: Number of games of a strategy with each opponent and world.
        duration: Duration of a game, in [s].
        worlds: Names of :data:`WORLDS`.
    """
    pursuit_bound(CELLS)  # solved once here, not in each worker
    trials = [
        (name, opponent, world)
        for name, role in strategies
        for world in worlds
        for opponent in OPPONENTS[role]
    ]
    roles = dict(strategies)
    return Study(
        "rate",
        CaseGrid(trials, range(games)),
        partial(_play, roles, duration),
        lambda case: "/".join(map(str, (duration, *case[0], case[1]))),
    )


def _play(
    roles: dict[str, str],
    duration: float,
    case: RatedGame,
) -> Record:
    """Play one game and return its record."""
    (name, opponent, world), seed = case
    game, room = StepGame(duration=duration), WORLDS[world]
    arena: Room | RoomRecipe
    if room is None:
        game = replace(game, capture=EARLIEST_CAPTURE)
        arena = Room(starts=draw_any_start(seed))
    else:
        arena = room
    role = roles[name]
    pairing = (name, opponent) if role == "evader" else (opponent, name)
    settings = TournamentSettings("steps", arena, game)
    return play_record(settings, pairing, seed) | {
        "strategy": name,
        "opponent": opponent,
        "world": world,
        "role": role,
    }


def rating_rows(records: Sequence[Record]) -> list[dict[str, Any]]:
    """Tabulate the records of a rating by strategy, world and opponent.

    Contact with an obstacle counts as a closest approach of zero. The regret
    is the bound less the closest approach, against the pursuer of the paper
    only: it is the pursuer that the bound holds against.

    Args:
        records: Records of a :func:`rating_study`.
    """
    groups: dict[tuple[str, str, str], list[Record]] = {}
    for record in records:
        key = record["strategy"], record["world"], record["opponent"]
        groups.setdefault(key, []).append(record)
    return [_row(*key, group) for key, group in groups.items()]


def _row(
    name: str, world: str, opponent: str, records: Sequence[Record]
) -> dict[str, Any]:
    survived = sum(r["outcome"] == "survived" for r in records)
    low, high = wilson_interval(survived, len(records))
    closest, bound = closest_and_bound(records)
    row = {
        "strategy": name,
        "role": records[0]["role"],
        "world": world,
        "opponent": opponent,
        "games": len(records),
        "survived": survived / len(records),
        "survived_low": low,
        "survived_high": high,
        "mean_closest_m": float(closest.mean()),
        "mean_closest_pm_m": half_interval(closest),
        "mean_regret_m": None,
        "mean_regret_pm_m": None,
        "mean_ratio": None,
        "mean_ratio_pm": None,
    }
    if records[0]["role"] == "evader" and opponent == THE_PAPERS:
        regret, ratio = bound - closest, closest / bound
        row |= {
            "mean_regret_m": float(regret.mean()),
            "mean_regret_pm_m": half_interval(regret),
            "mean_ratio": float(ratio.mean()),
            "mean_ratio_pm": half_interval(ratio),
        }
    return row


def score_rows(rows: Sequence[dict[str, Any]]) -> list[dict[str, Any]]:
    """Return one row for each strategy, the best of a role first.

    The score of an evader is the mean closest approach over worlds and
    opponents, that of a pursuer is its negative.

    Args:
        rows: Rows of :func:`rating_rows`.
    """
    found = []
    for name in dict.fromkeys(row["strategy"] for row in rows):
        own = [row for row in rows if row["strategy"] == name]
        sign = 1.0 if own[0]["role"] == "evader" else -1.0
        spread = sqrt(sum(r["mean_closest_pm_m"] ** 2 for r in own))
        regrets = [r for r in own if r["mean_regret_m"] is not None]
        found.append(
            {
                "strategy": name,
                "role": own[0]["role"],
                "score_m": sign
                * float(np.mean([row["mean_closest_m"] for row in own])),
                "score_pm_m": spread / len(own),
                "survived": mean_of(own, "survived"),
                "mean_regret_m": mean_of(regrets, "mean_regret_m"),
            }
        )
    return sorted(found, key=lambda row: (row["role"], -row["score_m"]))


def mean_of(rows: Sequence[dict[str, Any]], name: str) -> float | None:
    """Return the mean of a column; None without rows."""
    return float(np.mean([row[name] for row in rows])) if rows else None


def closest_and_bound(records: Sequence[Record]) -> tuple[Any, Any]:
    """Return closest approaches and bounds of games, in [m]."""
    closest = np.array(
        [0.0 if r["outcome"] == "touched" else r["closest_m"] for r in records]
    )
    return closest, np.array([r["bound_m"] for r in records])
