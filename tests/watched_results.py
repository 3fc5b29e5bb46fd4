"""Results that tests receive, compared with those that are stored.

A law that a test checks leaves open what it does not name: a message, a lag,
another axis. So all that a test of the folders below receives from the
package is compared with what it was. After a change that is meant to change
it, store it anew and read the difference::

    STORE=1 pytest tests/FOLDER

Texts are followed by the number of calls that had them in turn, and many
numbers are stored as moments of their parts.
"""

import json
import os
import re
import sys
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from dataclasses import fields, is_dataclass
from enum import Enum
from functools import cache, wraps
from hashlib import sha256
from pathlib import Path
from types import FunctionType, ModuleType
from typing import Any

import numpy as np
import pytest
from click.testing import CliRunner, Result
from numpy.typing import ArrayLike

from stepaside.core.errors import StepAsideError

TESTS = Path(__file__).parent
BELOW = str(TESTS)
STORED = TESTS / "data" / "results"
WHOLE = 16  # numbers that are stored as they are
PARTS = 12  # of more numbers
IMAGE = 3000  # numbers of an array of which moments are noted
LONGEST = 400  # text that is stored as it is
PLACES = re.compile(r"(?:[\w.~-]*/)+|\btmp\w{8}\b")  # folders of files
NUMBERS = re.compile(r"-?\d+\.\d+(?:e-?\d+)?")
# Times that a computer takes.
UNSTORED = "MpcResult.time", "StepStarted.planning_time"
# Folders whose tests are compared, and files in them that depend on time.
FOLDERS = (
    *("control", "drivers", "fitting", "locomotion"),
    *("perception", "robots", "sim"),
)
TIMED = (
    *("test_guardian", "test_mujoco_robot", "test_naoqi", "test_robot_camera"),
    *("test_play_python_robot", "test_robot_session", "test_ros2_robot"),
    *("test_ros2_server", "test_vendor_adapters"),
)
_results: list["Results"] = []  # those of the present test, if they are noted
_replaced: list[tuple[Any, str, Any]] = []  # owner, name, and what was there
_watched: list[str] = []  # folder whose functions are replaced now


class Results:
    """Results that a test has received, by the name of what it called."""

    def __init__(self) -> None:
        """Start without results."""
        self._numbers: dict[str, list[float]] = {}
        self._texts: dict[str, list[Any]] = {}

    def note(self, name: str, value: Any) -> None:
        """Note a result."""
        leaves = list(_leaves(value))
        if not leaves:
            return
        numbers = self._numbers.setdefault(name, [])
        numbers += [leaf for leaf in leaves if isinstance(leaf, float)]
        words = [leaf for leaf in leaves if isinstance(leaf, str)]
        text = _abridged(PLACES.sub("", ", ".join(words)))
        texts = self._texts.setdefault(name, [])
        if texts[-2:-1] == [text]:
            texts[-1] += 1
        else:
            texts += [text, 1]

    def summary(self) -> dict[str, Any]:
        """Return numbers, or moments of many, and texts, by name."""
        return {
            name: [_moments(numbers), self._texts[name]]
            for name, numbers in self._numbers.items()
        }


def _abridged(text: str) -> str:
    """Return a text; the end of a long one as a digest, numbers rounded."""
    rest = NUMBERS.sub(lambda found: f"{float(found[0]):.3g}", text[LONGEST:])
    end = f" {sha256(rest.encode()).hexdigest()[:8]}" if rest else ""
    return text[:LONGEST] + end


def _leaves(value: Any, depth: int = 0) -> Iterator[str | float]:
    """Yield the numbers and texts in a result."""
    if depth > 9 or value is None:
        return
    if isinstance(value, str | Path | bool | np.bool_):
        yield str(value)
    elif isinstance(value, Enum):
        yield value.name
    elif isinstance(value, int | float | np.number):
        yield float(np.real(value))
    elif isinstance(value, np.ndarray):
        if value.dtype.kind in "fiub":
            flat = np.ravel(value).astype(np.float64)
            yield from _moments(flat) if flat.size > IMAGE else flat.tolist()
    elif isinstance(value, Result):  # of a command
        yield float(value.exit_code)
        yield value.output
    elif isinstance(value, BaseException):
        yield type(value).__name__
        if isinstance(value, StepAsideError):
            yield str(value)
    elif isinstance(value, list | tuple | Mapping) or is_dataclass(value):
        for key, each in _parts(value):
            if f"{type(value).__name__}.{key}" not in UNSTORED:
                if isinstance(value, Mapping):
                    yield from _leaves(key)
                yield from _leaves(each, depth + 1)


def _parts(value: Any) -> Iterator[tuple[Any, Any]]:
    """Yield the parts of a value with their names, if they have any."""
    if isinstance(value, Mapping):
        yield from value.items()
    elif is_dataclass(value):
        for field in fields(value):
            yield field.name, getattr(value, field.name, None)
    else:
        names = getattr(value, "_fields", None) or [""] * len(value)
        yield from zip(names, value, strict=True)


