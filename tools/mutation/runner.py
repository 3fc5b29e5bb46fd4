"""Parallel trials, each in a process of its own."""

import os
import shutil
import signal
import sys
from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass
from pathlib import Path
from time import monotonic, sleep

from .child import fork
from .tree import Tree

IDLE = 120.0  # a process without processor time for this long hangs, in [s]
LONGEST = 3600.0  # polling period, in [s]


@dataclass(frozen=True, slots=True)
class Job:
    """Work for a scratch copy.

    Attributes:
        name: Name for messages.
        prepare: Prepares the copy.
        work: Runs in a forked process.
    """

    name: str
    prepare: Callable[[Tree], None]
    work: Callable[[Tree], None]


@dataclass(slots=True)
class _Running:
    job: Job
    tree: Tree
    began: float
    used: int = -1
    moved: float = 0.0
    hung: bool = False


def run_jobs(
    jobs: Iterable[Job], trees: list[Tree]
) -> Iterator[tuple[Job, Tree, int]]:
    """Run jobs in as many processes as there are copies.

    Args:
        jobs: Jobs to run.
        trees: Free scratch copies.

    Yields:
        Each finished job, its restored copy, and the wait status of its
        process; SIGXCPU if it hung.
    """
    free, running = list(trees), dict[int, _Running]()
    waiting = iter(jobs)
    job = next(waiting, None)
    try:
        while job is not None or running:
            while free and job is not None:
                tree = free.pop()
                job.prepare(tree)
                log = tree.path.with_suffix(".log")
                work = _bound(job, tree)
                child = fork(tree.path, log, work)
                running[child] = _Running(job, tree, monotonic())
                job = next(waiting, None)
            child, status = os.waitpid(-1, os.WNOHANG)
            if child not in running:
                _end_what_hangs(running)
                sleep(0.02)
                continue
            done = running.pop(child)
            _end(child)
            done.tree.restore()
            free.append(done.tree)
            yield done.job, done.tree, signal.SIGXCPU if done.hung else status
    finally:
        for child, left in running.items():
            _end(child)
            os.waitpid(child, 0)
            left.tree.restore()


def _bound(job: Job, tree: Tree) -> Callable[[], None]:
    return lambda: job.work(tree)


def _end_what_hangs(running: dict[int, _Running]) -> None:
    now = monotonic()
    for child, state in running.items():
        used = _ticks(child)
        if used > state.used:
            state.used, state.moved = used, now
        if now - state.moved > IDLE or now - state.began > LONGEST:
            state.hung = True
            _end(child)


def _end(group: int) -> None:
    """Kill a process and its children."""
    try:
        os.killpg(group, signal.SIGKILL)
    except (ProcessLookupError, PermissionError):
        pass


def _ticks(child: int) -> int:
    """Return processor time with ended children, in tenths of a second."""
    try:
        stat = Path(f"/proc/{child}/stat").read_text(encoding="utf-8")
    except OSError:
        return 0
    fields = stat.rpartition(")")[2].split()
    return sum(map(int, fields[11:15])) // 10


def numba_cache(tree: Tree, *, fresh: bool) -> None:
    """Give compiled functions of a changed file a separate cache."""
    folder = tree.path.parent / f"numba-{tree.path.name}"
    if fresh:
        folder = folder.with_name(f"{folder.name}-fresh")
        shutil.rmtree(folder, ignore_errors=True)
    os.environ["NUMBA_CACHE_DIR"] = str(folder)
    numba = sys.modules.get("numba")
    if numba is not None:
        numba.config.CACHE_DIR = str(folder)
