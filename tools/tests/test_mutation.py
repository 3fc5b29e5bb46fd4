"""Test the faults that tests are tried by, on a small package."""

import ast
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import pytest

from stepaside.studies.result_store import ResultStore
from tools.documents.store import Store
from tools.documents.tables.mutation import score, survivors
from tools.mutation.__main__ import main
from tools.mutation.again import survivors_of, write_noticed
from tools.mutation.faults import Fault, draw, faults_of
from tools.mutation.places import optional_keywords
from tools.mutation.score import (
    CAP,
    REASONS,
    SAMPLE,
    head,
    read_reasons,
    summary,
    write,
)
from tools.mutation.source import Source
from tools.mutation.trial import choose

RECORDED = ("key", "file", "line", "operator", "before", "after")
REPOSITORY = Path(__file__).parents[2]
FILE = "src/stepaside/planning/toy.py"
TEXT = '''"""Doc with 1.0 number."""

import math

LIMIT = 2.0


def clipped(x: float, low: float = -1.0) -> float:
    """Text with 2 numbers."""
    if x > LIMIT and not math.isnan(x):
        raise ValueError("over 2" + "!")
    return max(low, -x) * 3.0


def unused(x: float) -> float:
    return x + 1.0
'''
TESTS = """from stepaside.planning.toy import LIMIT, clipped
import pytest

def test_clipped():
    assert clipped(0.5) == -1.5
    assert clipped(1.5) == -3.0
    with pytest.raises(ValueError, match="over"):
        clipped(2.1)
    assert LIMIT == 2.0
"""


def faults(text: str = TEXT, seed: int = 1) -> list[Fault]:
    optional = optional_keywords([ast.parse(text)])
    return list(faults_of(FILE, text, optional, seed))


def changed(text: str, fault: Fault) -> str:
    return Source(text).apply(fault.edit)


@pytest.mark.parametrize(
    ("before", "after"),
    [
        ("def f(x):\n    return x + 1j\n", "x - 1j"),
        ("def f(x, y):\n    return x if x > y else y\n", "x <= y"),
        ("def f(x, y):\n    return x and y\n", "x or y"),
        ("def f(x):\n    return abs(x)\n", "return (x)"),
        ("def f(x, y):\n    return hypot(min(x, y))\n", "max(x, y)"),
        ("def f(x):\n    return -x\n", "return (x)"),
        ("def f(x) -> bool:\n    return x.ok\n", "return not (x.ok)"),
        ("def f(x):\n    x.go()\n", "    pass\n"),
        ("def f(x):\n    if x:\n        return x\n", "if not (x):"),
        ("def f(x):\n    return atan2(x.a, x.b)\n", "atan2(x.b, x.a)"),
        ("def f(x, *, y=z):\n    return f(x, y=x)\n", "f(x, )"),
        ("class A:\n    b: bool = True\n", "b: bool = False"),
        ("LIMIT = 0\n", "LIMIT = 1"),
    ],
)
def test_each_operator_makes_its_edit(before: str, after: str) -> None:
    assert any(after in changed(before, fault) for fault in faults(before))


def test_texts_and_annotations_are_not_changed() -> None:
    lines = {fault.before for fault in faults()}
    assert not any("Doc" in line or "Text" in line for line in lines)
    text = '__all__ = [1]\nx: "Literal[1]"\n\ndef f() -> Literal[2]:\n'
    assert not faults(text + '    """Doc."""\n')


def test_every_fault_changes_the_code_and_has_a_unique_key() -> None:
    drawn = draw(faults(), {FILE: TEXT}, None, 1)
    assert len(drawn) > 12
    assert len({fault.key for fault in drawn}) == len(drawn)
    for fault in drawn:
        assert ast.dump(ast.parse(changed(TEXT, fault))) != ast.dump(
            ast.parse(TEXT)
        )


def test_sample_depends_only_on_the_seed_and_each_faults_text() -> None:
    texts = {FILE: TEXT}
    one = [f.key for f in draw(faults(), texts, None, 1)]
    assert [f.key for f in draw(faults(), texts, 5, 1)] == one[:5]
    assert [f.key for f in draw(faults(seed=2), texts, None, 2)] != one
    moved = TEXT.replace("import math", "import math\n\nMORE = [3, 4]")
    more = [f.key for f in draw(faults(moved), {FILE: moved}, None, 1)]
    assert [key for key in more if "MORE" not in key] == one


def test_fast_tests_run_first_within_the_cap() -> None:
    times = {"b::slow": 9.0, "b::quick": 0.01, "a::slow": 8.0}
    assert choose(times, times, 10.0, set()) == ["b::quick", "a::slow"]
    assert choose(["b::slow"], times, 1.0, set()) == ["b::slow"]


