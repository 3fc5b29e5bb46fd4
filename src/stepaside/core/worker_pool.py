"""Pool of worker processes that ends with its ``with`` block."""

import os
import signal
import sys
from collections.abc import Callable, Iterable, Iterator
from concurrent.futures import Executor, Future, ProcessPoolExecutor
from multiprocessing import connection, get_context, parent_process
from threading import Thread
from typing import Any, TypeVar

R = TypeVar("R")


class WorkerPool(ProcessPoolExecutor):
    """Process pool whose workers end with its ``with`` block."""

    def submit(self, *task: Any, **more: Any) -> Future[Any]:
        """Submit a task; see :class:`concurrent.futures.Executor`.

        Workers start with SIGINT blocked, until :func:`_begin`, for a Ctrl-C
        during their start would print a traceback.
        """
        before = signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT})
        try:
            return super().submit(*task, **more)
        finally:
            signal.pthread_sigmask(signal.SIG_SETMASK, before)

    def map(
        self,
        fn: Callable[..., R],
        *iterables: Iterable[Any],
        timeout: float | None = None,
        chunksize: int = 1,
    ) -> Iterator[R]:
        """Submit a task for each item; see :func:`cancel_pending`."""
        each = zip(*iterables, strict=False)
        futures = [self.submit(fn, *one) for one in each]
        return (future.result(timeout) for future in futures)

    def __exit__(self, *error: Any) -> None:
        """Terminate the workers; unfinished tasks were given up.

        After an error nobody waits for the pool's own thread: Ctrl-C may have
        come while this thread held a lock that the other needs.
        """
        for process in list((self._processes or {}).values()):
            process.terminate()
        failed = sys.exc_info()[0] is not None
        self.shutdown(wait=not failed, cancel_futures=failed)


def cancel_pending(executor: Executor, futures: Iterable[Future[Any]]) -> None:
    """Cancel tasks that have not started.

    A process pool is left alone: it drops all tasks with its workers, and
    fails on a cancelled future when they are gone.
    """
    if not isinstance(executor, ProcessPoolExecutor):
        for future in futures:
            future.cancel()


def worker_pool(workers: int | None = None) -> WorkerPool:
    """Return a pool of processes with one linear algebra thread each.

    Workers ignore Ctrl-C: the parent handles it and terminates them, so that
    none returns a truncated result or breaks the pool first. They also exit
    when the parent was killed. By default there is one for each core.
    """
    os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
    # After Ctrl-C, semaphores are left to Python's tracker, which would warn.
    os.environ.setdefault("PYTHONWARNINGS", "ignore:resource_tracker")
    return WorkerPool(workers, get_context("spawn"), initializer=_begin)


def _begin() -> None:
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    signal.pthread_sigmask(signal.SIG_UNBLOCK, {signal.SIGINT})
    Thread(target=_end_with_parent, daemon=True).start()


def _end_with_parent() -> None:
    parent = parent_process()
    if parent is not None:
        connection.wait([parent.sentinel])
        os._exit(1)
