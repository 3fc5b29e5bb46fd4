"""Captions: the state of a recorded game at a sample, in words."""

import numpy as np

from .outcome import Outcome
from .player_settings import WALKER
from .run import Run

LEAST = 0.01  # closing speed below which a distance is constant, in [m/s]


def describe_state(run: Run, index: int) -> str:
    """Describe the state of a game at a sample."""
    complete = run.outcome in (Outcome.COMPLETED, Outcome.INTERRUPTED)
    if index >= len(run.times) - 1 and not complete:
        return run.message
    time = float(run.times[index])
    if run.summary.play is not None:
        changes = run.summary.play.changes
        past = [c for c in changes if c.time_s <= time + 1e-9]
        words = [f"{c.state} ({c.reason})" for c in past[-1:]]
        return "".join(words) or "no state recorded yet"
    pushed = _pushed_at(run, time)
    if run.game == "walk":
        return _describe_walk(run, time, bool(pushed))
    if run.game == "duel":
        if pushed:
            return f"the {' and the '.join(pushed)} is pushed"
        return _describe_duel(run, index)
    if not run.opponents:
        return f"{' and '.join(run.players)} in motion"
    at = {
        name: track.unicycle[index, :2] for name, track in run.tracks.items()
    }
    apart = [(np.hypot(*(at[a] - at[b])), a, b) for a, b in run.opponents]
    least, one, other = min(apart)
    return f"nearest: {one} and {other}, {least:.2f} m"


def _pushed_at(run: Run, time: float) -> list[str]:
    """Return the players pushed in the last second before a time [s]."""
    since = {
        name: time - track.pushes[:, 0]
        for name, track in run.tracks.items()
        if track.pushes is not None
    }
    return [n for n, s in since.items() if ((s >= 0.0) & (s < 1.0)).any()]


def _describe_duel(run: Run, index: int) -> str:
    time, summary = float(run.times[index]), run.summary
    triggered, converged = summary.triggered_at_s, summary.converged_at_s
    if triggered is None or time < triggered:
        moves = _motion_of_pursuer(run, index)
        return f"the pursuer {moves}; the evader stands"
    if time < triggered + 1.0:
        return "the evader is triggered"
    if converged is not None and time >= converged:
        return f"{' and '.join(run.players)} are on the circle"
    return "the evader is evading"


def _motion_of_pursuer(run: Run, index: int) -> str:
    """Return "approaches", "moves away" or "walks" for a pursuer.

    It is told from the distances over the gait cycle before a sample; before
    one cycle has passed, over the first.
    """
    cycle = run.settings.cycle
    last = max(index, run.index_at(run.times[0] + cycle))
    first = run.index_at(run.times[last] - cycle)
    approach = run.distance[first] - run.distance[last]
    least = LEAST * (run.times[last] - run.times[first])
    if abs(approach) <= least:
        return "walks"
    return "approaches" if approach > 0.0 else "moves away"


def _describe_walk(run: Run, time: float, pushed: bool) -> str:
    if pushed:
        return "the robot is pushed"
    landings = run.tracks[WALKER].landings
    if landings is None or not len(landings):
        return "the robot stands"
    lift_off = landings[0, 0] - run.settings.gait.single_support
    return "the robot stands" if time < lift_off else "the robot walks"