def test_score_counts_detected_faults(tmp_path: Path) -> None:
    rows = [
        {"key": str(i), "outcome": outcome, "test": "", "file": FILE}
        | {"line": i, "operator": "sign", "before": "a | b", "after": "b"}
        for i, outcome in enumerate(
            ["killed", "timeout", "survived", "unreached"]
        )
    ]
    found = summary(rows, {"2": "same"})
    assert found["score"] == 0.5
    assert [row["reason"] for row in found["survivors"]] == ["same", ""]
    path = tmp_path / "mutation.json"
    write(path, head(sample=4, seed=1, cap=1.0), found)
    with pytest.raises(ValueError, match="want 5 faults tried, got 4"):
        write(path, head(sample=5, seed=1, cap=1.0), found)
    result = Store(tmp_path).result("mutation")
    assert result["command"] == "make mutate SAMPLE=4 CAP=1"
    assert head(sample=SAMPLE, seed=1, cap=CAP)["command"] == "make mutate"
    assert result["settings"] == {"sample": 4, "seed": 1, "cap_s": 1.0}
    assert "2 of 4 faults detected (50.0 %)" in score(result)
    assert "| planning | 4 | 2 | 50 % |" in score(result)
    table = survivors(result)
    assert "| planning/toy.py:2 | `a \\| b` | `b` | same |" in table
    assert "| `b` | reached by no test |" in table


def test_newer_tests_are_listed_with_survivors_without_changing_the_score(
    tmp_path: Path,
) -> None:
    path = tmp_path / "mutation.json"
    first, second, *_ = faults()
    rows = {
        fault.key: {"outcome": "survived", "test": ""}
        | {name: getattr(fault, name) for name in RECORDED}
        for fault in (first, second)
    }
    found = summary(list(rows.values()), {})
    write(path, head(sample=2, seed=1, cap=1.0), found)
    assert survivors_of(path, faults()) == [first, second]
    rows[first.key] |= {"outcome": "killed", "test": "tests/test_x.py::f[1]"}
    for _ in range(2):
        assert write_noticed(path, rows, {second.key: "same"}) == 1
        result = Store(tmp_path).result("mutation")
        assert result["noticed"] == 0 and len(result["survivors"]) == 2
        assert "detect 1 of the survivors" in score(result)
        assert "| detected since by `test_x.py::f` |" in survivors(result)
        assert survivors(result).count("| same |") == 1
    assert write_noticed(path, {}, {}) == 0
    result = Store(tmp_path).result("mutation")
    assert "survivors" not in score(result) + survivors(result)
    assert "same" not in survivors(result)


def test_every_listed_survivor_has_a_reason_or_a_test() -> None:
    """By a test that notices it now, or by a reason."""
    reasons = read_reasons(REPOSITORY / REASONS)
    for row in Store().result("mutation")["survivors"]:
        assert row["reason"] == reasons.get(row["key"], ""), row["key"]
        assert "noticed_by" in row or row["reason"], row["key"]


@pytest.fixture
def root(tmp_path: Path) -> Path:
    """Tree with a small package, one function of which is not tested."""
    package = tmp_path / "src" / "stepaside"
    (package / "planning").mkdir(parents=True)
    (package / "planning" / "__init__.py").touch()
    (package / "__init__.py").touch()
    (tmp_path / FILE).write_text(TEXT)
    (tmp_path / "tests").mkdir()
    (tmp_path / "tests" / "test_toy.py").write_text(TESTS)
    (tmp_path / "pyproject.toml").write_text("")
    return tmp_path


def words(root: Path, *options: str) -> list[str]:
    return [f"--root={root}", "--all", "--jobs=2", f"--only={FILE}", *options]


def run(root: Path) -> str:
    """Try the faults, which forks: in a process without threads."""
    done = subprocess.run(
        [sys.executable, "-m", "tools.mutation", *words(root)],
        cwd=REPOSITORY,
        check=True,
        capture_output=True,
        text=True,
    )
    return done.stdout


@pytest.fixture
def told(
    root: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> Callable[..., str]:
    """Output of the same command without trials."""

    def say(*options: str) -> str:
        monkeypatch.setattr(sys, "argv", ["mutation", *words(root, *options)])
        main()
        return capsys.readouterr().out

    return say


def test_interrupted_run_ends_with_the_same_table(
    root: Path, told: Callable[..., str]
) -> None:
    whole = run(root)
    assert "killed" in whole
    listed = told("--list-survivors")
    survivors = listed.splitlines()[:-1]
    unused = [line for line in survivors if "return x + 1.0" in line]
    assert len(unused) >= 2 and len(survivors) < 6, listed
    assert (root / FILE).read_text() == TEXT
    (rows,) = (root / "runs" / "mutation").glob("trials-*/*.jsonl")
    lines = rows.read_text().splitlines(keepends=True)
    half = "".join(lines[: len(lines) // 2])
    altered = half.replace('"killed"', '"survived"', 1)
    assert altered != half
    rows.write_text(altered + lines[-1][:9])
    again = run(root)
    assert again.splitlines()[-1] == listed.splitlines()[-1]
    assert told("--list-survivors") == listed
    keys = set(ResultStore(rows.parent).read())
    assert len(keys) == len(lines)


def test_only_make_mutate_writes_the_result(
    told: Callable[..., str], capsys: pytest.CaptureFixture[str]
) -> None:
    with pytest.raises(SystemExit):
        told("--write", "--list-survivors")
    assert "--write is for the run of make mutate" in capsys.readouterr().err
