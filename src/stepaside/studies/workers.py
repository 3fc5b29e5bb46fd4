"""Processes that work on a study and end with it, however it ends."""

import os
import signal
from collections.abc import Iterable
from concurrent.futures import Executor, Future, ProcessPoolExecutor
from multiprocessing import connection, get_context, parent_process
from threading import Thread
from typing import Any


class WorkerPool(ProcessPoolExecutor):
    """Pool of processes that does not outlive its ``with`` block."""

    def __exit__(self, *error: Any) -> None:
        """End the workers: what is not done by now was given up."""
        for process in list((self._processes or {}).values()):
            process.terminate()
        super().__exit__(*error)


def give_up(executor: Executor, futures: Iterable[Future[Any]]) -> None:
    """Cancel what has not begun.

    A pool of processes is left alone. It drops all work with its workers,
    and, where they are gone, trips over a future that was cancelled.
    """
    if not isinstance(executor, ProcessPoolExecutor):
        for future in futures:
            future.cancel()


def worker_pool(workers: int | None = None) -> WorkerPool:
    """Pool of processes, one thread of linear algebra each.

    A Ctrl-C ends the workers at once, so that none hands in a result that
    was cut short, and they do not outlive a parent that was killed.

    Args:
        workers: How many; as many as there are cores by default.
    """
    os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
    return WorkerPool(workers, get_context("spawn"), initializer=_begin)


def _begin() -> None:
    signal.signal(signal.SIGINT, signal.SIG_DFL)
    Thread(target=_end_with_parent, daemon=True).start()


def _end_with_parent() -> None:
    parent = parent_process()
    if parent is not None:
        connection.wait([parent.sentinel])
        os._exit(1)
