"""Test that long measurements go on where they were stopped."""

import json
import sys
from pathlib import Path
from typing import Any

import pytest
from benchmark_options import seeds_of
from resumable_jobs import finished, gather, part_of, spread

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


def test_every_job_is_done_in_order(tmp_path: Path) -> None:
    found = run(tmp_path / "x.json", Work())
    assert list(found.items()) == [
        ("a", {"twice": 2}),
        ("b", {"twice": 4}),
        ("c", {"twice": 6}),
    ]


def test_what_was_done_is_not_done_again(tmp_path: Path) -> None:
    output, work = tmp_path / "x.json", Work()
    stopped(output)
    assert list(run(output, work)) == ["a", "b", "c"]
    assert 1 not in work.done and 2 in work.done


@pytest.mark.parametrize("key", ["version", "libraries"])
def test_other_code_begins_anew(tmp_path: Path, key: str) -> None:
    output, work = tmp_path / "x.json", Work()
    stopped(output)
    run(output, work, HEAD | {key: "other"})
    assert work.done == [1, 2, 3]


def test_another_script_begins_anew(tmp_path: Path, script: Path) -> None:
    output, work = tmp_path / "x.json", Work()
    stopped(output)
    script.write_text("2")
    run(output, work)
    assert work.done == [1, 2, 3]


def test_other_jobs_of_the_same_names_are_done(tmp_path: Path) -> None:
    """Sixty minutes are not three, though both are called forward."""
    output, work = tmp_path / "x.json", Work()
    run(output, Work())
    others = {name: 10 * number for name, number in JOBS.items()}
    found = gather(output, HEAD, others, work, workers=0)
    assert work.done == [10, 20, 30] and found["c"] == {"twice": 60}


def test_a_line_that_was_cut_off_is_done_again(tmp_path: Path) -> None:
    output, work = tmp_path / "x.json", Work()
    whole = run(output, Work())
    (file,) = part_of(output).iterdir()
    text = file.read_text()
    lost = JOBS[json.loads(text.splitlines()[-1])["key"][0]]
    file.write_text(text[:-5])
    assert run(output, work) == whole
    assert work.done == [lost]
    work.done.clear()
    assert run(output, work) == whole
    assert work.done == []


def test_nothing_is_left_when_results_are_written(tmp_path: Path) -> None:
    output = tmp_path / "x.json"
    run(output, Work())
    assert part_of(output).exists()
    finished(output)
    assert not part_of(output).exists()


def test_a_spread_leaves_out_what_was_not_found() -> None:
    assert spread([3.0, None, 0.0, 1.5]) == {
        "number": 3,
        "least": 0.0,
        "mean": 1.5,
        "greatest": 3.0,
    }
    assert spread([None])["mean"] is None


def test_seeds_are_a_range_without_its_end() -> None:
    assert list(seeds_of("3:5")) == [3, 4]
    for bad in ("5:3", "3", "-1:2", "3:3"):
        with pytest.raises(ValueError):
            seeds_of(bad)
