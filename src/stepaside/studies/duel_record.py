"""Record of a duel: what a campaign stores of it."""

from math import isfinite
from time import perf_counter

import numpy as np

from ..core.errors import PlanError
from ..core.poses import Pose
from ..games.game_settings import GameSettings
from ..games.player_settings import EVADER, PURSUER
from ..games.recorded_game import run_game
from ..games.run import Run
from ..games.summary import PlanningSummary, TheorySummary
from ..theory.unicycle.certificate import certify
from ..theory.unicycle.unicycle_game import RelativeStart, make_game
from .tabulation import Record

OF_SUMMARY = (
    *("distance_m", "relative_orientation_deg", "min_distance_m"),
    *("converged_at_s", "triggered_at_s", "triggered_at_distance_m"),
)
BEFORE = 2.0 / 3.0  # of a duel; means are taken over the rest


def play_duel(settings: GameSettings) -> Record:
    """Play one duel and return its record.

    Summary values in SI units, or [deg] as their names say, and the
    ``digest`` of the trajectories.
    """
    began = perf_counter()
    run = run_game(settings).uninterrupted()
    return _record_of(run, perf_counter() - began)


def _record_of(run: Run, wall: float) -> Record:
    """Return the record of a run that took a computing time, in [s]."""
    summary, players = run.summary, run.summary.players
    theory = summary.theory or TheorySummary()
    planning = summary.planning or PlanningSummary(0, 0)
    since = summary.converged_at_s
    record = {
        "seed": run.settings.seed,
        "outcome": run.outcome.value,
        "message": run.message,
        "duration_s": run.duration,
        "start_distance_m": run.settings.start.distance,
        "pursuer_radius_m": players[PURSUER].radius_m,
        "evader_radius_m": players[EVADER].radius_m,
        **{name: getattr(summary, name) for name in OF_SUMMARY},
        "on_circle": since is not None,
        "on_circle_in_time": since is not None
        and since < BEFORE * run.settings.duration,
        "min_zmp_margin_m": planning.min_zmp_margin_m,
        "max_com_velocity_jump_m_s": planning.max_com_velocity_jump_m_s,
        "theory_radius_m": theory.radius_m,
        "theory_distance_m": theory.distance_m,
        "theory_orientation_deg": theory.relative_orientation_deg,
        **_evasion(run),
    }
    closest, certified = (
        record["evading_min_distance_m"],
        record["certified_m"],
    )
    both = closest is not None and certified is not None
    record["over_certificate_m"] = closest - certified if both else None
    if summary.sight is not None:
        for name in ("lost_s", "detection_rate", "false_detections"):
            record[name] = getattr(summary.sight, name)
    record["wall_s"] = round(wall, 3)
    return record


def _evasion(run: Run) -> Record:
    """Return the closest approach while evading, and its certificate.

    The certificate is that of two unicycles at the poses of the players when
    evasion begins, with an evader that keeps its side.
    """
    found: Record = {"evading_min_distance_m": None, "certified_m": None}
    triggered = run.summary.triggered_at_s
    if triggered is None or run.settings.pursuer.body != "robot":
        return found
    since = run.times >= triggered - 1e-9
    if not since.any():
        return found
    found["evading_min_distance_m"] = float(run.distance[since].min())
    first = int(np.argmax(since))
    start = RelativeStart.from_world(
        Pose(*run.pursuer.unicycle[first].tolist()),
        Pose(*run.evader.unicycle[first].tolist()),
    )
    own = run.settings.evader
    gait, strategy = own.gait, own.evasion
    ends = strategy.trigger == "time" or isfinite(strategy.release_distance)
    if ends or not run.settings.is_of_the_paper:
        return found  # the certificate assumes permanent evasion
    try:
        game = make_game(
            gait.speed,
            gait.speed,
            gait.gain,
            gait.gain,
            strategy.angle,
            "saturated" if strategy.saturated else "proportional",
            side_rule="latched",
        )
        certificate = certify(game, start)
    except PlanError:  # the certificate does not cover this game
        return found
    if certificate.holds:
        found["certified_m"] = certificate.distance_m
    return found
