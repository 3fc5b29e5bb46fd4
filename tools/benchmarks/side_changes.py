"""Classify the outcomes of games of unequal unicycles, for docs/unicycles.md.

Random games from random initial poses: the fractions that settle on a circle,
are captured, change sides forever, or diverge::

    python tools/benchmarks/side_changes.py
"""

from collections import Counter
from dataclasses import dataclass
from typing import Any

import numpy as np
from benchmark_options import ask

from stepaside.studies.result_files import header, write_result
from stepaside.theory.unicycle.batch import play_games
from stepaside.theory.unicycle.circles import circles_of
from stepaside.theory.unicycle.start_maps import random_starts
from stepaside.theory.unicycle.unicycle_game import Game, TurningLaw, make_game

SPREAD = 0.9  # logarithm of the largest speed and gain ratio
ANGLES = 0.05, 3.0  # [rad]
PLAYED, STEP = 400.0, 0.04  # duration of a game and its step, in 1/k
SETTLING = 12.0  # minimum duration in time constants of a stable circle
WINDOW, WINDOWS = 1.37, 60  # duration in 1/k, and number
POINT = 1e-6  # capture distance, in units of the evader's speed over k
NEAR = 0.1  # closest approach that is counted, in the same unit
FAR = 20.0  # distance beyond which the evader has escaped, in the same unit


@dataclass(frozen=True, slots=True)
class End:
    """Outcome of one game.

    Attributes:
        outcome: "settled", "captured", "changes sides", "escaped", or
            "other".
        closest: Minimum distance over the windows, in units of v_e / k.
        farthest: Maximum distance over the windows, in the same unit.
    """

    outcome: str
    closest: float = 0.0
    farthest: float = 0.0


def main() -> None:
    """Simulate the same random games under both laws."""
    parser = ask(__doc__, "side-changes.json")
    parser.add_argument("--games", type=int, default=300)
    parser.add_argument("--starts", type=int, default=5, help="of each game")
    parser.add_argument("--seed", type=int, default=0)
    asked = parser.parse_args()
    ends: dict[tuple[str, str, bool], list[End]] = {}
    counts: Counter[tuple[str, str, bool]] = Counter()
    for law in TurningLaw:
        rng = np.random.default_rng(asked.seed)
        for number in range(asked.games):
            vp, ve, kp, ke = np.exp(rng.uniform(-SPREAD, SPREAD, 4)).tolist()
            angle = float(rng.uniform(*ANGLES))
            game = make_game(vp, ve, kp, ke, angle, law)
            faster = game.pursuer.speed > game.evader.speed
            held = any(circle.stable for circle in circles_of(game))
            key = (law.value, "faster" if faster else "slower", held)
            starts = random_starts(game, asked.starts, seed=number)
            ends.setdefault(key, []).extend(play(game, starts))
            counts[key] += 1
    settings = {
        "games": asked.games,
        "starts_each": asked.starts,
        "seed": asked.seed,
        "log_spread": SPREAD,
        "angles_rad": ANGLES,
        "played_per_k": PLAYED,
        "played_time_constants": SETTLING,
        "watched_per_k": WINDOW * WINDOWS,
        "capture_units": POINT,
        "near_units": NEAR,
        "far_units": FAR,
    }
    head = header(settings)
    rows = [row_of(key, counts[key], ends[key]) for key in sorted(ends)]
    write_result(asked.output, head, rows=rows)


def play(game: Game, starts: np.ndarray) -> list[End]:
    """Simulate a game from many starts; sample it in each of many windows.

    A game that has not settled changes sides if its side differs between the
    ends of the windows. Distances are those of the windows.
    """
    slow = min(game.pursuer.gain, game.evader.gain)
    fast = max(game.pursuer.gain, game.evader.gain)
    unit = game.evader.speed / slow
    how: dict[str, Any] = {
        "step": STEP / fast,
        "capture_distance": POINT * unit,
    }
    waits = [c.time_constant_s for c in circles_of(game) if c.stable]
    duration = max(PLAYED / slow, SETTLING * max(waits, default=0.0))
    out = play_games(game, starts, duration, **how)
    captured, settled = out.captured, out.circle >= 0
    open_ = ~(captured | settled)
    seen = []
    if open_.any():
        for _ in range(WINDOWS):
            out = play_games(game, out.states, WINDOW / slow, **how)
            seen.append(
                (out.sides, out.closest_distance / unit, out.states[:, 0])
            )
    ends = []
    for i in range(len(starts)):
        if captured[i]:
            ends.append(End("captured"))
        elif settled[i]:
            ends.append(End("settled"))
        else:
            sides = {int(side[i]) for side, _, _ in seen}
            near = min(float(closest[i]) for _, closest, _ in seen)
            far = max(float(away[i]) for _, _, away in seen) / unit
            outcome = "changes sides" if len(sides) == 2 else "other"
            ends.append(End("escaped" if near > FAR else outcome, near, far))
    return ends


def row_of(
    key: tuple[str, str, bool], games: int, ends: list[End]
) -> dict[str, Any]:
    """Return the fractions of outcomes of one kind of game."""
    law, pursuer, held = key
    counts = Counter(end.outcome for end in ends)
    changing = [end for end in ends if end.outcome == "changes sides"]
    near = [end.closest for end in changing]
    far = [end.farthest for end in changing]
    row: dict[str, Any] = {
        "law": law,
        "pursuer": pursuer,
        "stable_circle": held,
        "games": games,
        "starts": len(ends),
        "settled": counts["settled"],
        "captured": counts["captured"],
        "changes_sides": counts["changes sides"],
        "escaped": counts["escaped"],
        "other": counts["other"],
    }
    if changing:
        row["closest_median_units"] = float(np.median(near))
        row["closest_least_units"] = min(near)
        row["near"] = sum(one < NEAR for one in near)
        row["farthest_median_units"] = float(np.median(far))
        row["farthest_largest_units"] = max(far)
    return row


if __name__ == "__main__":
    main()
