"""Test that the record of what tests reach leaves no test out."""

import ast
import subprocess
import sys
from functools import cache
from pathlib import Path

from tools.mutation.campaign import is_compiled
from tools.mutation.mention import HIDDEN
from tools.mutation.reach import load

REPOSITORY = Path(__file__).parents[2]
# Where decorators come from whose functions no tracer sees whenever they act.
BLIND = {"functools", "compilation"}
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
from tools.mutation.child import fork, warm_up
from tools.mutation.reach import record
root = Path(sys.argv[1])
warm_up(root)
out = root / "reach.json"
work = lambda: record(root, "tests/test_toy.py", out)
os.waitpid(fork(root, root / "log", work), 0)
"""


def test_lines_of_shared_fixtures_belong_to_all_their_tests(
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


@cache
def trees() -> dict[str, ast.Module]:
    """Modules that name a place where such decorators come from."""
    texts = {
        file.relative_to(REPOSITORY).as_posix(): file.read_text("utf-8")
        for file in (REPOSITORY / "src").rglob("*.py")
    }
    return {
        file: ast.parse(text)
        for file, text in texts.items()
        if any(f"{place} import" in text for place in BLIND)
    }


def blind(tree: ast.Module) -> set[str]:
    """Names that a module imports from where those decorators are."""
    return {
        alias.name
        for node in ast.walk(tree)
        if isinstance(node, ast.ImportFrom)
        and (node.module or "").rpartition(".")[2] in BLIND
        for alias in node.names
    }


def decorating(tree: ast.Module) -> set[str]:
    """Names of decorators."""
    return {
        name.id
        for node in ast.walk(tree)
        if isinstance(node, ast.FunctionDef)
        for decorator in node.decorator_list
        for name in ast.walk(decorator)
        if isinstance(name, ast.Name)
    }


def test_every_decorator_that_prevents_tracing_is_known() -> None:
    found = set()
    for tree in trees().values():
        found |= blind(tree) & decorating(tree)
    assert found - {"wraps"} == set(HIDDEN)


def test_compiled_functions_are_recompiled_with_each_fault() -> None:
    """Cached machine code would be that of the package without the fault."""
    files = [
        file for file, tree in trees().items() if "inlined" in blind(tree)
    ]
    assert len(files) > 3
    assert all(map(is_compiled, files))
    assert not is_compiled("src/stepaside/sim/world.py")
