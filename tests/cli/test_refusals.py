"""What is wrong is refused in one line that names it; nothing is written.

Messages are stored in ``tests/data/refused.json``.
"""

import re
import tomllib
from pathlib import Path

import pytest
from click.testing import CliRunner

from stepaside.cli.main import main
from stored_values import DATA, PATH, compare_stored

COMMANDS = tomllib.loads((DATA / "commands.toml").read_text("utf-8"))
FILES, LINES = COMMANDS["files"], COMMANDS["refused"]


def contents(folder: Path) -> dict[Path, str]:
    """Return every file of a folder, and what it holds."""
    return {f: f.read_text() for f in folder.rglob("*") if f.is_file()}


@pytest.mark.parametrize("line", LINES)
def test_what_is_wrong_is_refused_as_stored(
    line: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    pytest.importorskip("cyclonedds")
    pytest.importorskip("qi")
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr("sys.dont_write_bytecode", True)
    for name, text in FILES.items():
        (tmp_path / name).parent.mkdir(exist_ok=True)
        (tmp_path / name).write_text(text)
    before = contents(tmp_path)
    done = CliRunner().invoke(main, line.split())
    assert done.exit_code == 2 and not done.stdout, done.output
    lines = [x for x in done.stderr.splitlines() if "compiling" not in x]
    assert len(lines) == 1 and lines[0].startswith("stepaside: ")
    assert contents(tmp_path) == before and not list(tmp_path.glob("new*"))
    said = lines[0].replace(str(tmp_path), "")
    compare_stored("refused.json", line, [re.sub(PATH, "PATH", said)])
