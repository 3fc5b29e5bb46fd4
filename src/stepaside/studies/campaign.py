"""Campaigns: the cases of a study, measured on any executor, and stored."""

from array import array
from collections.abc import Callable, Iterator, Mapping, Sequence
from concurrent.futures import FIRST_COMPLETED, Executor, Future, wait
from dataclasses import dataclass, replace
from functools import cache
from math import ceil
from time import perf_counter
from typing import TYPE_CHECKING, Any, Generic, NamedTuple, TypeVar

from ..core.errors import CampaignError, OutputError
from .code_version import code_version, installation, library_versions
from .executors import Engine
from .records import Record
from .result_store import (
    RecordIndex,
    RecordWriter,
    ResultStore,
    stamp_text,
)
from .result_table import to_frame

if TYPE_CHECKING:
    import polars

C = TypeVar("C")
BLOCK_TIME = 0.5  # aimed at for a block of cases, in [s]
LARGEST_BLOCK = 1000  # cases
GROWTH = 4  # largest ratio of the sizes of successive blocks
PATIENCE = 30.0  # without a result, before workers are counted, in [s]
ATTEMPTS = 3  # for a block whose worker is lost
MISSING = -1  # position of a case without a record


class CodeStamp(NamedTuple):
    """Versions on which the record of a case depends.

    Attributes:
        version: Fingerprint of the code; see :func:`code_version`.
        libraries: Installed versions of the libraries, by name.
    """

    version: str
    libraries: Mapping[str, str | None]

    @property
    def text(self) -> str:
        """Stamp as text, for an index of records."""
        return stamp_text(self._asdict())


@cache
def code_stamp(
    modules: tuple[str, ...], libraries: tuple[str, ...]
) -> CodeStamp:
    """Return the stamp of the present code and libraries.

    Args:
        modules: Modules that measure a case; see :func:`code_version`.
        libraries: Libraries on which the record depends.
    """
    return CodeStamp(code_version(modules), library_versions(libraries))


@dataclass(frozen=True)
class Study(Generic[C]):
    """Cases, and the function that measures one of them.

    Attributes:
        name: Name of the study, one word.
        cases: Cases in the order of the results. Each is a value that can be
            pickled. A long list need not be in memory: a ``range`` or a
            :class:`~stepaside.studies.case_grid.CaseGrid` computes its items.
        measure: Function from a case to its record, importable in a worker
            process. It must not depend on other cases nor on the executor.
        key_of: Returns the key of a case: a text that tells apart all cases
            with different results.
        stamp_of: Returns the stamp of a case.
        fields: Values that every record has.
        volatile: Values that depend on the machine, like computing times.
        measure_together: Function from several cases to their records, equal
            to those of ``measure``; None to measure one after the other.
        together: Number of cases that are measured together.
    """

    name: str
    cases: Sequence[C]
    measure: Callable[[C], Record]
    key_of: Callable[[C], str]
    stamp_of: Callable[[C], CodeStamp]
    fields: tuple[str, ...] = ()
    volatile: tuple[str, ...] = ()
    measure_together: Callable[[list[C]], list[Record]] | None = None
    together: int = 1

    def shard(self, number: int, of: int) -> "Study[C]":
        """Return every ``of``-th case.

        Args:
            number: Number of the shard, from 1.
            of: Number of shards.
        """
        return replace(self, cases=self.cases[number - 1 :: of])


class CampaignProgress(NamedTuple):
    """CampaignProgress of a campaign.

    Attributes:
        finished: Number of cases with a record.
        reused: Number of those that were recorded before it began.
        total: Number of cases.
    """

    finished: int
    reused: int
    total: int


