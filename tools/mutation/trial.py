"""One fault before the tests that reach it."""

import json
import os
import sys
from collections.abc import Collection, Iterable, Mapping
from math import inf
from pathlib import Path

import pytest

from .child import allow, cpu_time, run_tests

QUICK = 0.5  # [s]; slower tests run only when these have noticed nothing
RAN = (0, 1)  # exit status of pytest when tests ran, all green or not
START = 60.0  # [s] of processor time to import and collect
SPARE = 10.0  # [s] of processor time that any test may take
COMPILING = 60.0  # [s], the same where functions are compiled anew
PATIENCE = 2.0  # by which all tests may take longer than usual, and a test


class Judge:
    """Pytest plugin that runs chosen tests and stops at the first red one.

    Args:
        times: Usual processor time of each chosen test, in [s].
        note: File that always tells the test that is running.
        spare: Processor time that any test may take, in [s].
    """

    def __init__(
        self, times: Mapping[str, float], note: Path, spare: float = SPARE
    ) -> None:
        self._times = dict(times)
        self._note = note
        self._spare = spare
        self._until = inf  # processor time at which no other test begins
        self.red = ""

    def pytest_collection_modifyitems(self, items: list[pytest.Item]) -> None:
        """Keep the chosen tests, the quick ones first.

        A fault may change the parameters in the name of a test: of a
        function whose test is gone, the tests with other names stand in.
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
        """Run no more tests when they have taken far longer than usual.

        A test may be the only one left of those that share what is dear.
        """
        return True if cpu_time() > self._until else None

    def pytest_runtest_logstart(self, nodeid: str) -> None:
        """Note what runs, and limit its time."""
        self._note.write_text(nodeid, encoding="utf-8")
        allow(self._spare + 5.0 * self._times[nodeid])

    def pytest_runtest_logreport(self, report: pytest.TestReport) -> None:
        """Note the first test that does not pass."""
        if report.failed and not self.red:
            self.red = report.nodeid

    def pytest_collectreport(self, report: pytest.CollectReport) -> None:
        """Note a file that can no longer be read."""
        if report.failed and not self.red:
            self.red = report.nodeid


def _function(test: str) -> str:
    """Name of a test without its parameters."""
    return test.partition("[")[0]


def rank(test: str, times: Mapping[str, float]) -> tuple[int, str, float]:
    """Order of a test: by size, then together with those of its file."""
    size = sum(times[test] > limit for limit in (0.05, QUICK, 3.0))
    return size, test.partition("::")[0], times[test]


def choose(
    tests: Iterable[str],
    times: Mapping[str, float],
    cap: float,
    near: Collection[str],
) -> list[str]:
    """Tests to run, in order, as far as they fit into a time.

    A common name is read by many tests that have nothing to do with the
    fault, so those that are near it are the first to get a place.

    Args:
        tests: Tests that reach a fault.
        times: Usual processor time of each test, in [s].
        cap: Most time for all of them, in [s]; one test always fits.
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
    """Run tests in this process until one is red, and write the verdict.

    Args:
        tree: Scratch copy with the fault in it.
        chosen: Usual time of each test, in [s].
        note: File for the verdict; until there is one it names the test
            that is running.
        spare: Processor time that any test may take, in [s].
        near: Tests that run before the others, as they are the likeliest to
            notice: no other file need be read then.
    """
    sys.dont_write_bytecode = True  # of the fault
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
