"""Test that formulas as machine code are the formulas, to the bit."""

from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest

from stepaside.core import compilation as machine
from stepaside.core.compilation import JitPreference
from stepaside.robots.description import load_robot
from stepaside.robots.expression_tracing import (
    ExpressionTrace,
    Number,
    cosine,
    sine,
)
from stepaside.robots.ik_solver import solver_of
from stepaside.robots.tree_cache import load_tree

pytest.importorskip("numba")


@pytest.fixture(autouse=True)
def fresh(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[None]:
    """Nothing is stored, and nothing preferred afterwards."""
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path))
    monkeypatch.setattr(machine, "_preference", JitPreference.PLAIN)
    monkeypatch.setattr(machine, "_work", 0.0)
    monkeypatch.setattr(machine, "COMPILING_PAYS", 300.0)
    yield


def formula(factor: float) -> machine.Function:
    trace = ExpressionTrace()
    x, y = trace.variable("x"), trace.variable("y")
    results: list[Number] = [sine(x) * cosine(y) + factor * x, x / y]
    return trace.function("formula", results)


def files() -> list[str]:
    """Endings of what is kept, but for what Python itself compiled."""
    kept = machine.cache_folder().rglob("*.*")
    return sorted(path.suffix for path in kept if path.suffix != ".pyc")


def test_nothing_is_compiled_unless_it_is_preferred() -> None:
    formula(2.0)
    machine.prefer(JitPreference.STORED)
    formula(2.0)
    assert not machine.cache_folder().exists()


def test_compiled_code_is_loaded_from_the_cache() -> None:
    plain = formula(2.0)
    machine.prefer(JitPreference.COMPILED)
    compiled = formula(2.0)
    assert files() == [".nbc", ".nbi", ".py"]
    machine.prefer(JitPreference.STORED)
    for function in (compiled, formula(2.0)):
        assert type(function) is not type(plain)
        assert function(0.3, 0.7) == plain(0.3, 0.7)
        with pytest.raises(ZeroDivisionError):
            function(0.3, 0.0)


def test_another_formula_is_another_file() -> None:
    machine.prefer(JitPreference.COMPILED)
    first, second = formula(2.0), formula(3.0)
    assert first(1.0, 1.0) != second(1.0, 1.0)
    assert len(files()) == 6


@pytest.mark.parametrize("suffix", [".nbc", ".nbi", ".py"])
def test_damaged_code_is_not_used(suffix: str) -> None:
    plain = formula(2.0)
    machine.prefer(JitPreference.COMPILED)
    formula(2.0)
    (path,) = machine.cache_folder().rglob(f"*{suffix}")
    path.write_bytes(b"raise SystemExit(1)")
    assert formula(2.0)(0.3, 0.7) == plain(0.3, 0.7)


def test_short_games_do_not_wait_for_machine_code() -> None:
    machine.expect_work(machine.LOADING_PAYS - 1.0)
    assert machine.preferred() is JitPreference.PLAIN
    machine.expect_work(1.0)
    assert machine.preferred() is JitPreference.STORED
    for _ in range(4):
        machine.expect_work(0.25 * machine.COMPILING_PAYS)
    machine.expect_work(1.0)
    assert machine.preferred() is JitPreference.COMPILED


def test_legs_step_to_the_same_bits() -> None:
    robot = load_robot("nao")
    plain = solver_of(robot, load_tree(robot)).newton_step
    machine.prefer(JitPreference.COMPILED)
    compiled = solver_of(robot, load_tree(robot)).newton_step
    assert plain is not None and compiled is not None
    assert plain is not compiled
    generator = np.random.default_rng(1)
    for _ in range(300):
        numbers = generator.uniform(-0.5, 0.5, plain.__code__.co_argcount)
        arguments = numbers.tolist()
        assert compiled(*arguments) == plain(*arguments)
