"""Record of a duel: what a campaign stores of it."""

import json
from dataclasses import asdict, replace
from hashlib import sha256
from math import isfinite
from time import perf_counter
from typing import Any

import numpy as np

from ..core.errors import PlanError
from ..core.poses import Pose
from ..games.duel import run_duel, run_duels
from ..games.duel_settings import DuelSettings
from ..games.outcome import Outcome
from ..games.run import DuelRun
from ..strategies.registry import file_of
from ..theory.unicycle.certificate import certify
from ..theory.unicycle.relative_coordinates import RelativeStart
from ..theory.unicycle.unicycle_game import make_game
from .tabulation import Record


def settings_hash(settings: DuelSettings) -> str:
    """Return a fingerprint of the settings of a duel without its seed.

    Only differences from the default settings count, so that a setting that
    is added later does not change it. The content of strategy files is
    included, that of their imports is not.
    """
    settings = settings.resolved()
    default = asdict(DuelSettings(seed=0).resolved())
    entries = _differences(asdict(replace(settings.named(), seed=0)), default)
    for name in (settings.evader_strategy, settings.pursuer_strategy):
        file = file_of(name) if isinstance(name, str) else None
        if file is not None and file.is_file():
            entries[f"content of {name}"] = file.read_bytes().hex()
    text = json.dumps(entries, sort_keys=True)
    return sha256(text.encode()).hexdigest()[:12]


def _differences(
    entries: dict[str, Any], default: dict[str, Any]
) -> dict[str, Any]:
    """Return the entries that differ from the default ones, by section."""
    found: dict[str, Any] = {}
    for name, value in entries.items():
        usual = default.get(name)
        if isinstance(value, dict) and isinstance(usual, dict):
            value = _differences(value, usual)
            if value:
                found[name] = value
        elif name not in default or value != usual:
            found[name] = value
    return found


def play_seed(settings: DuelSettings, seed: int) -> Record:
    """Play the duel of a seed and return its record."""
    return play_record(replace(settings, seed=seed))


def play_seeds(settings: DuelSettings, seeds: list[int]) -> list[Record]:
    """Play the duels of seeds side by side and return their records."""
    began = perf_counter()
    runs = run_duels([replace(settings, seed=seed) for seed in seeds])
    wall = (perf_counter() - began) / len(seeds)
    return [_record_of(run, wall) for run in runs]


def play_record(settings: DuelSettings) -> Record:
    """Play one duel and return its record.

    Returns:
        Summary values in SI units, or [deg] as their names say, and the
        ``digest`` of the trajectories.

    Raises:
        KeyboardInterrupt: If the duel was interrupted.
    """
    began = perf_counter()
    run = run_duel(settings)
    if run.outcome is Outcome.INTERRUPTED:
        raise KeyboardInterrupt
    return _record_of(run, perf_counter() - began)


def _record_of(run: DuelRun, wall: float) -> Record:
    """Return the record of a run that took a computing time, in [s]."""
    summary = run.summary
    record = {
        "seed": run.settings.seed,
        "outcome": run.outcome.value,
        "message": run.message,
        "duration_s": run.duration,
        "start_distance_m": run.settings.start.distance,
        "pursuer_radius_m": summary.pursuer.radius_m,
        "evader_radius_m": summary.evader.radius_m,
        "distance_m": summary.distance_m,
        "relative_orientation_deg": summary.relative_orientation_deg,
        "converged_at_s": summary.converged_at_s,
        "min_distance_m": summary.min_distance_m,
        "triggered_at_s": summary.triggered_at_s,
        "triggered_at_distance_m": summary.triggered_at_distance_m,
        "min_zmp_margin_m": summary.min_zmp_margin_m,
        "max_com_velocity_jump_m_s": summary.max_com_velocity_jump_m_s,
        **_evasion(run),
    }
    if summary.sight is not None:
        for name in ("lost_s", "detection_rate", "false_detections"):
            record[name] = getattr(summary.sight, name)
    record["digest"] = digest_of(run)
    record["wall_s"] = round(wall, 3)
    return record


def _evasion(run: DuelRun) -> Record:
    """Return the closest approach while evading, and its certificate.

    The certificate is that of two unicycles at the poses of the players when
    evasion begins, with an evader that keeps its side.
    """
    found: Record = {"evading_min_distance_m": None, "certified_m": None}
    triggered = run.summary.triggered_at_s
    if triggered is None or run.settings.pursuer != "robot":
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
    gait, strategy = run.settings.gait, run.settings.strategy
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


def digest_of(run: DuelRun) -> str:
    """Return a fingerprint of all recorded arrays of a duel."""
    digest = sha256()
    for name, array in sorted(run.arrays().items()):
        digest.update(name.encode())
        digest.update(np.ascontiguousarray(array).tobytes())
    return digest.hexdigest()[:12]
