"""Processes that share work and end with it, however it ends."""

import os
import signal
from collections.abc import Callable, Iterable, Iterator
from concurrent.futures import Executor, Future, ProcessPoolExecutor
from multiprocessing import connection, get_context, parent_process
from threading import Thread
from typing import Any, TypeVar

R = TypeVar("R")


class WorkerPool(ProcessPoolExecutor):
    """Pool of processes that does not outlive its ``with`` block."""

    def submit(self, *task: Any, **more: Any) -> Future[Any]:
        """Hand in a task; see :class:`concurrent.futures.Executor`.

        A Ctrl-C reaches workers that are just starting, too, where it would
        end in a traceback: they begin deaf to it, until :func:`_begin`.
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
        """Hand in a task for each; none is cancelled: see :func:`give_up`."""
        each = zip(*iterables, strict=False)
        futures = [self.submit(fn, *one) for one in each]
        return (future.result(timeout) for future in futures)

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

    A Ctrl-C is for the parent, which ends the workers at once: so none hands
    in a result that was cut short, and none breaks the pool before its parent
    knows. They do not outlive a parent that was killed.

    Args:
        workers: How many; as many as there are cores by default.
    """
    os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
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
