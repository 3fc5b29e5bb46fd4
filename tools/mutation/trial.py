"""Execution of the tests that reach one fault."""

import json
import os
import sys
from collections.abc import Collection, Iterable, Mapping
from math import inf
from pathlib import Path

import pytest

from .child import allow, cpu_time, run_tests

QUICK = 0.5  # slower tests, in [s], run only after all faster ones passed
RAN = (0, 1)  # exit statuses of pytest after tests ran
START = 60.0  # processor time to import and collect, in [s]
SPARE = 10.0  # extra processor time of any test, in [s]
COMPILING = 60.0  # the same where functions are recompiled, in [s]
PATIENCE = 2.0  # allowed ratio to the usual time of tests


class Judge:
    """Pytest plugin that runs chosen tests and stops at the first failure.

    Args:
        times: Usual processor time of each chosen test, in [s].
        note: File that names the running test.
        spare: Extra processor time of any test, in [s].
    """

    def __init__(
        self, times: Mapping[str, float], note: Path, spare: float = SPARE
    ) -> None:
        self._times = dict(times)
        self._note = note
        self._spare = spare
        self._until = inf  # processor time after which no further test begins
        self.red = ""

    def pytest_collection_modifyitems(self, items: list[pytest.Item]) -> None:
        """Keep the chosen tests, fast ones first.

        A fault may change the parameters in the name of a test. If the
        chosen test of a function no longer exists, run its other tests.
        """
        gone = {
            _function(test): time
            for test, time in self._times.items()
            if test not in {item.nodeid for item in items}
        }
        for item in items:
            if _function(item.nodeid) in gone:
                time = gone[_function(item.nodeid)]
                self._times.setdefault(item.nodeid, time)
        items[:] = [item for item in items if item.nodeid in self._times]
        items.sort(key=lambda item: rank(item.nodeid, self._times))
        usual = sum(self._times[item.nodeid] for item in items)
        self._until = cpu_time() + PATIENCE * usual + self._spare

    def pytest_runtest_protocol(self) -> bool | None:
        """Skip the remaining tests when they take much longer than usual.

        The last test that shares an expensive fixture may take its whole time.
        """
        return True if cpu_time() > self._until else None

    def pytest_runtest_logstart(self, nodeid: str) -> None:
        """Record the running test, and limit its time."""
        self._note.write_text(nodeid, encoding="utf-8")
        allow(self._spare + 5.0 * self._times[nodeid])

    def pytest_runtest_logreport(self, report: pytest.TestReport) -> None:
        """Record the first failed test."""
        if report.failed and not self.red:
            self.red = report.nodeid

    def pytest_collectreport(self, report: pytest.CollectReport) -> None:
        """Record a file that can no longer be imported."""
        if report.failed and not self.red:
            self.red = report.nodeid


def _function(test: str) -> str:
    """Return the name of a test without its parameters."""
    return test.partition("[")[0]


def rank(test: str, times: Mapping[str, float]) -> tuple[int, str, float]:
    """Return the sort key of a test: duration class, then file."""
    size = sum(times[test] > limit for limit in (0.05, QUICK, 3.0))
    return size, test.partition("::")[0], times[test]


def choose(
    tests: Iterable[str],
    times: Mapping[str, float],
    cap: float,
    near: Collection[str],
) -> list[str]:
    """Return the tests to run, in order, within a time limit.

    Many unrelated tests may read a common name, so tests near the fault are
    chosen first.

    Args:
        tests: Tests that reach a fault.
        times: Usual processor time of each test, in [s].
        cap: Maximum time of all of them, in [s]; one test always fits.
        near: Tests of files that import the module of the fault.
    """
    chosen: list[str] = []
    total = 0.0
    by_rank = sorted(tests, key=lambda test: rank(test, times))
    for test in sorted(by_rank, key=lambda test: test not in near):
        if not chosen or total + times[test] <= cap:
            total += times[test]
            chosen.append(test)
    return sorted(chosen, key=lambda test: rank(test, times))


def run(
    tree: Path,
    chosen: Mapping[str, float],
    note: Path,
    spare: float = SPARE,
    near: Collection[str] = (),
) -> None:
    """Run tests in this process until one fails, and write the verdict.

    Args:
        tree: Scratch copy with the fault.
        chosen: Usual time of each test, in [s].
        note: File for the verdict; until then it names the running test.
        spare: Extra processor time of any test, in [s].
        near: Tests that run first, because they are the most likely to
            detect the fault and need the fewest imports.
    """
    sys.dont_write_bytecode = True  # with the fault
    os.environ["PYTHONDONTWRITEBYTECODE"] = "1"
    allow(START)
    parts: list[dict[str, float]] = [{}, {}, {}]
    for test, time in chosen.items():
        parts[2 if time > QUICK else test not in near][test] = time
    red, status = "", 0
    for part in parts:
        if part and status == 0:
            files = sorted({test.partition("::")[0] for test in part})
            note.write_text(f"start of {files[0]}", encoding="utf-8")
            allow(START)
            judge = Judge(part, note, spare)
            status = run_tests(tree, files, judge, "--exitfirst")
            red = judge.red
    verdict = {"red": red, "status": status, "cpu": round(cpu_time(), 2)}
    note.write_text(json.dumps(verdict), encoding="utf-8")
