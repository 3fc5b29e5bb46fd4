"""Campaign of duels from random initial poses: one record per seed."""

import json
from collections.abc import Callable, Iterable, Sequence
from concurrent.futures import Executor, as_completed
from dataclasses import asdict, replace
from functools import cache
from hashlib import sha256
from math import isfinite
from time import perf_counter
from typing import Any

import numpy as np

from ..core.errors import PlanError
from ..core.poses import Pose
from ..core.random_streams import named_generator
from ..core.worker_pool import cancel_pending
from ..games.duel import run_duel
from ..games.duel_settings import DuelSettings
from ..games.run import DuelRun
from ..games.strategy_objects import check_strategy_names
from ..robots.jit import prefer_for_duration
from ..strategies.registry import file_of
from ..theory.unicycle.certificate import certify
from ..theory.unicycle.relative_coordinates import RelativeStart
from ..theory.unicycle.unicycle_game import make_game
from .code_version import code_version, library_versions
from .duel_statistics import FIELDS
from .record_store import RecordStore

Record = dict[str, Any]
MODULES = ("studies/duel_campaign",)  # which play and record a duel
# Entries of a record that depend on the machine.
MACHINE = ("version", "libraries", "verified", "wall_s")


def settings_hash(settings: DuelSettings) -> str:
    """Return a fingerprint of the settings of a duel without its seed.

    The content of strategy files is included, that of their imports is not.
    """
    entries = asdict(replace(settings.named(), seed=0))
    for name in (settings.evader_strategy, settings.pursuer_strategy):
        file = file_of(name) if isinstance(name, str) else None
        if file is not None and file.is_file():
            entries[f"content of {name}"] = file.read_bytes().hex()
    text = json.dumps(entries, sort_keys=True)
    return sha256(text.encode()).hexdigest()[:12]


def key_of(settings: DuelSettings) -> str:
    """Return the key of a duel among records: its seed and its settings."""
    return f"{settings.seed}/{settings_hash(settings)}"


@cache
def _stamp() -> Record:
    return {
        "version": code_version(MODULES),
        "libraries": library_versions(("mujoco", "numpy")),
    }


def play_record(settings: DuelSettings) -> Record:
    """Play one duel and return its record.

    Returns:
        Summary values in SI units, or [deg] as their names say, the
        ``digest`` of the trajectories, and versions of code and libraries.
    """
    began = perf_counter()
    prefer_for_duration(settings.duration, many=True)
    run = run_duel(settings)
    summary = run.summary
    record = {
        "seed": settings.seed,
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
    record["wall_s"] = round(perf_counter() - began, 3)
    return record | _stamp()


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


def run_duels(
    settings: DuelSettings,
    seeds: Sequence[int],
    file: RecordStore | None,
    executor: Executor,
    report: Callable[[int], None] | None = None,
    done: dict[str, Record] | None = None,
) -> dict[str, Record]:
    """Play the duels that are not in a file of records yet.

    Args:
        settings: Settings of every duel; the seed is ignored.
        seeds: Seeds of the duels.
        file: Record store, extended by each duel; None to store nothing.
            Records of another version of the code are replaced.
        executor: Any executor of ``concurrent.futures``.
        report: Called with the number of finished duels.
        done: Dictionary that receives the records as they arrive, and holds
            them if the campaign is interrupted.

    Returns:
        Records by key, in the order of the seeds.
    """
    requested = {
        key_of(one): one
        for one in (replace(settings, seed=seed) for seed in seeds)
    }
    results: dict[str, Record] = {} if done is None else done
    if file is not None:
        check_strategy_names(settings)
        results |= {
            key: record
            for key, record in file.read(FIELDS).items()
            if key in requested and is_current(record)
        }
    if report is not None:
        report(len(results))
    futures = {
        executor.submit(play_record, one): key
        for key, one in requested.items()
        if key not in results
    }
    try:
        for future in as_completed(futures):
            key = futures[future]
            results[key] = future.result()
            if file is not None:
                file.append(key, results[key])
            if report is not None:
                report(len(results))
    except BaseException:
        cancel_pending(executor, futures)
        raise
    return {key: results[key] for key in requested}


def is_current(record: Record) -> bool:
    """Return whether a record is of this version of code and libraries.

    Records of another version count as current once :func:`verify_duels` has
    found that both play the same.
    """
    now = _stamp()
    stamp = record.get("verified", record)
    return all(stamp.get(name) == now[name] for name in now)


def verify_duels(
    settings: DuelSettings,
    file: RecordStore,
    number: int,
    executor: Executor,
) -> tuple[list[int], list[int]]:
    """Compare records of an older version with repeated duels.

    If all repeated duels give the same record, all records of the older
    version are marked as verified by this one; their version is kept.

    Args:
        settings: Settings of every duel; the seed is ignored.
        file: Record store.
        number: Number of randomly chosen duels to repeat.
        executor: Any executor of ``concurrent.futures``.

    Returns:
        Seeds of the repeated duels, and of those that differ.
    """
    own = settings_hash(settings)
    records = file.read(FIELDS)
    old = [
        key
        for key, record in records.items()
        if key.endswith("/" + own) and not is_current(record)
    ]
    drawn = named_generator(0, "verify").permutation(len(old))[:number]
    keys = [old[i] for i in sorted(drawn.tolist())]
    tasks = [replace(settings, seed=records[key]["seed"]) for key in keys]
    differ = [
        int(records[key]["seed"])
        for key, new in zip(
            keys, executor.map(play_record, tasks), strict=True
        )
        if _substance(new) != _substance(records[key])
    ]
    if keys and not differ:
        stamp = _stamp() | {"replayed": len(keys)}
        for key in old:
            records[key]["verified"] = stamp
        file.write(records)
    return [int(records[key]["seed"]) for key in keys], differ


def _substance(record: Record) -> Record:
    return {k: v for k, v in record.items() if k not in MACHINE}


def versions_of(records: Iterable[Record]) -> Record:
    """Return the versions of code and libraries of some records.

    Returns:
        ``version`` and ``libraries`` of the records, and ``verified``:
        versions that were found to play the same, if any. Each is a list if
        there are several.
    """
    stamps: dict[str, list[Any]] = {}
    for record in records:
        for name in ("version", "libraries", "verified"):
            value = record.get(name)
            found = stamps.setdefault(name, [])
            if value is not None and value not in found:
                found.append(value)
    return {
        name: found[0] if len(found) == 1 else found
        for name, found in stamps.items()
        if found
    }
