"""Test output files: checked first, replaced atomically, never unasked."""

import errno
import os
import subprocess
import sys
import threading
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from click.testing import CliRunner

from stepaside.cli.main import main
from stepaside.core.atomic_output import atomic_draft, check_file, check_folder
from stepaside.core.errors import ConfigurationError, OutputError
from stepaside.games.game_settings import duel
from stepaside.games.recorded_game import run_game
from stepaside.games.run import Run
from stepaside.report import run_figure
from stepaside.report.run_folder import save_run, write_run

pytestmark = pytest.mark.usefixtures("blank_figures")

FULL = OSError(errno.ENOSPC, "No space left on device")


def looping(folder: Path) -> Path:
    (folder / "one").symlink_to(folder / "two")
    (folder / "two").symlink_to(folder / "one")
    return folder / "one"


def dangling(folder: Path) -> Path:
    (folder / "link").symlink_to(folder / "nowhere")
    return folder / "link"


def through_a_file(folder: Path) -> Path:
    (folder / "file").write_text("kept")
    return folder / "file" / "below"


def through_a_link(folder: Path) -> Path:
    return looping(folder) / "below"


def pipe(folder: Path) -> Path:
    os.mkfifo(folder / "pipe")
    return folder / "pipe"


BAD: dict[str, Callable[[Path], Path]] = {
    "looping": looping,
    "dangling": dangling,
    "through a file": through_a_file,
    "through a loop": through_a_link,
    "too long": lambda folder: folder / ("x" * 300),
    "far too long": lambda folder: folder / ("x/" * 3000) / "y",
    "pipe": pipe,
    "device": lambda folder: Path("/dev/full"),
    "in the system": lambda folder: Path("/proc/x/y"),
    "nothing": lambda folder: folder / "\0",
}


@pytest.mark.parametrize("kind", BAD)
def test_a_path_that_cannot_be_written_is_refused(
    tmp_path: Path, kind: str
) -> None:
    path = BAD[kind](tmp_path)
    before = sorted(tmp_path.rglob("*"))
    with pytest.raises(ConfigurationError, match="output must"):
        check_file(path)
    with pytest.raises(ConfigurationError, match="output must"):
        check_folder(path, new=True)
    if kind not in ("pipe", "device", "nothing", "dangling", "looping"):
        with pytest.raises(OutputError, match="could not be written"):
            with atomic_draft(path) as draft:
                draft.write_text("new")
    assert sorted(tmp_path.rglob("*")) == before


def test_a_full_disk_is_refused(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def full(**options: Any) -> Any:
        raise FULL

    check_file(tmp_path / "a")
    monkeypatch.setattr("tempfile.TemporaryFile", full)
    with pytest.raises(ConfigurationError, match="no space left"):
        check_file(tmp_path / "a")


def test_nothing_is_replaced_unless_asked(tmp_path: Path) -> None:
    file = tmp_path / "there"
    file.write_text("kept")
    with pytest.raises(ConfigurationError, match="--overwrite"):
        check_file(file)
    check_file(file, overwrite=True)
    with pytest.raises(ConfigurationError, match="must be a regular file"):
        check_file(tmp_path, overwrite=True)
    assert file.read_text() == "kept"


def test_a_failed_write_leaves_the_old_file(tmp_path: Path) -> None:
    file = tmp_path / "file"
    file.write_text("old")
    with pytest.raises(OutputError, match="file could not.*no space left"):
        with atomic_draft(file) as draft:
            draft.write_text("ne")
            raise FULL
    with pytest.raises(KeyboardInterrupt), atomic_draft(file) as draft:
        draft.write_text("ne")
        raise KeyboardInterrupt
    assert list(tmp_path.iterdir()) == [file]
    assert file.read_text() == "old"


@pytest.fixture(scope="module")
def short() -> Run:
    return run_game(duel(duration=0.1))


def test_two_runs_into_one_folder_are_both_saved(
    tmp_path: Path, short: Run
) -> None:
    figures: list[Path] = []

    def save() -> None:
        figures.append(write_run(tmp_path / "run", short))

    save()
    # One after the other: matplotlib is not thread-safe.
    for _ in range(2):
        other = threading.Thread(target=save)
        other.start()
        other.join()
    names = ["run", "run-2", "run-3"]
    assert [figure.parent.name for figure in figures] == names
    assert sorted(p.name for p in tmp_path.iterdir()) == names
    assert all(figure.is_file() for figure in figures)


def test_a_run_that_cannot_be_written_is_saved_in_the_temporary_folder(
    tmp_path: Path, short: Run, monkeypatch: pytest.MonkeyPatch
) -> None:
    there, spare = tmp_path / "there", tmp_path / "spare"
    there.mkdir()
    spare.mkdir()
    monkeypatch.setattr("tempfile.tempdir", str(spare))

    def full(run: Run, path: Path) -> None:
        if there in path.parents:
            raise FULL

    monkeypatch.setattr(run_figure, "draw_run", full)
    saved, error = save_run(there / "run", short)
    assert saved == spare / "stepaside-run"
    assert error is not None and "no space left" in str(error)
    assert list(there.iterdir()) == []
    monkeypatch.setattr("tempfile.tempdir", str(there))
    assert save_run(there / "run", short)[0] is None
    assert list(there.iterdir()) == []


OUTPUTS = {  # words of commands that write a file, and its suffix
    "theory plan --role evader --bearing 40deg --figure": ".png",
    "theory bound --grid 16 --output": ".npz",
    "run room --output": ".toml",
    "robot check nao --workers 1 --figure": ".png",
    "study duels --output": ".sqlite",
}


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory, short: Run) -> Path:
    path = tmp_path_factory.mktemp("runs") / "run"
    write_run(path, short)
    return path


@pytest.mark.parametrize("kind", sorted({*BAD} - {"device"}))
@pytest.mark.parametrize("words", OUTPUTS)
def test_every_command_refuses_a_bad_path_in_one_line(
    tmp_path: Path, words: str, kind: str
) -> None:
    path = BAD[kind](tmp_path)
    if kind in ("looping", "dangling", "pipe"):
        path = path.rename(path.with_name(path.name + OUTPUTS[words]))
    before = sorted(tmp_path.rglob("*"))
    result = CliRunner().invoke(main, [*words.split(), f"{path}"])
    assert result.exit_code == 2, result.output
    assert result.output.count("\n") == 1 and "must" in result.output
    assert len(result.output) < 500
    assert sorted(tmp_path.rglob("*")) == before


def test_a_duel_is_reported_although_it_cannot_be_written(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def full(*arguments: Any) -> None:
        raise FULL

    monkeypatch.setattr(run_figure, "draw_run", full)
    monkeypatch.setattr("tempfile.tempdir", str(tmp_path))
    words = ["duel", "--duration", "0.1", "--output", str(tmp_path / "run")]
    result = CliRunner().invoke(main, words)
    assert result.exit_code == 2 and "no space left" in result.stderr
    assert "not reached" in result.stdout
    assert list(tmp_path.iterdir()) == []


@pytest.mark.skipif(sys.platform == "win32", reason="pipes of POSIX")
def test_a_closed_pipe_gives_no_traceback() -> None:
    code = "from stepaside.cli.main import main; main(['robot', '--mjcf'])"
    reader, writer = os.pipe()
    os.close(reader)
    done = subprocess.run(
        [sys.executable, "-c", code],
        stdout=writer,
        stderr=subprocess.PIPE,
        text=True,
        check=False,
    )
    os.close(writer)
    assert done.returncode == 1 and done.stderr == ""
