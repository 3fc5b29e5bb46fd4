"""Measure what campaigns cost, for docs/campaigns.md.

Core-hours per thousand duels of 120 s by kind, and memory per worker; the
scaling from one worker process to two; and the cost of the parent per case,
with a million trivial cases on processes and on Dask::

    python tools/benchmarks/campaigns.py

Use a quiet machine; ``--duels`` and ``--cases`` shorten the measurement.
"""

import multiprocessing
import resource
from collections.abc import Sequence
from dataclasses import replace
from functools import partial
from time import perf_counter, process_time
from typing import Any

from benchmark_options import ask, machine
from duels import KINDS

from stepaside.games.duel_settings import DuelSettings
from stepaside.studies.duel_record import play_seed
from stepaside.studies.executors import open_executor
from stepaside.studies.result_files import header, write_result
from stepaside.studies.study import Study, run_study
from stepaside.studies.tabulation import Record

WHOLE = 120.0  # duration of the duels that are counted, in [s]
MIB = 1024.0  # kibibytes, the unit of the kernel for memory


def peak_memory() -> float:
    """Return the peak memory of this process, in [MiB]."""
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / MIB


def measure_duel(settings: DuelSettings, seed: int) -> Record:
    """Play a duel; return the processor time it takes, and the memory."""
    began = process_time()
    play_seed(settings, seed)
    return {"cpu_s": process_time() - began, "memory_mib": peak_memory()}


def measure_nothing(case: int) -> Record:
    """Return the number of a trivial case."""
    return {"case": case}


def study_of(name: str, cases: Sequence[int], measure: Any) -> Study[int]:
    """Return a study that stores nothing for later."""
    return Study(name, cases, measure, str)


def cost_of(kind: str, duels: int, duration: float) -> dict[str, Any]:
    """Return the cost of one kind of duel, in one worker."""
    settings = replace(KINDS[kind], duration=duration)
    study = study_of(kind, range(duels + 1), partial(measure_duel, settings))
    records = list(run_study(study, workers=1).records())
    warm = records[1:]  # the first one compiles
    seconds = sum(record["cpu_s"] for record in warm) / len(warm)
    return {
        "kind": kind,
        "duels": len(warm),
        "duration_s": duration,
        "cpu_s": seconds,
        "core_hours_per_thousand": seconds * WHOLE / duration / 3.6,
        "memory_mib": max(record["memory_mib"] for record in records),
    }


def scaling(duels: int, duration: float) -> dict[str, Any]:
    """Return wall times of the same duels with one worker and with two."""
    settings = replace(DuelSettings(), duration=duration)
    walls = []
    for workers in (1, 2):
        warm = study_of("warm", range(4), partial(measure_duel, settings))
        study = study_of("all", range(duels), partial(measure_duel, settings))
        with open_executor("processes", workers) as executor:
            run_study(warm, executor=executor)
            began = perf_counter()
            run_study(study, executor=executor)
            walls.append(perf_counter() - began)
    return {
        "duels": duels,
        "one_worker_s": walls[0],
        "two_workers_s": walls[1],
        "efficiency": walls[0] / (2.0 * walls[1]),
    }


def _parent(executor: str, cases: int) -> dict[str, Any]:
    study = study_of("trivial", range(cases), measure_nothing)
    with open_executor(executor, 2) as opened:
        began, busy = perf_counter(), process_time()
        run = run_study(study, executor=opened)
    assert run.completed
    return {
        "executor": executor,
        "cases": cases,
        "wall_s": perf_counter() - began,
        "parent_us_per_case": 1e6 * (process_time() - busy) / cases,
        "parent_memory_mib": peak_memory(),
    }


def parent_cost(executor: str, cases: int) -> dict[str, Any]:
    """Return the cost of the parent, which is a process of its own here."""
    context = multiprocessing.get_context("spawn")
    receiving, sending = context.Pipe(duplex=False)
    process = context.Process(
        target=_send, args=(sending, executor, cases), daemon=False
    )
    process.start()
    found: dict[str, Any] = receiving.recv()
    process.join()
    return found


def _send(sending: Any, executor: str, cases: int) -> None:
    sending.send(_parent(executor, cases))


def main() -> None:
    """Measure everything, and write the results."""
    asked = ask(__doc__, "campaigns.json")
    asked.add_argument("--duels", type=int, default=4)
    asked.add_argument("--duration", type=float, default=120.0)
    asked.add_argument("--cases", type=int, default=1_000_000)
    arguments = asked.parse_args()
    duels, duration = arguments.duels, arguments.duration
    kinds = [cost_of(kind, duels, duration) for kind in KINDS]
    scaled = scaling(10 * duels, duration / 10.0)
    parents = [
        parent_cost(name, arguments.cases) for name in ("processes", "dask")
    ]
    settings = {
        "duels": duels,
        "duration_s": duration,
        "cases": arguments.cases,
    }
    write_result(
        arguments.output,
        header(settings),
        machine=machine(),
        kinds=kinds,
        scaling=scaled,
        parents=parents,
    )


if __name__ == "__main__":
    main()
