"""Captions: the state of a recorded game at a sample, in words."""

from math import hypot

from ..strategies.approach import Approach
from .approach_forecast import describe_motion, estimate_approach
from .run import (
    DuelRun,
    MatchRun,
    PlayRun,
    Run,
    WalkRun,
    is_duel,
    is_match,
    is_play,
    is_walk,
)


def describe_state(run: Run, index: int) -> str:
    """Describe the state of a game at a sample."""
    if run.has_ended_at(index):
        return run.message
    if is_play(run):
        return _describe_play(run, index)
    if is_match(run):
        return _describe_match(run, index)
    if is_walk(run) and len(run.tracks) == 1:
        return _describe_walk(run, index)
    pushed = run.pushed_at(float(run.times[index]))
    if pushed and is_duel(run):
        return f"the {' and the '.join(pushed)} is pushed"
    if pushed:
        return f"{' and '.join(pushed)} is pushed"
    if is_duel(run):
        return _describe_duel(run, index)
    return f"{' and '.join(run.players)} in motion"


def _describe_match(run: MatchRun, index: int) -> str:
    """Describe the nearest pair of opponents, or of any players."""
    if not run.opponents:
        return f"{' and '.join(run.players)} in motion"
    apart = {
        pair: hypot(
            *(
                run.tracks[pair[0]].unicycle[index, :2]
                - run.tracks[pair[1]].unicycle[index, :2]
            ).tolist()
        )
        for pair in run.opponents
    }
    (one, other), least = min(apart.items(), key=lambda item: item[1])
    return f"nearest: {one} and {other}, {least:.2f} m"


def _describe_duel(run: DuelRun, index: int) -> str:
    time = float(run.times[index])
    triggered = run.summary.triggered_at_s
    converged = run.summary.converged_at_s
    if triggered is None or time < triggered:
        moves = describe_motion(_approach_at(run, index))
        return f"the pursuer {moves}; the evader stands"
    if time < triggered + 1.0:
        return "the evader is triggered"
    if converged is not None and time >= converged:
        return f"{run.settings.both} are on the circle"
    return "the evader is evading"


def _approach_at(run: DuelRun, index: int) -> Approach | None:
    """Return the approach over the gait cycle before a sample."""
    if len(run.times) < 2:
        return None
    # Before one cycle has passed, use the first complete cycle.
    last = max(index, run.index_at(run.times[0] + run.settings.cycle))
    first = run.index_at(run.times[last] - run.settings.cycle)
    offsets = [
        run.pursuer.unicycle[i, :2] - run.evader.unicycle[i, :2]
        for i in (first, last)
    ]
    (x, y), (now_x, now_y) = (offset.tolist() for offset in offsets)
    elapsed = float(run.times[last] - run.times[first])
    return estimate_approach((x, y), (now_x, now_y), elapsed)


def _describe_walk(run: WalkRun, index: int) -> str:
    time = float(run.times[index])
    if run.pushed_at(time):
        return "the robot is pushed"
    first_lift_off = time_of_first_lift_off(run)
    if first_lift_off is None or time < first_lift_off:
        return "the robot stands"
    return "the robot walks"


def time_of_first_lift_off(run: WalkRun) -> float | None:
    """Return when a foot first leaves the floor, in [s]; None if none does."""
    landings = run.walker.landings
    if landings is None or not len(landings):
        return None
    return float(landings[0, 0]) - run.settings.gait.single_support


def _describe_play(run: PlayRun, index: int) -> str:
    time = float(run.times[index]) + 1e-9
    text = "no state recorded yet"
    for change in run.summary.changes:
        if change.time_s <= time:
            text = f"{change.state} ({change.reason})"
    return text
