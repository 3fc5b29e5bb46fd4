"""Evaluation of a recorded game: its summary.

A walk is evaluated in the frame of the support foot, as odometry drifts from
the world by slip.
"""

from collections.abc import Sequence
from dataclasses import replace
from itertools import combinations
from math import degrees, isfinite
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from ..core.constants import CAPTURE_DISTANCE
from ..core.poses import Array
from ..sim.crowd_motion import RADIUS
from ..theory.unicycle.circles import fit_circle
from .duel_circle import (
    angle_between,
    cycle_mean,
    distance_between,
    last_third,
)
from .game import GameInPlay
from .outcome import Outcome
from .player_settings import WALKER
from .run import Run
from .summary import (
    CrowdSummary,
    ErrorStatistics,
    PairSummary,
    PlanningSummary,
    PlayerSummary,
    SolverSummary,
    Summary,
    WalkingSummary,
)
from .trajectory import Trajectory

if TYPE_CHECKING:
    from ..locomotion.zmp.mpc import MpcResult
    from .camera_senses import SightObserver

MIN_TURN = 0.5  # of a path to which a circle can be fitted, in [rad]
INTRUSIONS = (0.45, 1.2)  # of crowd navigation: intimate and personal, [m]


def measure(run: Run, late: NDArray[np.bool_] | None = None) -> Summary:
    """Return the part of a summary that trajectories give.

    Args:
        run: The run; its summary is not used.
        late: Samples of means and circles; those of the last third by
            default. Shape (n,).
    """
    late = last_third(run.times) if late is None else late
    pairs = {
        (one, other): _pair(run, one, other, late)
        for one, other in combinations(run.players, 2)
    }
    facing = {frozenset(names) for names in run.opponents}
    closest = [p.closest_m for n, p in pairs.items() if frozenset(n) in facing]
    times = (pair.captured_at_s for pair in pairs.values())
    return Summary(
        distance_m=_mean(run.distance[late]),
        relative_orientation_deg=_mean(run.orientation[late]),
        min_distance_m=min(closest, default=None),
        captured_at_s=min((t for t in times if t is not None), default=None),
        players={name: _player(run, name, late) for name in run.players},
        pairs={" - ".join(names): pair for names, pair in pairs.items()},
    )


def _mean(values: Array) -> float | None:
    mean = float(values.mean()) if len(values) else np.nan
    return mean if isfinite(mean) else None


def _pair(
    run: Run, one: str, other: str, late: NDArray[np.bool_]
) -> PairSummary:
    first, second = run.tracks[one], run.tracks[other]
    apart = distance_between(first.torso, second.torso)
    closest, ids = int(apart.argmin()), run.identities
    opposed = one in ids and other in ids and ids[one].opposes(ids[other])
    caught = np.flatnonzero(opposed & (apart <= CAPTURE_DISTANCE))
    last = first.unicycle[late], second.unicycle[late]
    return PairSummary(
        closest_m=float(apart[closest]),
        closest_at_s=float(run.times[closest]),
        captured_at_s=float(run.times[caught[0]]) if len(caught) else None,
        distance_m=_mean(distance_between(*last)),
        angle_deg=_mean(np.degrees(angle_between(*last))),
    )


def _player(run: Run, name: str, late: NDArray[np.bool_]) -> PlayerSummary:
    poses, times, radius = run.tracks[name].unicycle, run.times, None
    path = [poses[:, 0], poses[:, 1]]
    if run.tracks[name].qpos is not None or run.game == "play":
        path = [cycle_mean(way, times, run.settings.cycle) for way in path]
    if late.sum() > 2 and np.ptp(poses[late, 2]) > MIN_TURN:
        radius = fit_circle(poses[late, :2])[1]
    return PlayerSummary(
        path_m=float(np.hypot(*np.diff(path, axis=1)).sum()),
        radius_m=radius if radius is not None and isfinite(radius) else None,
    )


def summarise(
    run: Run,
    game: GameInPlay,
    planning: PlanningSummary | None,
    sight: "SightObserver | None",
) -> Summary:
    """Compute the summary of a game that was played.

    Args:
        run: The run; its summary is not used.
        game: The game.
        planning: Plans of all robots in physics.
        sight: Evaluation of perception.
    """
    summary = measure(run)
    players = {
        name: replace(own, goal_at_s=game.goals_at.get(name))
        for name, own in summary.players.items()
    }
    if run.game == "game":
        people = [p for p in run.settings.players if p.body == "person"]
        for own in run.settings.players:
            if own.decides and people:
                crowd = _crowd(run, game, own, [p.name for p in people])
                players[own.name] = replace(players[own.name], crowd=crowd)
    together = None
    if sight is not None:
        together, by_robot = sight.report()
        for name, seen in by_robot.items():
            players[name] = replace(players[name], sight=seen)
    return replace(
        summary,
        real_time_factor=game.real_time_factor,
        touched=list(game.touched),
        fallen=list(game.fallen),
        players=players,
        planning=planning,
        sight=together,
    )


