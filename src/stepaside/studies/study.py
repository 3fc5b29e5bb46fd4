"""Studies: cases, measured on any executor, and their records in SQLite."""

import json
import sqlite3
import weakref
from array import array
from collections.abc import (
    Callable,
    Iterable,
    Iterator,
    Mapping,
    Sequence,
)
from concurrent.futures import (
    FIRST_COMPLETED,
    BrokenExecutor,
    CancelledError,
    Executor,
    Future,
    wait,
)
from contextlib import ExitStack, closing, contextmanager
from dataclasses import dataclass, field
from importlib import import_module
from itertools import repeat
from math import ceil
from pathlib import Path
from time import perf_counter
from typing import Any, Generic, NamedTuple, TypeVar

from ..core import worker_pool as pools
from ..core.errors import (
    AnyPath,
    CampaignError,
    ConfigurationError,
    OutputError,
    as_path,
)
from ..core.progress import ProgressLine
from ..report.study_table import study_table
from .results_version import RESULTS, library_versions
from .tabulation import Record, tabulate, to_frame

C = TypeVar("C")
MOST_CASES = 10_000_000  # of a study; they take 9 bytes each
BLOCK_TIME = 0.5  # aimed at for a block of cases, in [s]
LARGEST_BLOCK = 10_000  # cases
GROWTH = 4  # largest ratio of the sizes of successive blocks
WINDOW = 4  # blocks submitted at a time, for each worker
BUSY = 60.0  # time in which another process must finish writing, in [s]
SCHEMA = """
CREATE TABLE IF NOT EXISTS records (
    key TEXT, results TEXT, number INTEGER, libraries TEXT, record TEXT,
    PRIMARY KEY (key, results)
)
"""
PROCESSES, DASK = "processes", "dask"
EXECUTORS = f"{PROCESSES}, {DASK}, {DASK}:tcp://HOST:PORT or MODULE:FACTORY"
CONNECTION_TIME = 10.0  # in which a scheduler must answer, in [s]
UNKNOWN_WORKERS = 64  # assumed where an executor does not tell
DASK_LOSSES = ("KilledWorker", "FutureCancelledError")


@dataclass(frozen=True)
class Study(Generic[C]):
    """Cases, and the function that measures one of them.

    Attributes:
        name: Name of the study, one word.
        cases: Cases in the order of the results, values that can be pickled;
            the sequence may compute them.
        measure: Function from a case to its record, a flat dictionary of
            values for JSON. Workers must be able to import it.
        key_of: Function from a case to a text that tells apart all cases
            with different results. Not called where nothing is stored.
        by: Values that tell the rows of the table apart.
        values: Values of the table.
    """

    name: str
    cases: Sequence[C] = field(repr=False)
    measure: Callable[[C], Record] = field(repr=False)
    key_of: Callable[[C], str] = field(repr=False)
    by: tuple[str, ...] = ()
    values: tuple[str, ...] = ()


class _BlockResult(NamedTuple):
    """Answer of a worker: records up to the first case that failed."""

    results: str
    libraries: str
    elapsed: float
    columns: list[str]
    records: list[str]
    error: BaseException | None = None


