"""Test where compiled functions are kept, and when they are made again."""

import os
import subprocess
import sys
from pathlib import Path

import pytest

CALLER = """
import numpy as np
from callee import raised
from stepaside.core.compilation import bound, compiled

@compiled
def fill(values):
    for i in range(values.shape[0]):
        values[i] = raised(values[i])

values = np.zeros(3)
bound(fill, values)()
fill(values)
print(values.tolist())
"""
CALLEES = {
    "compiled": """
from stepaside.core.compilation import compiled
STEP = 1.0

@compiled
def raised(x):
    return x + STEP
""",
    "shared": """
from stepaside.core.compilation import shared
STEP = 1.0

@shared
def raised(x):
    return x + STEP
""",
}


def run(folder: Path, cache: Path) -> tuple[str, str]:
    """Run the caller in a process of its own; return what it says.

    Python's own cache would miss a change of one length within a second.
    """
    done = subprocess.run(
        [sys.executable, "-B", folder / "caller.py"],
        env=os.environ | {"NUMBA_CACHE_DIR": str(cache)},
        capture_output=True,
        text=True,
        check=True,
    )
    return done.stdout.strip(), done.stderr


@pytest.mark.slow
@pytest.mark.parametrize("kind", CALLEES)
def test_a_changed_callee_is_compiled_again(kind: str, tmp_path: Path) -> None:
    """The file of the function that is kept has not changed."""
    (tmp_path / "caller.py").write_text(CALLER)
    callee, cache = tmp_path / "callee.py", tmp_path / "cache"
    callee.write_text(CALLEES[kind])
    assert run(tmp_path, cache) == (
        "[2.0, 2.0, 2.0]",
        "compiling this part, once: some seconds\n",
    )
    assert run(tmp_path, cache) == ("[2.0, 2.0, 2.0]", "")
    for old, new, found in (("= 1.0", "= 2.0", 4.0), ("+", "-", -4.0)):
        callee.write_text(callee.read_text().replace(old, new))
        said, told = run(tmp_path, cache)
        assert said == str([found] * 3) and "compiling" in told


RECORD = """
from typing import NamedTuple
from stepaside.core.compilation import compiled

class Pair(NamedTuple):
    one: float
    other: float

@compiled
def first(pair: Pair) -> float:
    return pair.one
"""


@pytest.mark.slow
def test_functions_of_a_record_are_compiled_again_when_its_fields_move(
    tmp_path: Path,
) -> None:
    (tmp_path / "caller.py").write_text(
        "from callee import Pair, first\nprint(first(Pair(one=1, other=2)))"
    )
    callee, cache = tmp_path / "callee.py", tmp_path / "cache"
    callee.write_text(RECORD)
    assert run(tmp_path, cache)[0] == "1"
    assert run(tmp_path, cache) == ("1", "")
    moved = "    other: float\n    one: float\n"
    callee.write_text(
        RECORD.replace("    one: float\n    other: float\n", moved)
    )
    said, told = run(tmp_path, cache)
    assert said == "1" and "compiling" in told


@pytest.mark.slow
def test_without_a_folder_to_write_to_it_compiles_and_says_so(
    tmp_path: Path,
) -> None:
    (tmp_path / "caller.py").write_text(CALLER)
    (tmp_path / "callee.py").write_text(CALLEES["shared"])
    said, told = run(tmp_path, Path("/dev/null/cache"))
    assert said == "[2.0, 2.0, 2.0]"
    assert "cannot be written" in told and told.count("\n") == 1


def test_numba_is_not_imported_before_something_is_compiled() -> None:
    code = (
        "import sys, stepaside.__main__, stepaside.sim.body_errors, "
        "stepaside.robots.leg_kinematics; assert 'numba' not in sys.modules"
    )
    subprocess.run([sys.executable, "-c", code], check=True)
