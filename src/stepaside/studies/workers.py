"""Processes that work on a study and end with it, however it ends."""

import os
import signal
from concurrent.futures import ProcessPoolExecutor
from multiprocessing import connection, get_context, parent_process
from threading import Thread


def worker_pool(workers: int | None = None) -> ProcessPoolExecutor:
    """Pool of processes, one thread of linear algebra each.

    A Ctrl-C ends the workers at once, so that none hands in a result that
    was cut short, and they do not outlive a parent that was killed.

    Args:
        workers: How many; as many as there are cores by default.
    """
    os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
    return ProcessPoolExecutor(
        workers, get_context("spawn"), initializer=_begin
    )


def _begin() -> None:
    signal.signal(signal.SIGINT, signal.SIG_DFL)
    Thread(target=_end_with_parent, daemon=True).start()


def _end_with_parent() -> None:
    parent = parent_process()
    if parent is not None:
        connection.wait([parent.sentinel])
        os._exit(1)
