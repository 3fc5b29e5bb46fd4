"""Executors of a campaign: processes of this machine, or of a cluster."""

import os
from collections.abc import Callable, Iterable, Iterator
from concurrent.futures import (
    BrokenExecutor,
    CancelledError,
    Executor,
    Future,
)
from contextlib import contextmanager
from importlib import import_module
from typing import Any

from ..core import worker_pool as pools
from ..core.errors import CampaignError, ConfigurationError
from .code_version import installation

Losses = tuple[type[BaseException], ...]
POOL = "pool"
SPECIFICATIONS = f"{POOL} or MODULE:FACTORY"
WINDOW = 4  # blocks submitted at a time, for each worker
UNKNOWN_WORKERS = 64  # assumed where an executor does not tell


class Engine:
    """Executor of the blocks of a campaign.

    Attributes:
        workers: Number of cases that are measured at a time.
        largest_block: Largest number of cases in a block.
        losses: Errors that mean that a worker was lost.
    """

    def __init__(
        self,
        executor: Executor,
        workers: int,
        *,
        largest_block: int = 1_000_000,
        losses: Losses = (),
        start: Callable[[], Executor] | None = None,
    ) -> None:
        """Use an executor.

        Args:
            executor: Executor, which the caller closes.
            workers: Number of cases that are measured at a time.
            largest_block: Largest number of cases in a block.
            losses: Errors that mean that a worker was lost, besides those
                of ``concurrent.futures``.
            start: Starts another executor after a worker was lost; None if
                the executor itself replaces lost workers.
        """
        self.workers, self.largest_block = workers, largest_block
        self.losses: Losses = (BrokenExecutor, CancelledError, *losses)
        self._executor, self._start = executor, start

    @classmethod
    def of(cls, executor: Executor | None) -> "Engine":
        """Return an engine for any executor; None for this process."""
        if executor is None:
            return cls(InlineExecutor(), 1, largest_block=1)
        workers = getattr(executor, "_max_workers", UNKNOWN_WORKERS)
        return cls(executor, workers)

    @property
    def window(self) -> int:
        """Number of blocks that are submitted at a time."""
        inline = isinstance(self._executor, InlineExecutor)
        return 1 if inline else WINDOW * self.workers

    def submit(self, *task: Any) -> Future[Any]:
        """Submit a task; see :class:`concurrent.futures.Executor`."""
        return self._executor.submit(*task)

    def cancel(self, futures: Iterable[Future[Any]]) -> None:
        """Cancel tasks that have not started."""
        pools.cancel_pending(self._executor, futures)

    def restart(self) -> bool:
        """Replace a broken executor; return whether work can go on."""
        broken = getattr(self._executor, "_broken", False)
        if broken and self._start is not None:
            self._executor = self._start()
            return True
        return not broken

    def close(self) -> None:
        """End the workers."""
        self._executor.__exit__(None, None, None)

    def check_installation(self, found: str) -> None:
        """Compare the installation of a worker with that of this process.

        Raises:
            CampaignError: If they differ.
        """
        if found != installation():
            raise CampaignError(
                "workers must have the code and libraries of this process, "
                f"got {found} there and {installation()} here (stepaside, "
                "Python and libraries); their results are not used"
            )


class InlineExecutor(Executor):
    """Executor that runs each task at once, in this process."""

    def submit(
        self, fn: Callable[..., Any], /, *args: Any, **kwargs: Any
    ) -> Future[Any]:
        """Run a task; its errors are in the future, Ctrl-C is raised."""
        future: Future[Any] = Future()
        try:
            future.set_result(fn(*args, **kwargs))
        except Exception as error:
            future.set_exception(error)
        return future


@contextmanager
def open_engine(
    specification: str = POOL, workers: int | None = None
) -> Iterator[Engine]:
    """Start the workers of a campaign; end them with the ``with`` block.

    Args:
        specification: ``pool`` for processes of this machine; or
            MODULE:FACTORY, a function that takes the number of workers and
            returns an executor of ``concurrent.futures``.
        workers: Number of processes; all cores by default. The size of a
            running cluster is its own.

    Raises:
        ConfigurationError: If there is no such executor.
        CampaignError: If it cannot be reached.
    """
    check_executor(specification)
    name, _, rest = specification.partition(":")
    if name == POOL:
        opened = _open_pool(workers)
    else:
        opened = _open_factory(name, rest, workers)
    with opened as engine:
        yield engine


def check_executor(specification: str) -> None:
    """Check the form of a specification; see :func:`open_engine`.

    Raises:
        ConfigurationError: If there is no such executor.
    """
    name, colon, rest = specification.partition(":")
    known = {POOL: not colon}
    if not known.get(name, colon and name and rest):
        raise ConfigurationError(
            f"executor must be {SPECIFICATIONS}, got {specification!r:.80}"
        )


@contextmanager
def _open_pool(workers: int | None) -> Iterator[Engine]:
    def start() -> Executor:
        return pools.worker_pool(workers)

    engine = Engine(start(), workers or os.cpu_count() or 1, start=start)
    try:
        yield engine
    finally:
        engine.close()


@contextmanager
def _open_factory(
    module: str, name: str, workers: int | None
) -> Iterator[Engine]:
    """Call a function of the user that returns an executor."""
    try:
        factory = getattr(import_module(module), name)
    except (ImportError, AttributeError) as error:
        raise ConfigurationError(
            f"executor must be {SPECIFICATIONS}, got {module}:{name}, which "
            f"cannot be imported: {error}"
        ) from error
    executor = factory(workers)
    if not isinstance(executor, Executor):
        raise ConfigurationError(
            f"{module}:{name} must return a concurrent.futures.Executor, "
            f"got {type(executor).__name__}"
        )
    with executor:
        yield Engine.of(executor)
