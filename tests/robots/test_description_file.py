"""Test that a description is read whole, and refused entry by entry."""

import tomllib
from pathlib import Path
from typing import Any

import pytest
import tomli_w

from stepaside.core.errors import ModelError
from stepaside.robots.description_file import REQUIRED, read_entries

FEET = [f"foot_{i}" for i in range(8)]
TEXT = f"""
name = "Toy"
model = "toy.xml"
torso = "trunk"
left_foot = "l"
right_foot = "r"
legs = ["left", "right"]
standing = {{ knee = 0.5, hip = -1 }}
speed_limits = {{ knee = 4.0 }}
accent = "red"
working_limits = {{ knee = [-0.1, 2] }}
gait = {{ stride = 0.05 }}
sole = {{ back = -0.05, front = 0.1 }}
control = {{ method = "mpc" }}
game = {{ distance = 2.0 }}
sensors = {{ gyro = "g", accelerometer = "a", feet = {FEET} }}
place = {{ forward = -0.02, reach = 0.9 }}
[overlay]
meshes = ["meshes"]
turn = [0.5, 0.5, -0.5, 0.5]
soles = [
  {{ body = "left", place = [1, 2, 3], turn = [1, 0, 0, 0.5] }},
  {{ body = "right", place = [1, -2, 3], turn = [1, 0, 0, 0] }},
]
[overlay.servos.knee]
stiffness = 50.0
damping = 0
torque = 7.0
armature = 0.01
"""


Way = list[str | int]


def way_of(name: str) -> Way:
    return [int(part) if part.isdigit() else part for part in name.split(".")]


def at(entries: Any, way: Way) -> Any:
    for part in way:
        entries = entries[part]
    return entries


def read(folder: Path, entries: dict[str, Any]) -> dict[str, Any]:
    file = folder / "robot.toml"
    file.write_text(tomli_w.dumps(entries))
    return read_entries(file)


def told(folder: Path, name: str, value: Any) -> str:
    """Message about a description with one changed value."""
    entries, (*way, last) = tomllib.loads(TEXT), way_of(name)
    at(entries, way)[last] = value
    with pytest.raises(ModelError) as refused:
        read(folder, entries)
    return str(refused.value)


@pytest.mark.parametrize(
    ("name", "value", "message"),
    [
        ("name", 1, "name must be a name, got 1"),
        ("legs", "left", "legs must be an array of values"),
        ("legs", ["left", 1], "legs must be a name"),
        ("standing.knee", "bent", "standing.knee must be a finite number"),
        ("standing.knee", True, "standing.knee must be a finite number"),
        ("standing.knee", float("inf"), "must be a finite number"),
        ("speed_limits.knee", 0.0, "speed_limits.knee must be a number > 0"),
        ("working_limits.knee", [1, 1], "a range [low, high] with low < high"),
        ("gait", 1, "gait must be a table"),
        ("place.reach", 0, "place.reach must be a number > 0"),
        ("place.ahead", 0, "unknown entry place.ahead; there are forward"),
        ("overlay.servos.knee.stiffness", 0, "must be a number > 0, got 0"),
        ("overlay.servos.knee.torque", 0, "must be a number > 0, got 0"),
        ("overlay.servos.knee.damping", -1, "must be a number >= 0, got -1"),
        ("overlay.servos.knee.armature", -1, "must be a number >= 0, got -1"),
        ("colour", "red", "unknown entry 'colour'; there are name, "),
    ],
)
def test_an_entry_of_another_type_is_refused_by_name(
    name: str, value: Any, message: str, tmp_path: Path
) -> None:
    said = told(tmp_path, name, value)
    assert message in said and "robot.toml" in said


def test_required_and_optional_entries_of_a_description(
    tmp_path: Path,
) -> None:
    whole = tomllib.loads(TEXT)
    for name in whole:
        rest = {key: value for key, value in whole.items() if key != name}
        if name not in REQUIRED:
            assert name not in read(tmp_path, rest)
            continue
        with pytest.raises(ModelError, match=f"entry '{name}' is missing"):
            read(tmp_path, rest)
    servo = {"stiffness": 1.0, "damping": 1.0}
    assert "entry overlay.servos.knee.torque is missing" in told(
        tmp_path, "overlay.servos.knee", servo
    )