def _crowd(
    run: Run, game: GameInPlay, own: Any, people: list[str]
) -> CrowdSummary:
    """Measure the encounter of a robot with people."""
    poses, times = run.tracks[own.name].unicycle, run.times
    apart = np.array(
        [distance_between(poses, run.tracks[p].unicycle) for p in people]
    )
    if run.settings.level == "physics" and own.body == "robot":
        collisions = int(own.name in game.touched)
    else:
        touching = apart < own.radius + RADIUS
        begins = np.diff(touching.astype(int), axis=1, prepend=0) > 0
        collisions = int(np.count_nonzero(begins))
    nearest = apart.min(axis=0)
    period = float(times[1] - times[0]) if len(times) > 1 else 0.0
    intimate, personal = (
        period * int(np.count_nonzero(nearest < limit)) for limit in INTRUSIONS
    )
    completed = run.outcome is Outcome.COMPLETED
    reached = own.name in game.goals_at if own.goal else completed
    harmed = collisions or own.name in (*game.touched, *game.fallen)
    return CrowdSummary(
        people=len(people),
        success=reached and not harmed,
        collisions=collisions,
        intimate_s=intimate,
        personal_s=personal,
    )


WARM_UP = 3.0  # left out of the evaluation, in [s]
TRACKED = ("com_x", "com_y", "zmp_x", "zmp_y")  # in [m]
ESTIMATED = {
    **dict.fromkeys(("com_x", "com_y", "zmp_x", "zmp_y"), "m"),
    **dict.fromkeys(("velocity_x", "velocity_y"), "m_s"),
    **dict.fromkeys(("roll", "pitch"), "rad"),
}


def express_in_support_foot(
    times: Array, track: Trajectory
) -> dict[str, Array]:
    """Express a walk in the frame of the support foot.

    True quantities are in the frame of the true sole, references and
    estimates in that of the planned sole, unless their names say otherwise.
    References in the world are those of odometry, placed there at its start.

    Args:
        times: Times of the samples, in [s]. Shape (n,).
        track: Trajectory with foot states and estimates.

    Returns:
        Columns by name: ``time``, ``support``, ``single``, angles, and x and
        y of each other quantity, like ``com_x``. Shape (n,) each.

    Raises:
        ValueError: If the trajectory has no foot states.
    """
    sole, support, tilt = track.sole, track.support, track.tilt
    if sole is None or support is None or tilt is None:
        raise ValueError("the trajectory must have sole, support and tilt")
    com, planned = track.com[:, :2], support[:, 2:]
    estimate = track.estimate
    if estimate is None:
        estimate = np.full((len(times), 8), np.nan)
    pairs = {
        "com": _point(sole, com),
        "velocity": _vector(sole, track.velocity),
        "com_reference": _point(planned, track.com_reference),
        "zmp": _point(sole, track.zmp),
        "zmp_reference": _point(planned, track.zmp_reference),
        "estimated_com": _point(planned, estimate[:, 0:2]),
        "estimated_velocity": _vector(planned, estimate[:, 2:4]),
        "estimated_zmp": _point(planned, estimate[:, 4:6]),
        "com_in_world": com,
        "com_reference_in_world": track.com_reference,
        "foot_in_world": sole[:, :2],
    }
    found = {"time": times, "support": support[:, 0], "single": support[:, 1]}
    for name, points in pairs.items():
        assert points is not None
        found |= {f"{name}_x": points[:, 0], f"{name}_y": points[:, 1]}
    assert track.heading_reference is not None
    return found | {
        "roll": tilt[:, 0],
        "pitch": tilt[:, 1],
        "estimated_roll": estimate[:, 6],
        "estimated_pitch": estimate[:, 7],
        "heading": track.torso[:, 2],
        "heading_reference": track.heading_reference[:, 0],
    }


def _point(frames: Array, points: Array | None) -> Array:
    """Transform points from the world to frames. Shape (n, 2)."""
    assert points is not None
    return _vector(frames, points - frames[:, :2])


def _vector(frames: Array, vectors: Array | None) -> Array:
    """Rotate vectors from the world to frames. Shape (n, 2)."""
    assert vectors is not None
    c, s = np.cos(frames[:, 2]), np.sin(frames[:, 2])
    x, y = vectors[:, 0], vectors[:, 1]
    return np.column_stack([c * x + s * y, c * y - s * x])


