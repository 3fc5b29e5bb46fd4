"""Studies: cases, measured on any executor, and their records in SQLite."""

import json
import sqlite3
import weakref
from array import array
from collections.abc import Callable, Iterable, Iterator, Sequence
from concurrent.futures import (
    FIRST_COMPLETED,
    Executor,
    Future,
    wait,
)
from contextlib import ExitStack, closing, contextmanager
from dataclasses import dataclass
from math import ceil
from pathlib import Path
from time import perf_counter
from typing import Any, Generic, NamedTuple, TypeVar

from ..core.errors import (
    AnyPath,
    CampaignError,
    ConfigurationError,
    OutputError,
    as_path,
)
from ..core.progress import show_progress
from ..core.worker_pool import cancel_pending
from .executors import is_loss, open_executor, workers_of
from .results_version import RESULTS, library_versions
from .tabulation import Record, tabulate, to_frame

C = TypeVar("C")
MOST_CASES = 10_000_000  # of a study; they take 9 bytes each
BLOCK_TIME = 0.5  # aimed at for a block of cases, in [s]
LARGEST_BLOCK = 1000  # cases
GROWTH = 4  # largest ratio of the sizes of successive blocks
WINDOW = 4  # blocks submitted at a time, for each worker
BUSY = 60.0  # time in which another process must finish writing, in [s]
SCHEMA = """
CREATE TABLE IF NOT EXISTS records (
    key TEXT, results TEXT, number INTEGER, libraries TEXT, record TEXT,
    PRIMARY KEY (key, results)
)
"""


@dataclass(frozen=True)
class Study(Generic[C]):
    """Cases, and the function that measures one of them."""

    name: str  # name of the study, one word
    # cases in the order of the results. Each is a value that can be pickled. A
    # long list need not be in memory: a ``range`` computes its items
    cases: Sequence[C]
    # function from a case to its record, a flat dictionary of values for JSON.
    # It must be importable in a worker process, and depend neither on other
    # cases nor on the executor
    measure: Callable[[C], Record]
    # returns the key of a case: a text that tells apart all cases with
    # different results. Not called where nothing is stored
    key_of: Callable[[C], str]
    by: tuple[str, ...] = ()  # values that tell the rows of the table apart
    values: tuple[str, ...] = ()  # values of the table


class StudyProgress(NamedTuple):
    """Progress of a study."""

    finished: int  # number of cases with a record
    reused: int  # number of those that were recorded before it began
    total: int  # number of cases


