"""Ctrl-C and a full disk leave what was done, and nothing that is half."""

import signal
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest

import stepaside as sa
from flows import calls
from flows.own_strategies import FILE
from flows.running import until

EVADER = f"{FILE}:Telling"


@pytest.fixture(scope="module")
def interrupted(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Path]:
    """The run folder of a long duel, ended by Ctrl-C after a second."""
    folder = tmp_path_factory.mktemp("duel")
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("SECOND_OVER", str(folder / "reached"))
        process = calls.start_duel(EVADER, folder / "run", duration=600.0)
        until((folder / "reached").exists)
        process.send_signal(signal.SIGINT)
        _, said = process.communicate()
        assert process.returncode == 130
        assert f"the run so far is saved in {folder / 'run'}\n" in said
        assert "Traceback" not in said
        yield folder / "run"


def test_an_interrupted_duel_is_the_beginning_of_the_whole(
    interrupted: Path,
) -> None:
    run = calls.load_run(interrupted)
    last = float(run.times[-1])
    assert run.outcome is sa.Outcome.INTERRUPTED
    assert 1.0 <= last < 600.0
    whole = calls.own_duel(EVADER, distance=1.0, duration=last + 0.5)
    count = len(run.times) - 1  # the last sample is of the interruption
    for name in ("pursuer", "evader"):
        kept, played = getattr(run, name), getattr(whole, name)
        np.testing.assert_array_equal(kept.torso[:count], played.torso[:count])
    assert run.summary.min_distance_m >= whole.summary.min_distance_m


def test_a_full_disk_leaves_no_half_of_a_run(tmp_path: Path) -> None:
    said = calls.stepaside(
        *("duel", "--duration", 0.5, "--output", "run"),
        status=2,
        cwd=tmp_path,
        env={"TMPDIR": str(tmp_path)},
        largest_file=20_000,  # settings fit, the figure does not
    ).err
    assert said.count("\n") == 1 and "file too large" in said
    assert list(tmp_path.iterdir()) == []


def test_a_full_disk_leaves_the_page_that_was_there(
    interrupted: Path, tmp_path: Path
) -> None:
    pytest.importorskip("viser")
    page = tmp_path / "page.html"
    page.write_text("the page of before")
    said = calls.stepaside(
        *("show", interrupted, "-o", page), status=2, largest_file=20_000
    ).err
    assert said.count("\n") == 1 and "could not be written" in said
    assert page.read_text() == "the page of before"
    assert list(tmp_path.iterdir()) == [page]
