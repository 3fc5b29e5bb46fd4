"""Executors of a study: processes of this machine, or of a cluster."""

from collections.abc import Callable, Iterator
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

PROCESSES, DASK = "processes", "dask"
SPECIFICATIONS = (
    f"{PROCESSES}, {DASK}, {DASK}:tcp://HOST:PORT or MODULE:FACTORY"
)
CONNECTION_TIME = 10.0  # in which a scheduler must answer, in [s]
UNKNOWN_WORKERS = 64  # assumed where an executor does not tell
DASK_LOSSES = ("KilledWorker", "FutureCancelledError")


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


def check_executor(specification: str) -> None:
    """Check the form of a specification; see :func:`open_executor`."""
    name, colon, rest = specification.partition(":")
    if not (
        specification in (PROCESSES, DASK)
        or (colon and rest and name not in ("", PROCESSES))
    ):
        raise ConfigurationError(
            f"executor must be {SPECIFICATIONS}, got {specification!r:.80}"
        )


@contextmanager
def open_executor(
    executor: Executor | str | None, workers: int | None = None
) -> Iterator[Executor]:
    """Start the workers of a study; end them with the ``with`` block.

    An executor is ``processes`` of this machine; ``dask`` for a local Dask
    cluster, ``dask:ADDRESS`` for a running one; MODULE:FACTORY, a function
    that takes the number of workers and returns an executor of
    ``concurrent.futures``; None for this process. An executor is returned as
    it is, and stays open. By default there is a process for each core.

    Raises:
        ConfigurationError: If there is no such executor.
        CampaignError: If it cannot be reached.
    """
    if executor is None:
        yield InlineExecutor()
        return
    if isinstance(executor, Executor):
        yield executor
        return
    check_executor(executor)
    name, _, rest = executor.partition(":")
    if name == PROCESSES:
        with pools.worker_pool(workers) as pool:
            yield pool
    elif name == DASK:
        with _open_dask(rest, workers) as client:
            yield client.get_executor(pure=False)
    else:
        with _made_by(name, rest, workers) as made:
            yield made


def workers_of(executor: Executor) -> int:
    """Return the number of workers; 0 for this process."""
    if isinstance(executor, InlineExecutor):
        return 0
    return int(getattr(executor, "_max_workers", UNKNOWN_WORKERS))


def is_loss(error: BaseException) -> bool:
    """Return whether an error of a task means that its worker was lost."""
    return (
        isinstance(error, BrokenExecutor | CancelledError)
        or type(error).__name__ in DASK_LOSSES
    )


@contextmanager
def _open_dask(address: str, workers: int | None) -> Iterator[Any]:
    """Connect to a Dask scheduler, or start a local one."""
    from distributed import Client

    local = {
        "n_workers": workers,
        "threads_per_worker": 1,
        "dashboard_address": ":0",
    }
    try:
        client = (
            Client(address, timeout=CONNECTION_TIME)
            if address
            else Client(**local)
        )
    except (OSError, ValueError) as error:
        raise CampaignError(
            f"no Dask scheduler answers at {address}: {error}"
        ) from error
    with client:
        yield client


def _made_by(module: str, name: str, workers: int | None) -> Executor:
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
    return executor
