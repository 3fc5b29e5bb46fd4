"""Test that the record of what tests reach leaves no test out."""

import subprocess
import sys
from pathlib import Path

from mutation.reach import load

REPOSITORY = Path(__file__).parents[1]
CODE = """def half(x: float) -> float:
    return 0.5 * x
"""
TESTS = """import pytest
from stepaside.toy import half

@pytest.fixture(scope="module")
def shared():
    return 2.0

def test_first(shared, tmp_path):
    assert half(shared) == 1.0

def test_second(shared):
    assert half(4.0) == 2.0
"""
RECORD = """import os, sys
from pathlib import Path
from tests.mutation.child import fork, warm_up
from tests.mutation.reach import record
root = Path(sys.argv[1])
warm_up(root)
out = root / "reach.json"
work = lambda: record(root, "tests/test_toy.py", out)
os.waitpid(fork(root, root / "log", work), 0)
"""


def test_the_first_test_that_uses_a_shared_fixture_counts(
    tmp_path: Path,
) -> None:
    """Fixtures of a module or session must not take its lines away."""
    tree = tmp_path / "tree"
    package = tree / "src" / "stepaside"
    package.mkdir(parents=True)
    (tree / "tests").mkdir()
    (tree / "pyproject.toml").touch()
    (package / "__init__.py").touch()
    (package / "toy.py").write_text(CODE)
    (tree / "tests" / "test_toy.py").write_text(TESTS)
    subprocess.run(
        [sys.executable, "-c", RECORD, str(tree)],
        cwd=REPOSITORY,
        check=True,
        capture_output=True,
    )
    found = load(tree / "reach.json")
    names = {
        test.split("::")[1] for test in found.lines["src/stepaside/toy.py"][2]
    }
    assert names == {"test_first", "test_second"}
