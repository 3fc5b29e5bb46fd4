"""Summary of a finished duel, compared with theory."""

from collections.abc import Collection, Mapping
from math import degrees, hypot, isfinite, pi
from typing import Any

import numpy as np

from ..core.poses import Array, Pose
from ..robots.description import load_robot
from ..sim.person_motion import PersonMotion, template_approach
from ..theory.unicycle.circle_fit import fit_circle
from ..theory.unicycle.circles import Circle
from ..theory.unicycle.unicycle_game import Unicycle
from .duel_circle import (
    angle_between,
    circle_of_theory,
    convergence_time,
    distance_between,
    last_third,
    missing_circle_reason,
    time_scale,
)
from .duel_settings import (
    EVADER,
    PLAYERS,
    PURSUER,
    DuelSettings,
    load_evader,
)
from .duel_summary import (
    DuelSummary,
    PlanTimes,
    PlayerSummary,
    StartSummary,
    TheorySummary,
)
from .floor_games import play_template
from .forecast import ExpectedEnd, forecast
from .game import GameInPlay
from .sight_summary import SightReport
from .trajectory import PlanningTimes, Trajectory

FirstMoves = Mapping[str, tuple[float, Mapping[str, Pose]]]


def summarise(
    settings: DuelSettings,
    game: GameInPlay,
    times: Array,
    tracks: Mapping[str, Trajectory],
    planning: Mapping[str, PlanningTimes],
    first_moves: FirstMoves,
    seen: SightReport | None,
) -> DuelSummary:
    """Compute the summary of a duel.

    Args:
        settings: Settings of the duel, with the initial poses filled in.
        game: The game that was played.
        times: Times of the samples, in [s]. Shape (n,).
        tracks: Trajectory of each player, by name.
        planning: Planning times of each player, by name.
        first_moves: Time and poses at which players first moved, by name.
        seen: Evaluation of perception, with camera sensing.
    """
    pursuer, evader = (tracks[name].unicycle for name in PLAYERS)
    theory = circle_of_theory(settings)
    converged = convergence_time(times, pursuer, evader, settings, theory)
    tail = last_third(times)
    last = pursuer[tail], evader[tail]
    start, pair = settings.start, (EVADER, PURSUER)
    triggered_at, apart = None, None
    if EVADER in first_moves:
        triggered_at, poses = first_moves[EVADER]
        (x, y, _), (u, v, _) = poses[PURSUER], poses[EVADER]
        apart = hypot(u - x, v - y)
    return DuelSummary(
        seed=settings.seed,
        start=StartSummary(
            start.distance, start.pursuer_offset, start.evader_offset
        ),
        triggered_at_s=triggered_at,
        triggered_at_distance_m=apart,
        distance_m=float(distance_between(*last).mean()),
        relative_orientation_deg=degrees(float(angle_between(*last).mean())),
        min_distance_m=game.closest[pair],
        converged_at_s=converged,
        **planning_values(planning.values()),
        theory=_theory(settings, converged),
        real_time_factor=game.real_time_factor,
        pursuer=_player(PURSUER, last[0], seen),
        evader=_player(EVADER, last[1], seen),
        sight=None if seen is None else seen.together,
        touched=list(game.touched),
        notes=list(settings.notes),
        captured_at_s=game.captured_at.get(pair),
    )


def _theory(settings: DuelSettings, converged: float | None) -> TheorySummary:
    """Summarise theory; no circle if the forecast is contact before it."""
    circle, expectation = circle_of_theory(settings), forecast(settings)
    words = None if circle.exists else missing_circle_reason(settings)
    if expectation is not None and converged is None:
        if expectation.expected is ExpectedEnd.CONTACT:
            circle = Circle(exists=False)
    return TheorySummary(
        template_closest_approach(settings)
        if expectation is None
        else expectation.closest_m,
        circle.exists,
        _number(circle.radius_evader_m),
        _number(circle.distance_m),
        _number(degrees(circle.headings_apart_rad)),
        _number(circle.radius_pursuer_m),
        None if expectation is None else expectation.expected.value,
        None if expectation is None else expectation.circle_since_s,
        words if expectation is None else expectation.words,
    )


def planning_values(players: Collection[PlanningTimes]) -> dict[str, Any]:
    """Return the values of a summary that the planning of players gives."""
    plans = 1e6 * np.concatenate([p.times for p in players])
    times = PlanTimes(None, None)
    if len(plans):
        # np.median and np.quantile would import numpy.ma for it.
        ranks, shares = np.arange(len(plans)), np.array([0.5, 0.99])
        at = shares * ranks[-1]
        times = PlanTimes(*np.interp(at, ranks, np.sort(plans)).tolist())
    return {
        "replans": len(plans),
        "max_com_velocity_jump_m_s": max(p.velocity_jump for p in players),
        "min_zmp_margin_m": min(
            (p.zmp_margin for p in players if p.zmp_margin is not None),
            default=None,
        ),
        "plan_time_us": times,
    }


def _player(
    name: str, poses: Array, seen: SightReport | None
) -> PlayerSummary:
    """Summarise a player by its poses in the last third. Shape (n, 3)."""
    radius = fit_circle(poses[:, :2])[1]
    sight = None if seen is None else seen.by_robot.get(name)
    return PlayerSummary(_number(radius), sight)


def template_closest_approach(settings: DuelSettings) -> float | None:
    """Compute the closest approach of a person to the evader's template.

    Returns:
        Distance, in [m]; None where the template is no model of the game.
    """
    start, own = settings.start, settings.robot_of(EVADER)
    gait, legs = own.gait, own.legs
    if settings.pursuer == "robot" or start.distance is None:
        return None
    if not (settings.is_of_the_paper or legs.walks):
        return None
    initial = (
        lambda pose, evader: PersonMotion(settings.person, pose, evader),
        Pose(0.0, 0.0, start.pursuer_offset or 0.0),
        Pose(start.distance, 0.0, pi + (start.evader_offset or 0.0)),
    )
    if legs.walks:
        from ..locomotion.policy.policy_legs import load_legs

        policy = load_legs(
            legs, load_robot(own.robot), tick=settings.physics.tick
        )
        return play_template(
            *initial,
            load_evader(settings),
            gait,
            duration=settings.duration,
            velocities=policy.velocities,
        ).closest_distance
    if settings.strategy.trigger == "time":
        return play_template(
            *initial, load_evader(settings), gait, duration=settings.duration
        ).closest_distance
    pace = time_scale(gait)
    return template_approach(
        *initial,
        unicycle=Unicycle(gait.speed * pace, gait.gain * pace),
        angle=settings.strategy.angle,
        safety_radius=settings.strategy.safety_radius,
        duration=settings.duration,
    )


def _number(value: float) -> float | None:
    return value if isfinite(value) else None
