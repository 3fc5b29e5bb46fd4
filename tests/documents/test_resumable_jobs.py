"""Test that long measurements go on where they were stopped."""

import sys
from pathlib import Path
from typing import Any

import pytest
from resumable_jobs import finished, gather, part_of

HEAD: dict[str, Any] = {"version": "1", "libraries": {"numpy": "2"}}
JOBS = {"a": 1, "b": 2, "c": 3}


class Work:
    """Doubles numbers, remembers which, and can be stopped at one."""

    def __init__(self, stop: int | None = None) -> None:
        self.done: list[int] = []
        self.stop = stop

    def __call__(self, number: int) -> dict[str, Any]:
        """Double a number."""
        if number == self.stop:
            raise KeyboardInterrupt
        self.done.append(number)
        return {"twice": 2 * number}


@pytest.fixture(autouse=True)
def script(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    file = tmp_path / "measure.py"
    file.write_text("1")
    monkeypatch.setattr(sys, "argv", [str(file)])
    return file


def run(
    output: Path, work: Work, head: dict[str, Any] = HEAD
) -> dict[str, Any]:
    return gather(output, head, JOBS, work, workers=0)


def stopped(output: Path) -> None:
    with pytest.raises(KeyboardInterrupt):
        run(output, Work(stop=2))


def test_what_was_done_is_not_done_again(tmp_path: Path) -> None:
    output, work = tmp_path / "x.json", Work()
    stopped(output)
    assert list(run(output, work)) == ["a", "b", "c"]
    assert 1 not in work.done and 2 in work.done


def test_nothing_is_left_when_results_are_written(tmp_path: Path) -> None:
    output = tmp_path / "x.json"
    run(output, Work())
    assert part_of(output).exists()
    finished(output)
    assert not part_of(output).exists()