class StudyRun(Generic[C]):
    """Results of a study, as far as it is finished.

    Records stay in the store: in memory a case takes 8 bytes.

    Attributes:
        study: The study.
        store: Store of the records.
        reused: Number of cases that were recorded before.
        interrupted: Whether Ctrl-C ended the campaign.
        failure: Error on writing a record, which ended the campaign.
    """

    def __init__(self, study: Study[C], store: ResultStore) -> None:
        """Find the records of a study in a store.

        Args:
            study: Study.
            store: Store, with the records of any studies.
        """
        self.study, self.store = study, store
        self.interrupted = False
        self.failure: OutputError | None = None
        self._positions = array("q", [MISSING]) * len(study.cases)
        index = RecordIndex(store, study.fields)
        if index:
            for number, case in enumerate(study.cases):
                stamp = study.stamp_of(case).text
                found = index.find(study.key_of(case), stamp)
                if found is not None:
                    self._positions[number] = found
        self.reused = self.finished = len(study.cases) - sum(
            position == MISSING for position in self._positions
        )

    def __len__(self) -> int:
        """Return the number of cases with a record."""
        return self.finished

    @property
    def completed(self) -> bool:
        """Whether every case has a record."""
        return self.finished == len(self.study.cases)

    def missing(self) -> Iterator[int]:
        """Yield the numbers of the cases without a record."""
        for number, position in enumerate(self._positions):
            if position == MISSING:
                yield number

    def items(self) -> Iterator[tuple[C, Record]]:
        """Yield the finished cases and their records, in order of cases."""
        for number, position in enumerate(self._positions):
            if position != MISSING:
                record = self.store.record_at(position)
                yield self.study.cases[number], record

    def records(self) -> Iterator[Record]:
        """Yield the records of the finished cases, in order of cases."""
        for position in self._positions:
            if position != MISSING:
                yield self.store.record_at(position)

    def to_frame(self) -> "polars.DataFrame":
        """Return the records as a polars frame, one row per case.

        Raises:
            ModuleNotFoundError: Without the extra ``tables``.
        """
        return to_frame(self.records())

    def append(
        self, writer: RecordWriter, block: "_Block", records: list[Record]
    ) -> None:
        """Store the records of the first cases of a block.

        Raises:
            OutputError: If they cannot be written.
        """
        entries = []
        for number, record in zip(block.numbers, records, strict=False):
            case = self.study.cases[number]
            stamp = self.study.stamp_of(case)._asdict()
            entries.append((self.study.key_of(case), record | stamp))
        positions = writer.append(entries)
        for number, position in zip(block.numbers, positions, strict=False):
            self._positions[number] = position
        self.finished += len(positions)


class _Block(NamedTuple):
    """Cases that are measured in one task of an executor."""

    numbers: list[int]
    attempts: int = 1


class _BlockResult(NamedTuple):
    """Answer of a worker: records up to the first case that failed."""

    installation: str
    elapsed: float
    records: list[Record]
    error: Exception | None = None


def measure_block(
    measure: Callable[[C], Record], cases: list[C]
) -> _BlockResult:
    """Measure cases one after the other, in a worker."""
    return measure_groups(lambda group: [measure(group[0])], 1, cases)


def measure_groups(
    measure_together: Callable[[list[C]], list[Record]],
    together: int,
    cases: list[C],
) -> _BlockResult:
    """Measure cases in a worker, some together."""
    began, records = perf_counter(), list[Record]()
    error = None
    try:
        for first in range(0, len(cases), together):
            records += measure_together(cases[first : first + together])
    except Exception as raised:
        error = raised
    elapsed = perf_counter() - began
    return _BlockResult(installation(), elapsed, records, error)


def run_study(
    study: Study[C],
    store: ResultStore | None = None,
    executor: Executor | Engine | None = None,
    report: Callable[[CampaignProgress], None] | None = None,
    on_loss: Callable[[str], None] = lambda message: None,
) -> StudyRun[C]:
    """Measure the cases of a study that have no record in a store yet.

    The records do not depend on the executor, on the order in which cases
    are finished, nor on how often the campaign was interrupted.

    Args:
        study: Study.
        store: Store, extended by each record; None for a temporary one.
            Records of other versions of code or libraries do not count.
        executor: Any executor of ``concurrent.futures``, or an engine of
            :func:`~stepaside.studies.executors.open_engine`; None to measure
            in this process.
        report: Called after each block.
        on_loss: Called with a message when a worker is lost and its cases
            are submitted again.

    Returns:
        The results. After Ctrl-C, or if a record cannot be written, they are
        partial, and say so.

    Raises:
        CampaignError: If workers are lost again and again, or if one has
            another version of code or libraries.
    """
    run = StudyRun(study, store or ResultStore.temporary())
    engine = executor if isinstance(executor, Engine) else Engine.of(executor)
    with run.store.writer() as writer:
        _Campaign(run, engine, writer, report, on_loss).complete()
    return run