def _moments(numbers: ArrayLike) -> list[float]:
    """Return numbers, or of many their count, range and moments of parts."""
    known = np.nan_to_num(numbers, nan=-9.0, posinf=9e3, neginf=-9e3)
    if known.size > WHOLE:
        found = [float(known.size), known.min(), known.max()]
        for part in np.array_split(known, PARTS):
            wave = np.sin(1.0 + 0.7 * np.arange(part.size))
            found += [part.mean(), wave @ part / np.sqrt(part.size)]
        known = np.array(found)
    return [float(f"{each:.7g}") for each in known.tolist()]


def _noting(inner: Callable[..., Any], name: str) -> Callable[..., Any]:
    """Return a function that notes its results for the test that calls it.

    Of one that returns nothing, the arrays that it was given: it fills them.
    """

    @wraps(inner)
    def call(*arguments: Any, **named: Any) -> Any:
        caller = sys._getframe(1).f_code.co_filename
        if not _results or not caller.startswith(BELOW):
            return inner(*arguments, **named)
        results = _results[-1]
        try:
            result = inner(*arguments, **named)
        except Exception as error:
            results.note(name, error)
            raise
        filled = [each for each in arguments if isinstance(each, np.ndarray)]
        results.note(name, filled if result is None else result)
        return result

    return call


def _of_package(value: Any) -> bool:
    """Return whether a function is ours, but for games: those take time."""
    own, _, room = str(getattr(value, "__module__", "")).partition(".")
    return own == "stepaside" and not room.startswith("games")


@cache
def _changes(folder: str) -> list[tuple[Any, str, Any]]:
    """Return what is replaced for the tests of a folder: owner, name, new."""
    found = [(CliRunner, "invoke", _noting(CliRunner.invoke, "invoke"))]
    for module in list(sys.modules.values()):
        file = str(getattr(module, "__file__", ""))
        if file.startswith(str(TESTS)) and file != __file__:
            found += _functions_in(module)
        elif module.__name__.startswith(f"stepaside.{folder}."):
            for kind in vars(module).values():
                own = getattr(kind, "__module__", "") == module.__name__
                if isinstance(kind, type) and own:
                    found += _methods_in(kind)
    return found


def _functions_in(module: ModuleType) -> Iterator[tuple[Any, str, Any]]:
    for name, value in list(vars(module).items()):
        made = isinstance(value, FunctionType) or hasattr(value, "dispatcher")
        if made and _of_package(value):
            yield module, name, _noting(value, value.__name__)


def _methods_in(kind: type) -> Iterator[tuple[Any, str, Any]]:
    for name, value in list(vars(kind).items()):
        if name.startswith("_") and name != "__call__":
            continue
        title = f"{kind.__name__}.{name}"
        if isinstance(value, FunctionType):
            yield kind, name, _noting(value, title)
        elif isinstance(value, property) and value.fget is not None:
            getter = _noting(value.fget, title)
            yield kind, name, property(getter, value.fset, value.fdel)


def _watch(folder: str) -> None:
    """Replace what tests of a folder call; a folder that is not, nothing."""
    if [folder] == _watched:
        return
    for owner, name, old in _replaced:
        setattr(owner, name, old)
    _replaced.clear()
    _watched[:] = [folder]
    for owner, name, new in _changes(folder) if folder in FOLDERS else ():
        _replaced.append((owner, name, vars(owner)[name]))
        setattr(owner, name, new)


@contextmanager
def noted(item: pytest.Item) -> Iterator[None]:
    """Note the results that a test receives, and compare them at its end."""
    folder = item.path.relative_to(TESTS).parts[0]
    drawn = hasattr(getattr(item, "obj", None), "hypothesis")
    _watch(folder)
    if folder not in FOLDERS or item.path.stem in TIMED or drawn:
        yield
        return
    results = Results()
    _results.append(results)
    try:
        yield
    finally:
        _results.pop()
    _compare(results.summary(), folder, f"{item.path.stem}::{item.name}")


def _compare(found: dict[str, Any], folder: str, name: str) -> None:
    file = STORED / f"{folder}.json"
    if "STORE" in os.environ:
        known = json.loads(file.read_text()) if file.exists() else {}
        known |= {name: found} if found else {}
        rows = [f"{json.dumps(k)}: {json.dumps(known[k])}" for k in known]
        file.write_text("{\n" + ",\n".join(sorted(rows)) + "\n}\n")
        return
    stored = json.loads(file.read_text()).get(name, found)
    assert found.keys() == stored.keys(), "see tests/watched_results.py"
    for call, (numbers, texts) in stored.items():
        assert found[call][1] == texts, call
        near = pytest.approx(numbers, rel=1e-4, abs=2e-6)
        assert found[call][0] == near, call
