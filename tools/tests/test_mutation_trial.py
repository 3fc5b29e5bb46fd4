"""Test which tests meet a fault, and what their end says of it."""

import json
import signal
import subprocess
import sys
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest

from tools.mutation import trial
from tools.mutation.campaign import job_of, verdict
from tools.mutation.faults import faults_of
from tools.mutation.mention import Index
from tools.mutation.reach import Reach
from tools.mutation.tree import Tree
from tools.mutation.trial import Judge, choose

REPOSITORY = Path(__file__).parents[2]
FILE = "src/stepaside/planning/toy.py"
TRIAL = """import os, sys
from pathlib import Path
import stepaside.studies.result_store
from tools.mutation.child import fork, warm_up
from tools.mutation.trial import run
tree, note = Path(sys.argv[1]), Path(sys.argv[2])
warm_up(tree)
chosen = dict.fromkeys(sys.argv[3:], 0.1)
work = lambda: run(tree, chosen, note)
os.waitpid(fork(tree, note.with_suffix(".log"), work), 0)
"""


@pytest.fixture
def root(tmp_path: Path) -> Path:
    """Tree with one module and three files of tests."""
    root = tmp_path / "tree"
    (root / FILE).parent.mkdir(parents=True)
    (root / "src" / "stepaside" / "__init__.py").touch()
    (root / FILE).with_name("__init__.py").write_text(
        "from .toy import half\n"
    )
    (root / FILE).write_text(
        "TICK = 2\n\n\ndef half(x: float) -> float:\n    return x / TICK\n"
    )
    (root / "tests").mkdir()
    (root / "tests" / "test_toy.py").write_text(
        "import stepaside\n\n\ndef test_place():\n"
        f"    assert stepaside.__file__.startswith({str(root)!r})\n"
    )
    (root / "tests" / "test_door.py").write_text(
        "from stepaside.planning import half\n"
    )
    (root / "tests" / "test_other.py").write_text(
        "from stepaside.planning.other import TICK, toy\n"
    )
    (root / "pyproject.toml").touch()
    return root


def tried(root: Path, *tests: str) -> str:
    note = root.with_suffix(".note")
    subprocess.run(
        [sys.executable, "-c", TRIAL, str(root), str(note), *tests],
        cwd=REPOSITORY,
        check=True,
        capture_output=True,
    )
    return note.read_text(encoding="utf-8")


def test_tests_of_a_copy_import_only_its_code(root: Path) -> None:
    """The process that forks them uses the package itself."""
    note = tried(root, "tests/test_toy.py::test_place")
    assert verdict(note, 0) == ("survived", "")


def test_fault_that_prevents_all_tests_is_detected(
    root: Path,
) -> None:
    note = tried(root, "tests/test_toy.py::test_gone[2]")
    assert verdict(note, 0) == ("killed", "pytest ended with 5")


@pytest.mark.parametrize(
    ("status", "red", "outcome"),
    [
        (0, "", ("survived", "")),
        (1, "a::test", ("killed", "a::test")),
        (4, "a.py", ("killed", "a.py")),
        (2, "", ("killed", "pytest ended with 2")),
    ],
)
def test_verdict_depends_on_failed_test_and_exit_status(
    status: int, red: str, outcome: tuple[str, str]
) -> None:
    assert verdict(json.dumps({"red": red, "status": status}), 0) == outcome


def test_renamed_test_is_run(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A changed constant changes the names of parametrized tests."""
    limits: list[float] = []  # not those of the process that runs this
    monkeypatch.setattr(trial, "allow", limits.append)
    judge = Judge({"a::f[2]": 0.1, "a::g[1]": 0.2}, tmp_path / "note")
    names = ["a::f[3]", "a::g[1]", "a::g[2]", "a::h[2]"]
    items = [SimpleNamespace(nodeid=name) for name in names]
    judge.pytest_collection_modifyitems(items)  # type: ignore[arg-type]
    assert [item.nodeid for item in items] == ["a::f[3]", "a::g[1]"]
    judge.pytest_runtest_logstart("a::f[3]")
    assert limits == [pytest.approx(10.5)]


def test_slow_tests_end_a_trial(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Processor time of 7 s before the tests, which take 0.3 s all told."""
    now = [7.0]
    monkeypatch.setattr(trial, "cpu_time", lambda: now[0])
    judge = Judge({"a::f": 0.1, "a::g": 0.2}, tmp_path / "note", 4.0)
    items: Any = [SimpleNamespace(nodeid=name) for name in ("a::f", "a::g")]
    judge.pytest_collection_modifyitems(items)
    for now[0], over in ((11.5, None), (11.7, True)):
        assert judge.pytest_runtest_protocol() is over


def test_process_that_ends_early_has_no_old_verdict(root: Path) -> None:
    copy = Tree(root, root.with_name("copy"), {FILE})
    note = copy.path.with_suffix(".note")
    note.write_text(json.dumps({"red": "", "status": 0}), encoding="utf-8")
    text = (root / FILE).read_text(encoding="utf-8")
    fault = next(faults_of(FILE, text, {}, 1))
    job_of(fault, text, Index(root, {}), []).prepare(copy)
    assert verdict(note.read_text(encoding="utf-8"), signal.SIGKILL) == (
        "killed",
        "before the first test (the process ended)",
    )


def test_nearest_tests_run_first_within_the_cap() -> None:
    times = {"a::far": 0.1, "b::near": 9.0, "c::far": 0.8, "b::long": 99.0}
    near = {"b::near", "b::long"}
    assert choose(times, times, 9.5, near) == ["a::far", "b::near"]
    assert choose(times, times, 9.5, set()) == ["a::far", "c::far"]


def test_nearest_tests_import_the_module(
    root: Path,
) -> None:
    """By its own name or from its package; a common name does not count."""
    tests = {
        f"tests/test_{name}.py": Reach({f"{name}::test": 1.0}, [], {})
        for name in ("toy", "door", "other")
    }
    (root / "tests" / "test_toy.py").write_text(
        "from stepaside.planning.toy import half\n"
    )
    text = (root / FILE).read_text(encoding="utf-8")
    fault = next(faults_of(FILE, text, {}, 1))
    assert Index(root, tests).near(fault) == {"toy::test", "door::test"}
