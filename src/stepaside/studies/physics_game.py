"""A game of a tournament in physics: humanoids that walk and fall."""

from collections.abc import Callable, Mapping
from dataclasses import replace
from math import isfinite
from typing import Any, NamedTuple

import numpy as np

from ..arena import ObstacleSet, Room
from ..control.clearance.map_settings import MapSettings
from ..core.poses import Array, Pose, wrap_angles
from ..games.duel_run import DuelRun
from ..games.duel_settings import PLAYERS, DuelSettings
from ..games.outcome import Outcome
from ..games.trajectory import Trajectory
from ..robots.description import load_robot
from ..sim.camera_settings import SceneSettings
from ..sim.outline_measurement import measure_outline
from ..strategies import Evasion
from .entrants import ALWAYS, SIGHT, pursuer_strategy
from .floor_used import floor_used

SEEN = "seen"
PAPER: Mapping[str, Callable[[float], Evasion]] = {
    "aside": lambda angle: Evasion(safety_radius=ALWAYS),
    "saturated": lambda angle: Evasion(saturated=True, safety_radius=ALWAYS),
    "alpha": lambda angle: Evasion(angle, safety_radius=ALWAYS),
}
"""Evaders of the paper, as a duel knows them, given the angle of "alpha"."""
OUTCOMES = {Outcome.COMPLETED: "survived", Outcome.FALL: "fell"}


def duel_settings(
    pairing: tuple[str, str],
    room: Room,
    starts: tuple[Pose, Pose],
    *,
    seed: int,
    duration: float,
    angle: float,
    source: str,
) -> DuelSettings:
    """The duel in which two entrants of a tournament meet.

    Args:
        pairing: Names of an evader and of a pursuer.
        room: Where they play.
        starts: Where pursuer and evader stand at first.
        seed: Of what is drawn in the duel.
        duration: Of the game, as its clock goes, in [s].
        angle: Strategy alpha of the evader "alpha", in [rad].
        source: Map that they have; with one that is seen, they see with
            cameras.
    """
    evader, pursuer = pairing
    own = PAPER.get(evader)
    return DuelSettings(
        seed=seed,
        duration=duration,
        strategy=Evasion(safety_radius=ALWAYS) if own is None else own(angle),
        evader_strategy=evader if own is None else "evasion",
        pursuer_strategy=pursuer_strategy(pursuer),
        sensing="cameras" if source == SEEN else "ideal",
        room=SceneSettings(plan=replace(room, starts=starts)),
        map=MapSettings(source=source),
    )


class DuelPaths(NamedTuple):
    """Where two humanoids went.

    Attributes:
        outcome: How it ended, see :func:`outcome_of`.
        pursuer: Poses (x [m], y [m], theta [rad]). Shape (n, 3).
        evader: Poses of the evader, likewise.
    """

    outcome: str
    pursuer: Array
    evader: Array


def ways_of(run: DuelRun) -> DuelPaths:
    """Where the players of a duel went."""
    pursuer, evader = (run.tracks[name].unicycle for name in PLAYERS)
    return DuelPaths(outcome_of(run), pursuer, evader)


def figures_of(run: DuelRun, radius: float) -> dict[str, Any]:
    """Figures of a duel in a room, as of a game of a tournament.

    Args:
        run: The duel.
        radius: Of the body that needs floor, in [m].

    Returns:
        Figures in SI units; ``survived_s`` ends with capture or contact,
        ``contact`` says whether the bodies of the two players touched,
        ``touched`` names who and what met,
        ``PLAYER_clearance_m`` is the least distance of a trunk from what
        rests, and a decision is all that a replan takes.
    """
    summary = run.summary
    outcome, pursuer, evader = ways_of(run)
    aims = pursuer[:, :2] - evader[:, :2]
    bearings = np.arctan2(aims[:, 1], aims[:, 0]) - evader[:, 2]
    seconds = max(run.duration, 1e-9)
    return {
        "outcome": outcome,
        "contact": players_touched(run),
        "touched": list(summary.touched),
        "survived_s": run.duration
        if summary.captured_at_s is None
        else summary.captured_at_s,
        "closest_m": summary.min_distance_m,
        "floor_m2": floor_used(evader[:, :2], radius),
        "walked_m": float(np.hypot(*np.diff(evader[:, :2], axis=0).T).sum()),
        "turning_rad_s": float(np.abs(np.diff(evader[:, 2])).sum()) / seconds,
        "unseen": float((np.abs(wrap_angles(bearings)) > SIGHT).mean()),
        "decision_s": 1e-6 * (summary.plan_time_us.median or 0.0),
        "longest_decision_s": 1e-6 * (summary.plan_time_us.p99 or 0.0),
        **{f"{name}_clearance_m": clearance(run, name) for name in PLAYERS},
    }


def players_touched(run: DuelRun) -> bool:
    """Return whether a duel ended with contact between its two players."""
    contact = run.outcome is Outcome.CONTACT
    return contact and set(run.summary.touched) == set(PLAYERS)


def outcome_of(run: DuelRun) -> str:
    """How a duel ended, in the words of a tournament.

    Returns:
        "captured" if the distance ever was at most the capture distance,
        whatever came after; else "survived", "contact" between the players,
        "touched" for contact with an obstacle, "fell", or what a duel calls
        it.
    """
    if run.summary.captured_at_s is not None:
        return "captured"
    if run.outcome is Outcome.CONTACT:
        return "contact" if players_touched(run) else "touched"
    return OUTCOMES.get(run.outcome) or str(run.outcome.value)


def clearance(run: DuelRun, name: str) -> float | None:
    """Least distance of a trunk from all that rests, by the record.

    Args:
        run: A duel in a room.
        name: Whose trunk.

    Returns:
        Distance, in [m]; None where nothing rests.
    """
    settings, track = run.settings, run.tracks[name]
    if settings.room.plan is None:
        return None
    solids = ObstacleSet(settings.room.plan.solids)
    outline = measure_outline(load_robot(settings.robot), settings.gait)
    found = float(
        solids.swept_clearances(_corners(outline.trunk, track)).min()
    )
    return found if isfinite(found) else None


def _corners(trunk: Array, track: Trajectory) -> Array:
    """Corners of a trunk at all samples. Shape (n, corners, 2)."""
    places, headings = track.com[:, :2].tolist(), track.torso[:, 2].tolist()
    found: Array = np.array(
        [
            Pose(x, y, heading).transform_points(trunk)
            for (x, y), heading in zip(places, headings, strict=True)
        ]
    )
    return found