class StudyRun(Generic[C]):
    """Results of a study, as far as it is finished.

    Attributes:
        study: The study.
        file: SQLite file of the records; None if they are temporary. Its
            table ``results`` has a row for each record of the study.
        total: Number of cases; of a shard, those of the shard.
        missing: Numbers of those that had no record.
        finished: Number of those with a record.
        reused: Number of those that were recorded before.
        interrupted: Whether Ctrl-C ended the study.
        failure: Error on writing a record, which ended the study.
    """

    def __init__(
        self,
        study: Study[C],
        file: AnyPath | None = None,
        shard: tuple[int, int] = (1, 1),
    ) -> None:
        """Find the records of a study in a file, which need not exist yet.

        A shard is its number, from 1, and their number; every so manieth case
        belongs to it.
        """
        number, of = shard
        if len(study.cases) > MOST_CASES:
            raise ConfigurationError(
                f"a study must have at most {MOST_CASES} cases, got "
                f"{len(study.cases)}"
            )
        self.study = study
        self.file = None if file is None else Path(as_path(file, "file"))
        self.interrupted = False
        self.failure: OutputError | None = None
        self._base = _opened(self.file)
        self._columns = dict.fromkeys(_columns_of(self._base))
        weakref.finalize(self, self._base.close)
        done = self._find()
        own = range(number - 1, len(study.cases), of)
        self.missing = array("q", (n for n in own if not done[n]))
        self.total = len(own)
        self.finished = self.reused = self.total - len(self.missing)

    def _find(self) -> bytearray:
        """Return whether each case has a record; number the records."""
        cases, key_of = self.study.cases, self.study.key_of
        done = bytearray(len(cases))
        query = "SELECT key, number FROM records WHERE results = ?"
        found = dict(self._base.execute(query, [RESULTS]))
        numbers = dict[str, int | None].fromkeys(found)
        if found:
            for number, case in enumerate(cases):
                if (key := key_of(case)) in found:
                    numbers[key], done[number] = number, 1
        changed = [
            (number, key, RESULTS)
            for key, number in numbers.items()
            if found[key] != number
        ]
        if changed:
            with _using(self.file), self._base:
                self._base.executemany(
                    "UPDATE records SET number = ? WHERE key = ? "
                    "AND results = ?",
                    changed,
                )
        return done

    @property
    def completed(self) -> bool:
        """Whether every case has a record."""
        return self.finished == self.total

    def items(self) -> Iterator[tuple[C, Record]]:
        """Yield the finished cases and their records, in order of cases."""
        for number, text in self._base.execute(
            "SELECT number, record FROM records WHERE results = ? AND number "
            "IS NOT NULL ORDER BY number",
            [RESULTS],
        ):
            yield self.study.cases[number], json.loads(text)

    def records(self) -> Iterator[Record]:
        """Yield the records of the finished cases, in order of cases."""
        return (record for _, record in self.items())

    def table(
        self, by: Sequence[str] = (), values: Sequence[str] = ()
    ) -> list[Record]:
        """Tabulate the records; see :func:`.tabulation.tabulate`.

        Values that tell rows apart, and those of the table, are by default
        those of the study.
        """
        names = tuple(by) or self.study.by, tuple(values) or self.study.values
        return tabulate(self.records(), *names)

    def __repr__(self) -> str:
        """Name the study, and tell how much of it is finished."""
        done = f"{self.finished} of {self.total} cases"
        return f"StudyRun({self.study.name!r}, {done})"

    def __str__(self) -> str:
        """Return the table of the study as text."""
        by, values = self.study.by, self.study.values
        if not self.finished or not values:
            return repr(self)
        return study_table(self.table(), by, values)

    def to_frame(self, library: str = "polars") -> Any:
        """Return the records as a data frame of polars, or of pandas."""
        return to_frame(self.records(), library)

    def draw(self, file: AnyPath, value: str) -> None:
        """Draw a value over what varies, with its 95 % intervals."""
        from ..report.study_figures import draw_study

        path = as_path(file, "file")
        draw_study(self.table(values=[value]), self.study.by, path)

    def add(self, cases: Mapping[int, C], block: _BlockResult) -> None:
        """Store the records of numbered cases: all, or none if it raises."""
        if block.results != RESULTS:
            raise CampaignError(
                "workers must have the results version of this process, got "
                f"{block.results} there and {RESULTS} here; their records "
                "are not used"
            )
        keys = map(self.study.key_of, cases.values())
        if self.file is None:
            keys = map(str, cases)
        same = repeat(RESULTS), cases, repeat(block.libraries)
        rows = zip(keys, *same, block.records, strict=False)
        names = [c for c in block.columns if c not in self._columns]
        with _using(self.file), self._base:
            self._base.executemany(
                "INSERT OR REPLACE INTO records VALUES (?, ?, ?, ?, ?)", rows
            )
            if names:
                self._columns |= dict.fromkeys(names)
                _make_table(self._base, self._columns)
        self.finished += len(block.records)