class _Campaign(Generic[C]):
    """Submits the missing cases of a run in blocks, a few at a time."""

    def __init__(
        self,
        run: StudyRun[C],
        engine: Engine,
        writer: RecordWriter,
        report: Callable[[CampaignProgress], None] | None,
        on_loss: Callable[[str], None],
    ) -> None:
        self._run, self._engine, self._writer = run, engine, writer
        self._report, self._on_loss = report, on_loss
        self._cases = run.study.cases
        self._missing = run.missing()
        self._left = len(run.study.cases) - run.finished
        self._again: list[_Block] = []
        self._in_flight: dict[Future[_BlockResult], _Block] = {}
        self._size = 1
        self._lost = 0

    def complete(self) -> None:
        """Run until nothing is missing, or until the campaign is stopped."""
        try:
            self._tell()
            while self._submit() or self._in_flight:
                done = wait(self._in_flight, PATIENCE, FIRST_COMPLETED).done
                for future in done:
                    self._take(future)
                self._tell_loss()
                if not done and self._engine.is_deserted:
                    self._on_loss("the scheduler has no workers; waiting")
        except KeyboardInterrupt:
            self._run.interrupted = True
            self._stop()
        except OutputError as error:
            self._run.failure = error
            self._engine.cancel(self._in_flight)
        except BaseException:
            self._stop()
            raise

    def _submit(self) -> bool:
        """Fill the window of blocks; return whether anything is left."""
        while len(self._in_flight) < self._engine.window:
            block = self._again.pop() if self._again else self._next()
            if not block.numbers:
                return False
            cases = [self._cases[number] for number in block.numbers]
            study = self._run.study
            task: tuple[Any, ...] = measure_block, study.measure, cases
            if study.measure_together is not None:
                group = study.measure_together, study.together
                task = measure_groups, *group, cases
            try:
                future = self._engine.submit(*task)
            except self._engine.losses as error:
                self._lose(block, error)
                continue
            self._in_flight[future] = block
        return True

    def _next(self) -> _Block:
        share = ceil(self._left / (2 * self._engine.workers))
        size = max(self._size, self._run.study.together)
        size = max(1, min(size, self._engine.largest_block, share))
        numbers = [n for _, n in zip(range(size), self._missing, strict=False)]
        self._left -= len(numbers)
        return _Block(numbers)

    def _take(self, future: Future[_BlockResult]) -> None:
        """Store the answer of a worker."""
        block = self._in_flight.pop(future)
        try:
            result = future.result()
        except self._engine.losses as error:
            self._lose(block, error)
            return
        self._engine.check_installation(result.installation)
        self._run.append(self._writer, block, result.records)
        if result.error is not None:
            raise result.error
        mean = max(result.elapsed, 1e-6) / len(block.numbers)
        self._size = round(
            min(BLOCK_TIME / mean, GROWTH * self._size, LARGEST_BLOCK)
        )
        self._tell()

    def _lose(self, block: _Block, error: BaseException) -> None:
        """Submit a block again whose worker was lost."""
        if block.attempts >= ATTEMPTS or not self._engine.restart():
            raise CampaignError(
                f"workers were lost while measuring {self._run.study.name} "
                f"({type(error).__name__}), possibly out of memory; "
                f"{self._run.finished} of {len(self._cases)} results are "
                "saved"
            ) from error
        self._lost += len(block.numbers)
        self._again.append(block._replace(attempts=block.attempts + 1))

    def _tell_loss(self) -> None:
        """Say how many cases were lost with a worker since the last time."""
        if self._lost:
            self._on_loss(
                f"a worker was lost; {self._lost} cases in progress are "
                "submitted again"
            )
            self._lost = 0

    def _stop(self) -> None:
        """Store what is finished, and cancel the rest."""
        self._engine.cancel(self._in_flight)
        for future, block in self._in_flight.items():
            if not future.done() or future.cancelled() or future.exception():
                continue
            result = future.result()
            if result.installation == installation():
                self._run.append(self._writer, block, result.records)

    def _tell(self) -> None:
        if self._report is not None:
            run = self._run
            total = len(self._cases)
            self._report(CampaignProgress(run.finished, run.reused, total))
