"""Executors of a campaign: processes of this machine, or of a cluster."""

import os
import shutil
import sys
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
from ..core.compilation import cache_folder
from ..core.errors import CampaignError, ConfigurationError
from .code_version import installation

Losses = tuple[type[BaseException], ...]
POOL, DASK, SLURM, MPI = "pool", "dask", "slurm", "mpi"
SPECIFICATIONS = (
    f"{POOL}, {DASK}, {DASK}:tcp://HOST:PORT, {SLURM}, {MPI} or MODULE:FACTORY"
)
CONNECTION_TIME = 10.0  # in which a scheduler must answer, in [s]
SLURM_MEMORY = "2GB"  # of each worker, above what docs/campaigns.md measures
SLURM_CONFIGURATION = "jobqueue.slurm"  # of Dask, for partition and limits
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
        count: Callable[[], int] | None = None,
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
            count: Returns the present number of workers, where it may be
                none.
        """
        self.workers, self.largest_block = workers, largest_block
        self.losses: Losses = (BrokenExecutor, CancelledError, *losses)
        self._executor, self._start = executor, start
        self._count = count

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

    @property
    def is_deserted(self) -> bool:
        """Whether there is no worker now."""
        return self._count is not None and self._count() == 0

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
        specification: ``pool`` for processes of this machine; ``dask`` for a
            local Dask cluster, ``dask:ADDRESS`` for a running one; ``slurm``
            for Dask workers in jobs of Slurm; ``mpi`` for the ranks of a
            program started by ``mpiexec``; or MODULE:FACTORY, a function
            that takes the number of workers and returns an executor of
            ``concurrent.futures``.
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
    elif name == DASK:
        opened = _open_dask(rest, workers)
    elif name == SLURM:
        opened = _open_slurm(workers)
    elif name == MPI:
        opened = _open_mpi()
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
    alone = {POOL, SLURM, MPI, DASK} if not colon else set()
    with_rest = bool(colon and rest and name not in ("", POOL, SLURM, MPI))
    if name not in alone and not with_rest:
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
def _open_dask(address: str, workers: int | None) -> Iterator[Engine]:
    """Connect to a Dask scheduler, or start a local one."""
    from distributed import Client, LocalCluster

    cluster = None
    if not address:
        cluster = LocalCluster(
            n_workers=workers or os.cpu_count() or 1,
            threads_per_worker=1,
            dashboard_address=":0",
        )
    try:
        try:
            client = Client(cluster or address, timeout=CONNECTION_TIME)
        except (OSError, ValueError) as error:
            raise CampaignError(
                f"no Dask scheduler answers at {address}: {error}"
            ) from error
        with _dask_engine(
            client, len(client.scheduler_info()["workers"])
        ) as engine:
            yield engine
    finally:
        if cluster is not None:
            cluster.close()


@contextmanager
def _open_slurm(workers: int | None) -> Iterator[Engine]:
    """Submit Slurm jobs with one Dask worker each.

    Partition, account, time limit and memory of the jobs come from the
    configuration of Dask (``jobqueue.slurm``). The output of jobs is in
    the cache folder, unless the configuration has a ``log-directory``.
    """
    import dask
    from dask_jobqueue import SLURMCluster
    from distributed import Client

    if workers is None:
        raise ConfigurationError(
            "workers must be given for executor slurm [jobs], got none"
        )
    if shutil.which("sbatch") is None:
        raise CampaignError(
            "executor slurm needs the command sbatch of Slurm, which is not "
            "on the path"
        )
    chosen = dask.config.get(SLURM_CONFIGURATION, {})
    logs = chosen.get("log-directory") or str(cache_folder() / "slurm")
    with SLURMCluster(
        cores=1,
        processes=1,
        memory=chosen.get("memory") or SLURM_MEMORY,
        log_directory=logs,
        python=sys.executable,
        scheduler_options={"dashboard_address": ":0"},
    ) as cluster:
        cluster.scale(jobs=workers)
        client = Client(cluster, timeout=CONNECTION_TIME)
        with _dask_engine(client, workers) as engine:
            yield engine


@contextmanager
def _dask_engine(client: Any, workers: int) -> Iterator[Engine]:
    """Use a client of Dask, which submits tasks of lost workers again."""
    from distributed.client import FutureCancelledError
    from distributed.scheduler import KilledWorker

    losses = (KilledWorker, FutureCancelledError)
    with client, client.get_executor(pure=False) as executor:
        yield Engine(
            executor,
            max(workers, 1),
            losses=losses,
            count=lambda: len(client.scheduler_info()["workers"]),
        )


@contextmanager
def _open_mpi() -> Iterator[Engine]:
    """Use the ranks of this MPI program but the first as workers."""
    from mpi4py import MPI as ranks
    from mpi4py.futures import MPIPoolExecutor

    if ranks.COMM_WORLD.Get_size() < 2:
        raise ConfigurationError(
            "executor mpi must be started by `mpiexec -n RANKS python -m "
            "mpi4py.futures -m stepaside ...` with RANKS >= 2, got 1 rank"
        )
    with MPIPoolExecutor() as executor:
        yield Engine(executor, executor.num_workers)


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