def merge_results(parts: Iterable[AnyPath], file: AnyPath) -> int:
    """Join the records of files in another one; return their number.

    The parts stay, and so does what the other file has.

    Raises:
        ConfigurationError: If a file has no records of a study.
        OutputError: If the file cannot be written.
    """
    whole = Path(as_path(file, "file"))
    files = [Path(as_path(part, "parts")) for part in parts]
    if not sum(map(_count, files)):
        raise ConfigurationError("parts must have a record, got none")
    with closing(_opened(whole)) as base:
        columns = dict.fromkeys(_columns_of(base))
        for part in files:
            with _using(part, reads=True):
                base.execute("ATTACH ? AS part", [f"{part}"])
                columns |= dict.fromkeys(_columns_of(base, "part"))
                with _using(whole), base:
                    base.execute(
                        "INSERT OR IGNORE INTO records SELECT * FROM "
                        "part.records"
                    )
                base.execute("DETACH part")
        with _using(whole), base:
            _make_table(base, columns)
    return _count(whole)


def _count(file: Path) -> int:
    """Return the number of records in a file; 0 if it does not exist."""
    if not file.is_file():
        return 0
    with (
        _using(file, reads=True),
        closing(sqlite3.connect(file, BUSY)) as base,
    ):
        (number,) = base.execute("SELECT COUNT(*) FROM records").fetchone()
    return int(number)


def _opened(file: Path | None) -> sqlite3.Connection:
    """Open a file of records, or a temporary one."""
    with _using(file):
        if file is not None:
            file.parent.mkdir(parents=True, exist_ok=True)
        base = sqlite3.connect(file or "", BUSY, check_same_thread=False)
        with base:
            base.execute(SCHEMA)
        return base


def _columns_of(base: sqlite3.Connection, schema: str = "main") -> list[str]:
    """Return the names of the values in the table of results."""
    return [r[1] for r in base.execute(f"PRAGMA {schema}.table_info(results)")]


def _make_table(base: sqlite3.Connection, columns: Iterable[str]) -> None:
    """Make the table of results: a view of the records, by value."""
    values = []
    for name in columns:
        column = '"' + name.replace('"', '""') + '"'
        path = name.replace("'", "''")
        values.append(f"json_extract(record, '$.\"{path}\"') AS {column}")
    base.execute("DROP VIEW IF EXISTS results")
    base.execute(
        f"CREATE VIEW results AS SELECT {', '.join(values)} FROM records "
        f"WHERE results = '{RESULTS}' AND number IS NOT NULL ORDER BY number"
    )


@contextmanager
def _using(file: Path | None, *, reads: bool = False) -> Iterator[None]:
    """Raise errors of a file of records as those of this package."""
    try:
        yield
    except (sqlite3.DatabaseError, OSError) as error:
        if reads or type(error) is sqlite3.DatabaseError:  # no database
            raise ConfigurationError(
                f"{file} must be a SQLite file with records of a study: "
                f"{error}"
            ) from error
        raise OutputError(
            f"{file or 'a temporary file'} could not be written: {error}"
        ) from error


def measure_block(
    measure: Callable[[C], Record], cases: list[C]
) -> _BlockResult:
    """Measure cases one after the other, in a worker."""
    began, error = perf_counter(), None
    columns: dict[str, None] = {}
    texts: list[str] = []
    try:
        for case in cases:
            record = measure(case)
            texts.append(json.dumps(record, allow_nan=False))
            columns |= dict.fromkeys(record)
    except BaseException as raised:
        error = raised
    elapsed = perf_counter() - began
    libraries = json.dumps(library_versions())
    return _BlockResult(
        RESULTS, libraries, elapsed, list(columns), texts, error
    )


