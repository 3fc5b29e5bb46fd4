"""Many runs on several processes, which go on where they were stopped."""

import json
import os
import sys

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

from collections.abc import Callable, Mapping, Sequence
from concurrent.futures import (
    Executor,
    Future,
    ProcessPoolExecutor,
    ThreadPoolExecutor,
    as_completed,
)
from hashlib import sha256
from multiprocessing import get_context
from pathlib import Path
from typing import Any, TypeVar

import numpy as np
from tqdm import tqdm

Row = dict[str, Any]
Job = TypeVar("Job")


def gather(
    output: Path,
    head: Mapping[str, Any],
    jobs: Mapping[str, Job],
    do: Callable[[Job], Row],
    workers: int | None = None,
) -> dict[str, Row]:
    """Do what is not done yet; what is done is kept beside the output.

    Args:
        output: File of results that is being made. What is done stands in
            a file of the same name that ends in ``.part``; it is taken up
            again if version, libraries and the command's own code are the
            same, and deleted by :func:`finished`.
        head: Of the results.
        jobs: What to do, by name.
        do: Does one; a function of a module, as it runs in other processes.
        workers: Processes; all cores by default, 0 for a thread of this
            one.

    Returns:
        What each gave, in the order of the jobs.
    """
    part = part_of(output)
    mark = {key: head[key] for key in ("version", "libraries")}
    mark["script"] = sha256(Path(sys.argv[0]).read_bytes()).hexdigest()
    done = _taken_up(part, mark)
    missing = [name for name in jobs if name not in done]
    part.parent.mkdir(parents=True, exist_ok=True)
    # Without the line that was cut off when the last run stopped.
    lines = [json.dumps(line) for line in (mark, *done.items())]
    part.write_text("\n".join(lines) + "\n", encoding="utf-8")
    with _executor(workers) as executor:
        futures = {executor.submit(do, jobs[name]): name for name in missing}

        def keep(future: Future[Row]) -> None:
            name, row = futures[future], future.result()
            done[name] = row
            with part.open("a", encoding="utf-8") as file:
                file.write(json.dumps([name, row]) + "\n")

        bar = tqdm(total=len(missing), disable=None)
        try:
            for future in as_completed(futures):
                keep(future)
                bar.update()
        except BaseException:
            for future, name in futures.items():
                future.cancel()
                over = future.done() and not future.cancelled()
                if over and name not in done and not future.exception():
                    keep(future)
            raise
        finally:
            bar.close()
    return {name: done[name] for name in jobs}


def finished(output: Path) -> None:
    """Delete what was kept while the results were being made."""
    part_of(output).unlink(missing_ok=True)


def part_of(output: Path) -> Path:
    """Where that is kept."""
    return output.with_suffix(".part")


def spread(values: Sequence[float | None]) -> dict[str, float | int | None]:
    """Least, mean and greatest of the values that there are."""
    found = [value for value in values if value is not None]
    if not found:
        return {"number": 0, "least": None, "mean": None, "greatest": None}
    return {
        "number": len(found),
        "least": min(found),
        "mean": float(np.mean(found)),
        "greatest": max(found),
    }


def _executor(workers: int | None) -> Executor:
    if workers == 0:
        return ThreadPoolExecutor(1)
    return ProcessPoolExecutor(workers, get_context("spawn"))


def _taken_up(part: Path, mark: Mapping[str, Any]) -> dict[str, Row]:
    """What an earlier run left, if it ran the same code."""
    if not part.exists():
        return {}
    first, *lines = part.read_text(encoding="utf-8").splitlines() or [""]
    done: dict[str, Row] = {}
    try:
        if json.loads(first) != mark:
            return {}
        for line in lines:
            name, row = json.loads(line)
            done[name] = row
    except ValueError:
        pass  # a line that was cut off
    return done
