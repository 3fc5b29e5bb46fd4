"""What is wrong is refused in one line that names it; nothing is written."""

from pathlib import Path

import pytest

import stepaside as sa
from flows import calls

FILES = {
    "unknown.toml": "speeds = 3\n",
    "broken.toml": "duration = [\n",
    "study.toml": 'game = "duel"\n[grid]\nspeeed = [1]\n',
    "alone.toml": '[[players]]\nname = "a"\nrole = "pursuer"\n',
    "mine.py": "def evader():\n    return 3\n",
    "junk.onnx": "junk",
    "robot.urdf": '<robot name="r"><link',
    "room.toml": "width = -1\ndepth = 3\n",
    "table.csv": "time,x\n0,1\n",
    "run/configuration.toml": "duration = 1\n",
}
CASES = {  # of each line: what the message names
    "duel --duration nan": ("duration", "nan"),
    "duel --config unknown.toml --output new": ("unknown.toml", "speeds"),
    "duel --config broken.toml --output new": ("broken.toml", "line 2|end"),
    "view alone.toml --config run/configuration.toml": ("--config", "a duel"),
    "duel --config none.toml --output new": ("none.toml",),
    "duel --strategy mine.py:evader --output new": ("mine.py:evader",),
    "duel --strategy mine.py:nobody --output new": ("nobody",),
    "duel --strategy junk.onnx --output new": ("junk.onnx", "ONNX"),
    "duel --room room.toml --output new": ("width", "-1"),
    "duel --robot nobody --output new": ("robot", "nobody"),
    "duel --output run": ("run",),
    "run walk --push 1@x:2 --output new": ("push", "x"),
    "run alone.toml --output new": ("a ", "opponent"),
    "study study.toml --output new.sqlite": ("speeed",),
    "study tournament --set seed=5:2 --output new.sqlite": ("at least one",),
    "robot init robot.urdf --output new": ("robot.urdf", "XML"),
    "robot legs inspect junk.onnx": ("junk.onnx", "ONNX"),
    "serve --ros2 evader=/a --wait nan": ("wait", "nan"),
    "serve --ros2 evader=/a --set level=steps": ("level", "steps"),
    "show run -o new.html": ("run", "summary.json"),
    "theory circle --figure new.bmp": ("--figure", ".png", "new.bmp"),
    "duel --pursuer person --set person.path=table.csv": ("table.csv", "y"),
}


def contents(folder: Path) -> dict[Path, str]:
    """Return every file of a folder, and what it holds."""
    return {f: f.read_text() for f in folder.rglob("*") if f.is_file()}


@pytest.mark.parametrize("line", CASES)
def test_what_is_bad_is_named_in_one_line(line: str, tmp_path: Path) -> None:
    for name, text in FILES.items():
        file = tmp_path / name
        file.parent.mkdir(exist_ok=True)
        file.write_text(text)
    before = contents(tmp_path)
    answer = calls.stepaside(
        *line.split(),
        status=2,
        cwd=tmp_path,
        env={"PYTHONDONTWRITEBYTECODE": "1"},
    )
    assert answer.out == ""
    assert answer.err.count("\n") == 1, answer.err
    assert answer.err.startswith("stepaside: ")
    for words in CASES[line]:
        found = [word in answer.err for word in words.split("|")]
        assert any(found), answer.err
    assert contents(tmp_path) == before
    assert not list(tmp_path.glob("new*"))


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({"duration": float("nan")}, "duration"),
        ({"duration": -1.0}, "duration"),
        ({"evader": {"strategy": "nobody"}}, "nobody"),
        ({"start": (0.0, 0.0, 0.0)}, "start"),
    ],
)
def test_what_is_bad_is_refused_in_python(
    changes: dict[str, object], words: str
) -> None:
    with pytest.raises(sa.StepAsideError, match=words) as refused:
        sa.run_game(sa.duel(**changes))
    assert "\n" not in str(refused.value)


def test_joining_only_damaged_results_is_refused(tmp_path: Path) -> None:
    part, whole = tmp_path / "part.sqlite", tmp_path / "all.sqlite"
    part.write_text("half a li")
    words = ("study", "duels", part, "--output", whole)
    calls.stepaside(*words, status=2)
    assert not whole.exists()


def test_a_game_file_may_begin_with_a_byte_order_mark(tmp_path: Path) -> None:
    file = tmp_path / "game.toml"
    text = (calls.EXAMPLES / "two-pursuers.toml").read_text("utf-8")
    file.write_text(text, "utf-8-sig")
    words = ("--level", "steps", "--duration", 0.1, "--json")
    calls.stepaside("run", "game", file, *words)
