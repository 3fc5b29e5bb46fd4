"""Test that every name on the page of conventions exists, and more."""

import ast
import inspect
import re
from dataclasses import fields, is_dataclass
from importlib import import_module
from pathlib import Path
from types import ModuleType
from typing import Any

import numpy as np
import pytest

import stepaside
from stepaside.core.rotations import rotation
from stepaside.perception.attitude import AttitudeFilter
from stepaside.perception.camera_model import CameraModel
from stepaside.planning import Direction, Foot
from stepaside.planning.path import UnicycleTrajectory

ROOT = Path(stepaside.__file__).parent
PAGE = (ROOT.parents[1] / "docs" / "conventions.md").read_text("utf-8")
NAMES = sorted(set(re.findall(r"`(stepaside(?:\.\w+)+)`", PAGE)))
TITLES = re.findall(r"^## (.+)$", PAGE, re.MULTILINE)


def rows(title: str) -> list[list[str]]:
    """Rows of the table under a title, without its head."""
    text = PAGE.split(f"\n## {title}\n")[1].split("\n## ")[0]
    lines = [line for line in text.splitlines() if line.startswith("|")]
    return [
        [cell.strip() for cell in line.strip("|").split("|")]
        for line in lines[2:]
    ]


def has(thing: Any, name: str) -> bool:
    """Whether a module, class or value has a public name."""
    if hasattr(thing, name):
        return True
    if not inspect.isclass(thing):
        return False
    if is_dataclass(thing):
        return name in {field.name for field in fields(thing)}
    made = inspect.getsource(thing)
    return re.search(rf"\bself\.{name}\b[^=\n]*=", made) is not None


def find(name: str) -> bool:
    """Whether a dotted name leads to something."""
    thing: Any = stepaside
    parts = name.split(".")[1:]
    for i, part in enumerate(parts):
        if isinstance(thing, ModuleType) and not hasattr(thing, part):
            try:
                thing = import_module(f"{thing.__name__}.{part}")
            except ModuleNotFoundError:
                return False
            continue
        if not has(thing, part):
            return False
        if i + 1 < len(parts):
            thing = getattr(thing, part)
    return True


@pytest.mark.parametrize("name", NAMES)
def test_every_name_on_the_page_exists(name: str) -> None:
    assert find(name)


@pytest.mark.parametrize(
    "name",
    [
        "stepaside.nowhere",
        "stepaside.theory.laws.nothing",
        "stepaside.planning.GaitSettings.nothing",
        "stepaside.control.scheme.ControlScheme.nothing",
    ],
)
def test_a_name_that_does_not_exist_is_noticed(name: str) -> None:
    assert not find(name)


def test_every_symbol_is_listed_once_and_every_row_is_whole() -> None:
    table = rows("Symbols")
    symbols = [row[0] for row in table]
    assert len(symbols) == len(set(symbols)) > 30
    for title in TITLES:
        widths = {len(row) for row in rows(title)}
        assert len(widths) <= 1, title


def test_every_angle_is_in_radians() -> None:
    for symbol, _, code, unit, _ in rows("Symbols"):
        if re.match(r"[θψαω]", symbol):
            assert unit.startswith("rad"), symbol
        assert code or symbol.startswith("κ")


def test_every_named_generator_of_the_package_is_on_the_page() -> None:
    found = set()
    for file in ROOT.rglob("*.py"):
        text = file.read_text("utf-8")
        if "named_generator(" not in text:
            continue
        for node in ast.walk(ast.parse(text)):
            if (
                isinstance(node, ast.Call)
                and isinstance(node.func, ast.Name)
                and node.func.id == "named_generator"
            ):
                name = node.args[1]
                if isinstance(name, ast.JoinedStr):
                    name = name.values[0]
                assert isinstance(name, ast.Constant)
                found.add(str(name.value).split("/")[0].strip())
    listed = [
        re.split("[/ ][A-Z]", row[0].strip("`"))[0]
        for row in rows("Random numbers")
    ]
    assert sorted(listed) == sorted(found)


def test_signs_are_those_of_the_page() -> None:
    assert (Foot.LEFT.value, Foot.RIGHT.value) == (1, -1)
    assert (Direction.FORWARD.value, Direction.BACKWARD.value) == (1, -1)
    ahead, left = UnicycleTrajectory(1.0, 0.1, 0.2, Direction.FORWARD).poses(
        [2.0]
    )[0, :2]
    assert ahead > 0.0
    assert left > 0.0
    camera = CameraModel(100, 80, 60.0, 60.0)
    _, y, z = camera.ray(0.0, 0.0)  # the upper left corner of the image
    assert y > 0.0
    assert z > 0.0
    assert rotation(0.1, 0.0, 0.0)[2, 1] > 0.0  # the left side is up
    assert rotation(0.0, 0.1, 0.0)[2, 0] < 0.0  # the front is down
    turned = AttitudeFilter(1.0, 0.0, calibration=0.0)
    rates = np.array([0.1, 0.2, 0.0])
    turned.update(rates, np.zeros(3), (0.0, 0.0), 0.01)
    assert turned.roll > 0.0
    assert turned.pitch > 0.0