def upright_samples(
    times: Array, outcome: Outcome | None
) -> NDArray[np.bool_]:
    """Return a mask of the evenly spaced samples of an upright robot.

    The last sample is at the end of the game, which may come between two
    periods or after a fall.
    """
    mask: NDArray[np.bool_] = np.ones(len(times), dtype=bool)
    if len(times) > 2:
        period = times[1] - times[0]
        mask[-1] = abs(times[-1] - times[-2] - period) < 0.1 * period
    if outcome in (Outcome.FALL, Outcome.CONTACT):
        mask[-1:] = False
    return mask


def summarise_walk(run: Run, solved: "Sequence[MpcResult]") -> WalkingSummary:
    """Compute the summary of a walk; with the results of its MPC, if any."""
    mask = upright_samples(run.times, run.outcome)
    in_foot = express_in_support_foot(run.times, run.tracks[WALKER])
    columns = {name: values[mask] for name, values in in_foot.items()}
    walking = measured(columns, run.settings.cycle)
    return replace(walking, solver=_solver(solved))


def measured(columns: dict[str, Array], cycle: float) -> WalkingSummary:
    """Return what columns of a walk give.

    Args:
        columns: Evenly spaced samples; see :func:`express_in_support_foot`.
        cycle: Duration of a gait cycle, in [s].
    """
    steady = columns["time"] >= WARM_UP
    a = {name: values[steady] for name, values in columns.items()}
    tilt = np.hypot(a["roll"], a["pitch"])
    speed, speed_ratio, yaw_rate, yaw_ratio = _pace(a, cycle)
    return WalkingSummary(
        speed_m_s=speed,
        speed_ratio=speed_ratio,
        yaw_rate_deg_s=yaw_rate,
        yaw_ratio=yaw_ratio,
        slip_per_step_m=_slip(a),
        tilt_max_deg=degrees(float(tilt.max())) if len(tilt) else None,
        tracking={
            f"{name}_m": _error(a[name], a[f"{name[:3]}_reference{name[3:]}"])
            for name in TRACKED
        },
        estimation={
            f"{name}_{unit}": _error(a[f"estimated_{name}"], a[name])
            for name, unit in ESTIMATED.items()
        },
    )


def _solver(answers: "Sequence[MpcResult]") -> SolverSummary | None:
    if not answers:
        return None
    times = 1e6 * np.array([a.time for a in answers])
    return SolverSummary(
        solves=len(answers),
        infeasible=sum(not a.feasible for a in answers),
        median_us=float(np.median(times)),
        p99_us=float(np.quantile(times, 0.99)),
    )


def _pace(a: dict[str, Array], cycle: float) -> list[float | None]:
    """Return speed [m/s] and yaw rate [deg/s], each with its ratio.

    They are over whole gait cycles; None where too short to measure.
    """
    time = a["time"]
    if len(time) < 3 or time[-1] - time[0] < 2.0 * cycle:
        return [None] * 4
    samples_per_cycle = round(cycle / float(time[1] - time[0]))
    cycles = (len(time) - 1) // samples_per_cycle
    rows = np.arange(cycles + 1) * samples_per_cycle
    elapsed = float(time[rows[-1]] - time[rows[0]])

    def length(name: str) -> float:
        steps = (np.diff(a[f"{name}_in_world_{axis}"][rows]) for axis in "xy")
        return float(np.hypot(*steps).sum())

    way, planned_way = length("com"), length("com_reference")
    heading, planned = (
        float(np.subtract(*np.unwrap(a[name])[rows[[-1, 0]]]))
        for name in ("heading", "heading_reference")
    )
    return [
        way / elapsed,
        way / planned_way if planned_way > 0.01 else None,
        degrees(heading) / elapsed,
        heading / planned if abs(planned) > 0.05 else None,
    ]


def _slip(a: dict[str, Array]) -> float | None:
    """Return the mean slip of the support foot in single support, in [m]."""
    single = a["single"] > 0.5
    edges = np.flatnonzero(np.diff(single.astype(int)))
    x, y = a["foot_in_world_x"], a["foot_in_world_y"]
    slips = [
        np.hypot(x[end - 1] - x[start + 2], y[end - 1] - y[start + 2])
        for start, end in zip(edges[:-1], edges[1:], strict=True)
        if single[start + 1] and end - start > 6
    ]
    return float(np.mean(slips)) if slips else None


def _error(values: Array, references: Array) -> ErrorStatistics | None:
    errors = values - references
    errors = errors[np.isfinite(errors)]
    if errors.size == 0:
        return None
    return ErrorStatistics(
        rms=float(np.sqrt(np.mean(errors**2))),
        mean=float(np.mean(errors)),
        max=float(np.abs(errors).max()),
    )
