"""Test that a player goes on if its record cannot be written."""

import resource
import shutil
import tempfile
from collections.abc import Callable, Iterator
from contextlib import ExitStack
from pathlib import Path
from typing import Any

import pytest

from stepaside.cli.connection_settings import ConnectionSettings
from stepaside.cli.play_recording import PlayRecord
from stepaside.core.errors import OutputError
from stepaside.core.poses import Pose
from stepaside.drivers.velocity.velocity_body import VelocityCommand
from stepaside.drivers.velocity.velocity_loop import DrivingState, VelocityTick
from stepaside.games.duel_settings import DuelSettings
from stepaside.games.outcome import Outcome
from stepaside.games.run_archive import load_run
from tools.fuzz.places import full, room_in, short_of, taken

CONNECTION = ConnectionSettings("ros2:/nao", "evader")
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
    """Return a folder for the record, optionally on a small file system."""
    (tmp_path / "spare").mkdir()
    monkeypatch.setattr(tempfile, "tempdir", str(tmp_path / "spare"))
    with ExitStack() as stack:

        def on(small: bool) -> Path:
            stack.enter_context(room_in(tmp_path, small=small))
            (tmp_path / "top" / "place").mkdir()
            return tmp_path / "top" / "place" / "record"

        yield on


def play(folder: Path, strike: Callable[[], None]) -> None:
    """Record a number of ticks, with an event half way."""
    limits = resource.getrlimit(resource.RLIMIT_FSIZE)
    with ExitStack() as stack:
        # Before the test is over: what tells of it may be a file, too.
        stack.callback(resource.setrlimit, resource.RLIMIT_FSIZE, limits)
        record = PlayRecord(folder, DuelSettings(), CONNECTION)
        stack.push(record.leave)
        for number in range(TICKS):
            if number == TICKS // 2:
                strike()
            record.note(tick(number))
        record.end("long enough")


@pytest.mark.parametrize("gone", [shutil.rmtree, taken])
def test_a_record_whose_folder_is_deleted_is_complete_elsewhere(
    place: Callable[..., Path], tmp_path: Path, gone: Callable[[Path], Any]
) -> None:
    folder = place(small=False)
    with pytest.raises(OutputError, match="could not be written"):
        play(folder, lambda: gone(folder.parent))
    run = load_run(tmp_path / "spare" / "stepaside-record", "play")
    assert len(run.times) >= TICKS // 2
    assert run.outcome is Outcome.COMPLETED
    assert not folder.exists()


def test_a_record_on_a_full_disk_is_moved_elsewhere(
    place: Callable[..., Path], tmp_path: Path
) -> None:
    folder = place(small=True)
    with pytest.raises(OutputError, match="could not be written"):
        play(folder, lambda: full(folder.parent))
    run = load_run(tmp_path / "spare" / "stepaside-record", "play")
    assert len(run.times) > TICKS // 4
    # What reached the disk as it went is there, and no half of a run.
    assert {file.name for file in folder.iterdir()} <= AS_IT_GOES


def test_a_record_that_cannot_be_written_at_all_does_not_stop_the_play(
    place: Callable[..., Path], tmp_path: Path
) -> None:
    folder = place(small=False)
    with pytest.raises(OutputError, match="could not be written"):
        play(folder, lambda: short_of(folder.parent))


def test_other_errors_are_reported_first(
    place: Callable[..., Path],
) -> None:
    folder = place(small=False)

    def fall() -> None:
        shutil.rmtree(folder.parent)
        raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        play(folder, fall)


def test_a_writable_record_is_in_its_folder(
    place: Callable[..., Path], tmp_path: Path
) -> None:
    folder = place(small=False)
    play(folder, lambda: None)
    assert len(load_run(folder, "play").times) > TICKS // 2
    assert not list((tmp_path / "spare").iterdir())