def run_study(
    study: Study[C],
    file: AnyPath | None = None,
    *,
    executor: Executor | str | None = None,
    workers: int | None = None,
    shard: tuple[int, int] = (1, 1),
    report: Callable[[StudyRun[C]], None] | None = None,
) -> StudyRun[C]:
    """Measure the cases of a study that have no record in a file yet.

    The records do not depend on the executor, on the order in which cases
    are finished, nor on how often the study was interrupted. A record counts
    if it was made with the results version of this program.

    Args:
        study: Study.
        file: SQLite file of the records, extended after each block of cases;
            None for a temporary one.
        executor: Executor of ``concurrent.futures``, or the name of one; see
            :func:`open_executor`. By default cases are measured in this
            process, or in processes if ``workers`` is given.
        workers: Number of processes; all cores by default.
        shard: Number of the shard, from 1, and number of shards.
        report: Called after each block, instead of showing the progress on
            standard error.

    Returns:
        The results. After Ctrl-C, or if a record cannot be written, they are
        partial, and say so.

    Raises:
        ConfigurationError: If there are too many cases, there is no such
            executor, or the file has no records of a study.
        CampaignError: If a worker is lost, or has another results version.
    """
    if executor is None and workers is not None:
        executor = PROCESSES
    run = StudyRun(study, file, shard)
    with ExitStack() as stack:
        if report is None:
            shown = ProgressLine(study.name, run.total, "cases")
            bar = stack.enter_context(shown)

            def report(run: StudyRun[C]) -> None:
                bar.show(run.finished, reused=run.reused)

        report(run)
        if run.completed:
            return run
        try:
            with open_executor(executor, workers) as opened:
                _measure(run, opened, report)
        except KeyboardInterrupt:
            run.interrupted = True
        except OutputError as error:
            run.failure = error
        except Exception as error:
            if not (
                isinstance(error, BrokenExecutor | CancelledError)
                or type(error).__name__ in DASK_LOSSES
            ):
                raise
            raise CampaignError(
                f"a worker was lost while measuring {study.name} "
                f"({type(error).__name__}): out of memory, or the script "
                'starts it outside `if __name__ == "__main__":`; '
                f"{run.finished} of {run.total} results are saved"
            ) from error
    return run


def _measure(
    run: StudyRun[C], executor: Executor, report: Callable[[StudyRun[C]], None]
) -> None:
    """Measure the missing cases in blocks, a few at a time."""
    study, missing, size, taken = run.study, run.missing, 1, 0
    workers = 0
    if not isinstance(executor, InlineExecutor):
        workers = getattr(executor, "_max_workers", UNKNOWN_WORKERS)
    flying: dict[Future[_BlockResult], dict[int, C]] = {}
    try:
        while True:
            while len(flying) < max(1, WINDOW * workers):
                left = len(missing) - taken
                share = ceil(left / (2 * max(workers, 1)))
                most = max(1, min(size, share))
                numbers = missing[taken : taken + most]
                if not numbers:
                    break
                taken += len(numbers)
                cases = {number: study.cases[number] for number in numbers}
                future = executor.submit(
                    measure_block, study.measure, list(cases.values())
                )
                flying[future] = cases
            if not flying:
                return
            for future in wait(flying, return_when=FIRST_COMPLETED).done:
                result = future.result()
                run.add(flying.pop(future), result)
                if result.error is not None:
                    raise result.error
                mean = max(result.elapsed, 1e-6) / len(result.records)
                size = round(
                    min(BLOCK_TIME / mean, GROWTH * size, LARGEST_BLOCK)
                )
            report(run)
    except BaseException as error:
        pools.cancel_pending(executor, flying)
        if not isinstance(error, OutputError | CampaignError):
            for future, cases in flying.items():
                if future.done() and not (
                    future.cancelled() or future.exception()
                ):
                    run.add(cases, future.result())
        raise


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


def check_executor(name: str) -> None:
    """Check the form of the name of an executor; see :func:`open_executor`."""
    module, colon, rest = name.partition(":")
    made = colon and rest and module not in ("", PROCESSES)
    if not made and name not in (PROCESSES, DASK):
        raise ConfigurationError(
            f"executor must be {EXECUTORS}, got {name!r:.80}"
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
    if not isinstance(executor, str):
        yield executor or InlineExecutor()
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
        try:
            factory = getattr(import_module(name), rest)
        except (ImportError, AttributeError, TypeError) as error:
            raise ConfigurationError(
                f"executor must be {EXECUTORS}, got {executor!r:.80}: {error}"
            ) from error
        with factory(workers) as made:
            yield made


def _open_dask(address: str, workers: int | None) -> Any:
    """Connect to a Dask scheduler, or start a local one."""
    from distributed import Client

    if not address:
        return Client(
            n_workers=workers, threads_per_worker=1, dashboard_address=":0"
        )
    try:
        return Client(address, timeout=CONNECTION_TIME)
    except (OSError, ValueError) as error:
        raise CampaignError(
            f"no Dask scheduler answers at {address}: {error}"
        ) from error
