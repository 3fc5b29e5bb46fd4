"""Test the history of benchmark figures."""

from pathlib import Path

import pytest
from history import append_run, changes_since_last

HERE = {"python": "3.12", "processor": "x86_64", "cores": 2}
THERE = HERE | {"cores": 8}


def test_changes_refer_to_the_last_run_on_the_same_machine(
    tmp_path: Path,
) -> None:
    file = tmp_path / "history.jsonl"
    assert changes_since_last(file, {"tick_us": 1.0}, HERE) == []
    append_run(file, "a", {"tick_us": 30.0}, HERE)
    append_run(file, "b", {"tick_us": 20.0, "old_us": 1.0}, HERE)
    append_run(file, "c", {"tick_us": 5.0}, THERE)
    figures = {"tick_us": 22.0, "new_us": 3.0}
    [change] = changes_since_last(file, figures, HERE)
    assert change == ("tick_us", 20.0, 22.0)
    assert change.slowdown == pytest.approx(1.1) and not change.is_regression


@pytest.mark.parametrize(
    ("name", "before", "now"),
    [("tick_us", 20.0, 30.0), ("real_time_factor", 30.0, 20.0)],
)
def test_slower_is_a_regression_faster_is_none(
    tmp_path: Path, name: str, before: float, now: float
) -> None:
    """More is slower for times, faster for speeds."""
    file = tmp_path / "history.jsonl"
    for first, second, slower in ((before, now, True), (now, before, False)):
        append_run(file, "a", {name: first}, HERE)
        [change] = changes_since_last(file, {name: second}, HERE)
        assert change.is_regression is slower
