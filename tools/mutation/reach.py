"""Coverage by test, recorded for one test file at a time."""

import json
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import coverage
import pytest

from .child import cpu_time, run_tests

SHARED = "*"  # context of fixtures shared by all tests of a file


@dataclass(frozen=True, slots=True)
class Reach:
    """Lines reached by the tests of one file.

    Attributes:
        times: Processor time of each passed test, in [s].
        red: Tests that failed without a fault.
        lines: Tests by file and line.
    """

    times: dict[str, float]
    red: list[str]
    lines: dict[str, dict[int, set[str]]]


class Recorder:
    """Pytest plugin that sets the coverage context of each test."""

    def __init__(self, measured: coverage.Coverage) -> None:
        self._measured = measured
        self.times: dict[str, float] = {}
        self.red: set[str] = set()
        self._test = ""  # of the running test

    @pytest.hookimpl(wrapper=True)
    def pytest_runtest_protocol(
        self, item: pytest.Item
    ) -> Iterator[None]:  # pragma: no cover
        """Record what one test reaches, and its time."""
        began, self._test = cpu_time(), item.nodeid
        self._measured.switch_context(self._test)
        try:
            return (yield)
        finally:
            self._measured.switch_context("")
            self.times[item.nodeid] = round(cpu_time() - began, 3)

    @pytest.hookimpl(wrapper=True)
    def pytest_fixture_setup(
        self,
        fixturedef: pytest.FixtureDef[Any],
    ) -> Iterator[None]:
        """Record what a shared fixture reaches, for all tests."""
        if fixturedef.scope == "function":
            return (yield)
        self._measured.switch_context(SHARED)
        try:
            return (yield)
        finally:
            # Not the node of the request: for a shared fixture it is not a
            # test, and the lines of the first one would be lost.
            self._measured.switch_context(self._test)

    def pytest_runtest_logreport(self, report: pytest.TestReport) -> None:
        """Record a failed test."""
        if report.outcome != "passed":
            self.red.add(report.nodeid)

    def pytest_collectreport(self, report: pytest.CollectReport) -> None:
        """Record a file that cannot be imported."""
        if report.failed:
            self.red.add(report.nodeid)


def record(tree: Path, file: str, out: Path) -> None:
    """Run the tests of a file, and record what each of them reaches."""
    source = tree / "src"
    measured = coverage.Coverage(
        data_file=None, config_file=False, include=[f"{source}/*"]
    )
    plugin = Recorder(measured)
    measured.start()
    run_tests(tree, [file], plugin)
    measured.stop()
    data = measured.get_data()
    lines = {
        Path(path).relative_to(tree).as_posix(): {
            str(line): sorted(set(contexts) - {""})
            for line, contexts in data.contexts_by_lineno(path).items()
            if set(contexts) - {""}
        }
        for path in data.measured_files()
    }
    found = {"times": plugin.times, "red": sorted(plugin.red), "lines": lines}
    draft = out.with_suffix(".draft")
    draft.write_text(json.dumps(found), encoding="utf-8")
    draft.replace(out)


def load(path: Path) -> Reach:
    """Load the output of :func:`record`."""
    found = json.loads(path.read_text(encoding="utf-8"))
    red = set(found["red"])
    times = {t: s for t, s in found["times"].items() if t not in red}
    lines: dict[str, dict[int, set[str]]] = {}
    for file, by_line in found["lines"].items():
        lines[file] = {}
        for line, names in by_line.items():
            tests = set(times) if SHARED in names else set(names) & set(times)
            lines[file][int(line)] = tests
    return Reach(times, sorted(red), lines)