class StudyRun(Generic[C]):
    """Results of a study, as far as it is finished.

    Attributes:
        study: The study.
        file: SQLite file of the records; None if they are temporary. Its
            table ``results`` has a row for each record of the study.
        total: Number of cases; of a shard, those of the shard.
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
        self.study, self.file = (
            study,
            None if file is None else Path(as_path(file, "file")),
        )
        self.interrupted = False
        self.failure: OutputError | None = None
        self._base = _opened(self.file)
        self._columns = dict.fromkeys(_columns_of(self._base))
        weakref.finalize(self, self._base.close)
        done = self._find()
        own = range(number - 1, len(study.cases), of)
        self._missing = array("q", (n for n in own if not done[n]))
        self._next = 0
        self.total = len(own)
        self.finished = self.reused = self.total - len(self._missing)

    def _find(self) -> bytearray:
        """Return whether each case has a record; number the records."""
        cases, key_of = self.study.cases, self.study.key_of
        done = bytearray(len(cases))
        if self.file is None:
            return done
        found = dict(
            self._base.execute(
                "SELECT key, number FROM records WHERE results = ?", [RESULTS]
            )
        )
        if not found:
            return done
        changed: list[tuple[int | None, str, str]] = []
        for number, case in enumerate(cases):
            key = key_of(case)
            if key in found:
                done[number] = 1
                if found.pop(key) != number:
                    changed.append((number, key, RESULTS))
        for key, old in found.items():
            if old is not None:
                changed.append((None, key, RESULTS))
        if changed:
            with _writing(self.file), self._base:
                self._base.executemany(
                    "UPDATE records SET number = ? WHERE key = ? "
                    "AND results = ?",
                    changed,
                )
        return done

    @property
    def progress(self) -> "StudyProgress":
        """Number of cases with a record, of those reused, and of all."""
        return StudyProgress(self.finished, self.reused, self.total)

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

    def to_frame(self, library: str = "polars") -> Any:
        """Return the records as a data frame of polars, or of pandas."""
        return to_frame(self.records(), library)

    def draw(self, file: AnyPath, value: str) -> None:
        """Draw a value over what varies, with its 95 % intervals."""
        from ..report.study_figures import draw_study

        path = as_path(file, "file")
        draw_study(self.table(values=[value]), self.study.by, path)

    def take(self, most: int) -> list[int]:
        """Return the numbers of the next cases without a record."""
        numbers = self._missing[self._next : self._next + most].tolist()
        self._next += len(numbers)
        return numbers

    @property
    def left(self) -> int:
        """Number of cases without a record that were not taken yet."""
        return len(self._missing) - self._next

    def add(self, numbers: Iterable[int], block: "_BlockResult") -> None:
        """Store the records of a block: all, or none if it raises."""
        cases, key_of = self.study.cases, self.study.key_of
        stored = self.file is not None
        rows = [
            (
                key_of(cases[number]) if stored else str(number),
                *(RESULTS, number, block.libraries, text),
            )
            for number, text in zip(numbers, block.records, strict=False)
        ]
        names = [c for c in block.columns if c not in self._columns]
        with _writing(self.file), self._base:
            self._base.executemany(
                "INSERT OR REPLACE INTO records VALUES (?, ?, ?, ?, ?)", rows
            )
            if names:
                self._columns |= dict.fromkeys(names)
                _make_table(self._base, self._columns)
        self.finished += len(rows)


def merge_results(parts: Iterable[AnyPath], file: AnyPath) -> int:
    """Join the records of files in another one; return their number.

    The parts stay, and so does what the other file has.

    Raises:
        ConfigurationError: If a file has no records of a study.
        OutputError: If the file cannot be written.
    """
    whole = Path(as_path(file, "file"))
    files = [Path(as_path(part, "parts")) for part in parts]
    if not sum(map(count_records, files)):
        raise ConfigurationError("parts must have a record, got none")
    base = _opened(whole)
    try:
        columns = dict.fromkeys(_columns_of(base))
        for part in files:
            with _reading(part):
                base.execute("ATTACH ? AS part", [str(part)])
                columns |= dict.fromkeys(_columns_of(base, "part"))
                with _writing(whole), base:
                    base.execute(
                        "INSERT OR IGNORE INTO records SELECT * FROM "
                        "part.records"
                    )
                base.execute("DETACH part")
        with _writing(whole), base:
            _make_table(base, columns)
        (number,) = base.execute("SELECT COUNT(*) FROM records").fetchone()
    finally:
        base.close()
    return int(number)


def count_records(file: Path) -> int:
    """Return the number of records in a file; 0 if it does not exist."""
    if not file.is_file():
        return 0
    with _reading(file), closing(sqlite3.connect(file, BUSY)) as base:
        (number,) = base.execute("SELECT COUNT(*) FROM records").fetchone()
    return int(number)


def _opened(file: Path | None) -> sqlite3.Connection:
    """Open a file of records, or a temporary one."""
    with _reading(file):
        if file is not None:
            with _writing(file):
                file.parent.mkdir(parents=True, exist_ok=True)
        base = sqlite3.connect(file or "", BUSY, check_same_thread=False)
        with _writing(file), base:
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
def _writing(file: Path | None) -> Iterator[None]:
    """Raise errors on writing a file as :class:`OutputError`."""
    try:
        yield
    except (sqlite3.OperationalError, OSError) as error:
        raise OutputError(
            f"{file or 'a temporary file'} could not be written: {error}"
        ) from error


@contextmanager
def _reading(file: Path | None) -> Iterator[None]:
    """Raise errors of a foreign file as :class:`ConfigurationError`."""
    try:
        yield
    except sqlite3.DatabaseError as error:
        raise ConfigurationError(
            f"{file} must be a SQLite file with records of a study: {error}"
        ) from error


class _BlockResult(NamedTuple):
    """Answer of a worker: records up to the first case that failed."""

    results: str
    libraries: str
    elapsed: float
    columns: list[str]
    records: list[str]
    error: BaseException | None = None


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
    report: Callable[[StudyProgress], None] | None = None,
) -> StudyRun[C]:
    """Measure the cases of a study that have no record in a file yet.

    The records do not depend on the executor, on the order in which cases
    are finished, nor on how often the study was interrupted. A record counts
    if it was made with the results version of this program.

    Args:
        study: Study.
        file: SQLite file of the records, extended after each block of cases;
            None for a temporary one.
        executor: Name of an executor, see
            :func:`~stepaside.studies.executors.open_executor`, or any
            executor of ``concurrent.futures``. By default cases are measured
            in this process, or in processes if ``workers`` is given.
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
        executor = "processes"
    run = StudyRun(study, file, shard)
    with ExitStack() as stack:
        if report is None:
            report = _shown(
                stack.enter_context(
                    show_progress(study.name, run.total, "cases")
                )
            )
        report(run.progress)
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
            if not is_loss(error):
                raise
            raise CampaignError(
                f"a worker was lost while measuring {study.name} "
                f"({type(error).__name__}), possibly out of memory; "
                f"{run.finished} of {run.total} results are saved"
            ) from error
    return run


def _shown(bar: Any) -> Callable[[StudyProgress], None]:
    """Return a function that shows the progress on a bar."""

    def show(progress: StudyProgress) -> None:
        bar.initial, bar.n = progress.reused, progress.finished
        bar.refresh()

    return show


def _measure(
    run: StudyRun[C],
    executor: Executor,
    report: Callable[[StudyProgress], None],
) -> None:
    """Measure the missing cases in blocks, a few at a time."""
    study, workers, size = run.study, workers_of(executor), 1
    flying: dict[Future[_BlockResult], list[int]] = {}
    try:
        while True:
            while len(flying) < max(1, WINDOW * workers):
                share = ceil(run.left / (2 * max(workers, 1)))
                numbers = run.take(max(1, min(size, share)))
                if not numbers:
                    break
                cases = [study.cases[number] for number in numbers]
                future = executor.submit(measure_block, study.measure, cases)
                flying[future] = numbers
            if not flying:
                return
            for future in wait(flying, return_when=FIRST_COMPLETED).done:
                result = future.result()
                _store(run, flying.pop(future), result)
                if result.error is not None:
                    raise result.error
                mean = max(result.elapsed, 1e-6) / len(result.records)
                size = round(
                    min(BLOCK_TIME / mean, GROWTH * size, LARGEST_BLOCK)
                )
            report(run.progress)
    except BaseException as error:
        cancel_pending(executor, flying)
        if not isinstance(error, OutputError | CampaignError):
            for future, numbers in flying.items():
                if future.done() and not (
                    future.cancelled() or future.exception()
                ):
                    _store(run, numbers, future.result())
        raise


def _store(run: StudyRun[C], numbers: list[int], result: _BlockResult) -> None:
    """Store the answer of a worker."""
    if result.results != RESULTS:
        raise CampaignError(
            "workers must have the results version of this process, got "
            f"{result.results} there and {RESULTS} here; their records are "
            "not used"
        )
    run.add(numbers, result)
