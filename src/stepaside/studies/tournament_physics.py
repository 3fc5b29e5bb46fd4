"""Tournament games in physics, as duels of two humanoids."""

from dataclasses import replace
from math import isfinite
from typing import Any

import numpy as np

from ..arena import ObstacleSet, Room
from ..control.clearance.map_settings import MapSettings
from ..core.convex import grown_hull_area
from ..core.poses import Array, Pose, wrap_angles
from ..games.duel_settings import PLAYERS, DuelSettings
from ..games.outcome import Outcome
from ..games.run import DuelRun
from ..games.trajectory import Trajectory
from ..robots.description import load_robot
from ..sim.camera_settings import SceneSettings
from ..sim.outline_measurement import measure_outline
from ..strategies import Evasion, load_strategy
from .tournament_strategies import SIGHT

SEEN = "seen"


def duel_settings(
    pairing: tuple[str, str],
    room: Room,
    starts: tuple[Pose, Pose],
    *,
    seed: int,
    duration: float,
    source: str,
) -> DuelSettings:
    """Return the settings of a duel between two entrants.

    Args:
        pairing: Names of an evader and of a pursuer.
        room: Room of the game.
        starts: Initial poses of pursuer and evader in the world.
        seed: Seed of the duel.
        duration: Duration of the game, in [s].
        source: Source of their map; "seen" implies cameras.
    """
    evader, pursuer = pairing
    played = load_strategy(evader)
    paper = played if isinstance(played, Evasion) else None
    return DuelSettings(
        seed=seed,
        duration=duration,
        strategy=paper or Evasion(),
        evader_strategy="evasion" if paper else evader,
        pursuer_strategy=pursuer,
        sensing="cameras" if source == SEEN else "ideal",
        room=SceneSettings(plan=replace(room, starts=starts)),
        map=MapSettings(source=source),
    )


def record_values_of(run: DuelRun, radius: float) -> dict[str, Any]:
    """Return the record values of a duel as a tournament game.

    Args:
        run: Duel in a room.
        radius: Body radius for the floor that is used, in [m].

    Returns:
        Values in SI units: ``survived_s`` ends with capture or contact,
        ``contact`` is whether the bodies of the two players touched,
        ``touched`` names the bodies in contact, ``PLAYER_clearance_m`` is
        the least distance of a trunk from resting obstacles, and
        ``decision_s`` is the time of a whole replan.
    """
    summary = run.summary
    pursuer, evader = (run.tracks[name].unicycle for name in PLAYERS)
    aims = pursuer[:, :2] - evader[:, :2]
    bearings = np.arctan2(aims[:, 1], aims[:, 0]) - evader[:, 2]
    seconds = max(run.duration, 1e-9)
    return {
        "outcome": outcome_of(run).value,
        "contact": players_touched(run),
        "touched": list(summary.touched),
        "survived_s": run.duration
        if summary.captured_at_s is None
        else summary.captured_at_s,
        "closest_m": summary.min_distance_m,
        "floor_m2": grown_hull_area(evader[:, :2], radius),
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


def outcome_of(run: DuelRun) -> Outcome:
    """Return the outcome of a duel as that of a tournament game.

    It is captured if the distance was at most the capture distance at any
    time; a contact with an obstacle is told apart from one of the players.
    """
    if run.summary.captured_at_s is not None:
        return Outcome.CAPTURED
    if run.outcome is Outcome.CONTACT and not players_touched(run):
        return Outcome.TOUCHED
    return run.outcome


def clearance(run: DuelRun, name: str) -> float | None:
    """Return the least distance of a trunk from resting obstacles.

    Args:
        run: Duel in a room.
        name: Name of the player.

    Returns:
        Distance, in [m]; None without resting obstacles.
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
    """Return the corners of a trunk at all samples. Shape (n, corners, 2)."""
    positions = track.com[:, :2].tolist()
    headings = track.torso[:, 2].tolist()
    corners: Array = np.array(
        [
            Pose(x, y, heading).transform_points(trunk)
            for (x, y), heading in zip(positions, headings, strict=True)
        ]
    )
    return corners
