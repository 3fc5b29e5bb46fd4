"""A robot whose record cannot be written plays on, and its record is kept."""

import resource
import shutil
import tempfile
from collections.abc import Callable, Iterator
from contextlib import ExitStack
from pathlib import Path
from typing import Any

import pytest

from stepaside.cli.play_record import PlayRecord
from stepaside.core.errors import OutputError
from stepaside.core.poses import Pose
from stepaside.drivers.velocity.velocity_body import VelocityCommand
from stepaside.drivers.velocity.velocity_loop import DrivingState, VelocityTick
from stepaside.games.duel_settings import DuelSettings
from stepaside.games.outcome import Outcome
from stepaside.games.play_run import PlayRun
from stepaside.games.run_archive import load_run
from tools.fuzz.places import full, room_in, short_of, taken

OPTIONS = {
    "role": "evader",
    "robot": "ros2:/nao",
    "description": "nao",
    "dry_run": False,
}
REST = VelocityCommand(0.0, 0.0)
AS_IT_GOES = {"columns.json", "rows.f64", "play.json", "configuration.toml"}
TICKS = 200  # more than reach the disk at once


def tick(number: int) -> VelocityTick:
    time, state = 0.05 * number, DrivingState.WAITING
    if number >= TICKS // 2:
        state = DrivingState.WALKING
    return VelocityTick(state, "", time, Pose(0, 0, 0), None, REST, REST)


@pytest.fixture
def place(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> Iterator[Callable[..., Path]]:
    """Folder to record to, on a small file system if asked for."""
    (tmp_path / "spare").mkdir()
    monkeypatch.setattr(tempfile, "tempdir", str(tmp_path / "spare"))
    with ExitStack() as stack:

        def on(small: bool) -> Path:
            stack.enter_context(room_in(tmp_path, small=small))
            (tmp_path / "top" / "place").mkdir()
            return tmp_path / "top" / "place" / "record"

        yield on


def play(folder: Path, strike: Callable[[], None]) -> None:
    """Record so many ticks, in whose midst something happens."""
    limits = resource.getrlimit(resource.RLIMIT_FSIZE)
    with ExitStack() as stack:
        # Before the test is over: what tells of it may be a file, too.
        stack.callback(resource.setrlimit, resource.RLIMIT_FSIZE, limits)
        record = PlayRecord(folder, DuelSettings(), dict(OPTIONS))
        stack.push(record.leave)
        for number in range(TICKS):
            if number == TICKS // 2:
                strike()
            record.note(tick(number))
        record.ended = "long enough"


@pytest.mark.parametrize("gone", [shutil.rmtree, taken])
def test_a_record_whose_folder_goes_is_whole_elsewhere(
    place: Callable[..., Path], tmp_path: Path, gone: Callable[[Path], Any]
) -> None:
    folder = place(small=False)
    with pytest.raises(OutputError, match="could not be written"):
        play(folder, lambda: gone(folder.parent))
    run = load_run(tmp_path / "spare" / "stepaside-record", PlayRun)
    assert len(run.times) >= TICKS // 2
    assert run.outcome is Outcome.COMPLETED
    assert not folder.exists()


def test_a_record_on_a_full_disk_is_kept_elsewhere(
    place: Callable[..., Path], tmp_path: Path
) -> None:
    folder = place(small=True)
    with pytest.raises(OutputError, match="could not be written"):
        play(folder, lambda: full(folder.parent))
    run = load_run(tmp_path / "spare" / "stepaside-record", PlayRun)
    assert len(run.times) > TICKS // 4
    # What reached the disk as it went is there, and no half of a run.
    assert {file.name for file in folder.iterdir()} <= AS_IT_GOES


def test_a_record_that_lies_nowhere_costs_nothing_but_itself(
    place: Callable[..., Path], tmp_path: Path
) -> None:
    folder = place(small=False)
    with pytest.raises(OutputError, match="could not be written"):
        play(folder, lambda: short_of(folder.parent))


def test_what_goes_wrong_else_is_told_first(
    place: Callable[..., Path],
) -> None:
    folder = place(small=False)

    def fall() -> None:
        shutil.rmtree(folder.parent)
        raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        play(folder, fall)


def test_a_record_that_can_be_written_lies_where_it_should(
    place: Callable[..., Path], tmp_path: Path
) -> None:
    folder = place(small=False)
    play(folder, lambda: None)
    assert len(load_run(folder, PlayRun).times) > TICKS // 2
    assert not list((tmp_path / "spare").iterdir())
