"""Test that a description is read whole, and refused entry by entry."""

import tomllib
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest
import tomli_w

from stepaside.core.errors import ModelError
from stepaside.robots.description import RobotDescription, load_robot
from stored_values import DATA, rows_of

FEET = [f"foot_{i}" for i in range(8)]
TEXT = (DATA / "toy.toml").read_text("utf-8")


Way = list[str | int]


def way_of(name: str) -> Way:
    return [int(part) if part.isdigit() else part for part in name.split(".")]


def at(entries: Any, way: Way) -> Any:
    for part in way:
        entries = entries[part]
    return entries


def read(folder: Path, entries: dict[str, Any]) -> RobotDescription:
    (folder / "robot.toml").write_text(tomli_w.dumps(entries))
    return load_robot(folder)


def told(folder: Path, name: str, value: Any) -> str:
    """Message about a description with one changed value."""
    entries, (*way, last) = tomllib.loads(TEXT), way_of(name)
    at(entries, way)[last] = value
    with pytest.raises(ModelError) as refused:
        read(folder, entries)
    return str(refused.value)


@pytest.mark.parametrize(
    ("name", "value", "message"),
    rows_of("test_an_entry_that_does_not_fit_is_refused_by_path"),
)
def test_an_entry_that_does_not_fit_is_refused_by_path(
    name: str, value: Any, message: str, tmp_path: Path
) -> None:
    said = told(tmp_path, name, value)
    assert message in said and "robot.toml" in said


def test_constructors_keep_the_ranges_of_the_file(tmp_path: Path) -> None:
    robot = read(tmp_path, tomllib.loads(TEXT))
    assert robot.standing == {"knee": 0.5, "hip": -1.0}
    assert robot.overlay.soles[0].place == (1.0, 2.0, 3.0)
    with pytest.raises(ModelError, match="lean must lie in"):
        replace(robot, lean=0.4)
    with pytest.raises(ModelError, match="torque must lie in"):
        replace(robot.overlay.servos["knee"], torque=-1.0)


def test_required_and_optional_entries_of_a_description(
    tmp_path: Path,
) -> None:
    whole = tomllib.loads(TEXT)
    optional = "working_limits gait sole control game sensors place overlay"
    for name in whole:
        rest = {key: value for key, value in whole.items() if key != name}
        if name in optional.split():
            read(tmp_path, rest)
            continue
        with pytest.raises(ModelError, match=f"missing entry {name}"):
            read(tmp_path, rest)
    servo = {"stiffness": 1.0, "damping": 1.0}
    assert "missing entry overlay.servos.knee.torque" in told(
        tmp_path, "overlay.servos.knee", servo
    )
