"""Parallel jobs that can be interrupted and continued."""

import json
import sys
from collections.abc import Callable, Mapping, Sequence
from concurrent.futures import Future, ThreadPoolExecutor, as_completed
from hashlib import sha256
from pathlib import Path
from typing import Any, TypeVar

import numpy as np
from tqdm import tqdm

from stepaside.core.worker_pool import cancel_pending, worker_pool
from stepaside.studies.record_store import RecordStore

Row = dict[str, Any]
Job = TypeVar("Job")


def gather(
    output: Path,
    head: Mapping[str, Any],
    jobs: Mapping[str, Job],
    do: Callable[[Job], Row],
    workers: int | None = None,
) -> dict[str, Row]:
    """Run the jobs that are not done yet; record results next to the output.

    Args:
        output: File of results to be written. Finished jobs are recorded in a
            file with the suffix ``.part``. They are reused if job, version,
            libraries and the code of the command are the same, and deleted by
            :func:`finished`.
        head: Header of the results.
        jobs: Arguments by name; their ``repr`` must be unique.
        do: Runs one job; a module-level function, as it runs in other
            processes.
        workers: Number of processes; all cores by default, 0 for a thread of
            this process.

    Returns:
        Results in the order of the jobs.
    """
    file = RecordStore(part_of(output))
    mark = {key: head[key] for key in ("version", "libraries")}
    mark["script"] = sha256(Path(sys.argv[0]).read_bytes()).hexdigest()
    own = json.dumps(mark, sort_keys=True)
    keys = {
        f"{name}/{sha256(f'{job!r}{own}'.encode()).hexdigest()[:12]}": name
        for name, job in jobs.items()
    }
    done = {keys[key]: row for key, row in file.read().items() if key in keys}
    missing = {key: name for key, name in keys.items() if name not in done}
    with (
        tqdm(total=len(missing), disable=None) as bar,
        ThreadPoolExecutor(1)
        if workers == 0
        else worker_pool(workers) as pool,
    ):
        futures = {
            pool.submit(do, jobs[name]): key for key, name in missing.items()
        }

        def keep(future: Future[Row]) -> None:
            key, row = futures[future], future.result()
            done[keys[key]] = row
            file.append(key, row)

        try:
            for future in as_completed(futures):
                keep(future)
                bar.update()
        except BaseException:
            cancel_pending(pool, futures)
            for future, key in futures.items():
                over = future.done() and not future.cancelled()
                new = keys[key] not in done
                if over and new and not future.exception():
                    keep(future)
            raise
    return {name: done[name] for name in jobs}


def finished(output: Path) -> None:
    """Delete the records of finished jobs, once the results are written."""
    part_of(output).unlink(missing_ok=True)


def part_of(output: Path) -> Path:
    """Return the file of the records."""
    return output.with_suffix(".part")


def spread(values: Sequence[float | None]) -> dict[str, float | int | None]:
    """Return minimum, mean and maximum of the values that are not None."""
    found = [value for value in values if value is not None]
    if not found:
        return {"number": 0, "least": None, "mean": None, "greatest": None}
    return {
        "number": len(found),
        "least": min(found),
        "mean": float(np.mean(found)),
        "greatest": max(found),
    }
