"""Test that entries become dataclasses, or are refused by path."""

from dataclasses import dataclass
from math import inf, nan
from pathlib import Path
from typing import Any, Literal, NamedTuple

import numpy as np
import pytest

from stepaside.core.entries import load_entries, read_entries, to_entries
from stepaside.core.errors import ConfigurationError, PlanError
from stepaside.core.ranges import Range
from stepaside.core.setting import REQUIRED, check_settings, setting
from stored_values import rows_of

LENGTH = Range(0.0, 2.0, "m", "of a foot", above=True, also=(inf,))


class Corner(NamedTuple):
    """Place, as a table or an array."""

    x: float
    y: float = 0.0


@dataclass(frozen=True)
class Part:
    """Inner section."""

    length: float = setting(1.0, "Length", LENGTH)
    kind: Literal["wood", "steel"] = setting("wood", "Kind")
    least: float = setting(0.0, "Least length", Range(0.0, 2.0, "m", ""))

    def __post_init__(self) -> None:
        """Check ranges and their order."""
        check_settings(self, PlanError)
        if self.length < self.least:
            raise PlanError("length must be at least least")


@dataclass(frozen=True)
class Whole:
    """Outer section."""

    name: str = setting(REQUIRED, "Name")
    count: int = setting(3, "Count", Range(1, 9, "1", "", whole=True))
    ready: bool = setting(False, "Ready")
    part: Part = setting(Part(), "Part")
    parts: tuple[Part, ...] = setting((), "Parts", count=(0, 2))
    lengths: dict[str, float] = setting({}, "Lengths", LENGTH)
    corners: tuple[Corner, ...] = setting((), "Corners")
    scale: float | tuple[float, float] | None = setting(None, "Scale")


WHOLE: dict[str, Any] = {
    "name": "toy",
    "count": 4,
    "ready": True,
    "part": {"length": 2},
    "parts": [{"kind": "steel"}, {"length": inf}],
    "lengths": {"a": 1},
    "corners": [[1, 2], {"x": 3}],
    "scale": [1, 2],
}


def test_entries_are_read_as_written() -> None:
    whole = read_entries(Whole, WHOLE)
    assert whole.part == Part(2.0) and whole.parts[1].length == inf
    assert whole.corners == (Corner(1.0, 2.0), Corner(3.0, 0.0))
    assert whole.scale == (1.0, 2.0) and whole.lengths == {"a": 1.0}
    assert isinstance(whole.part.length, float)
    assert read_entries(Whole, to_entries(whole)) == whole
    assert "scale" not in to_entries(Whole("toy"))


def test_omitted_entries_are_those_of_the_base() -> None:
    base = read_entries(Whole, WHOLE)
    read = read_entries(Whole, {"part": {"kind": "steel"}}, base=base)
    assert read.part == Part(2.0, "steel") and read.count == 4


@pytest.mark.parametrize(
    ("changes", "message"),
    rows_of("test_what_does_not_fit_is_refused_by_path"),
)
def test_what_does_not_fit_is_refused_by_path(
    changes: dict[str, Any], message: str
) -> None:
    with pytest.raises(PlanError, match=f"toy.toml: .*{message}"):
        read_entries(Whole, WHOLE | changes, "toy.toml", error=PlanError)


def test_at_most_five_problems_are_listed() -> None:
    lengths = {f"n{i}": -1 for i in range(9)}
    with pytest.raises(ConfigurationError, match="n4 .*; 4 more$"):
        read_entries(Whole, {"name": "", "lengths": lengths})


def test_constructors_keep_the_same_rules() -> None:
    part = Part(np.float32(0.5))  # type: ignore[arg-type]
    assert type(part.length) is float
    for wrong in (nan, True, 3.0, "1"):
        with pytest.raises(PlanError, match=r"length must lie in .*\[m\]"):
            Part(wrong)  # type: ignore[arg-type]


def test_files_are_toml_or_json(tmp_path: Path) -> None:
    for name, text in (("a.toml", "x = 1"), ("a.JSON", '{"x": 1}')):
        (tmp_path / name).write_text(text)
        assert load_entries(tmp_path / name) == {"x": 1}
    (tmp_path / "b.toml").write_text("x =")
    (tmp_path / "b.json").write_text("[1]")
    for name in ("b.toml", "b.json", "missing.toml"):
        with pytest.raises(ConfigurationError, match=name):
            load_entries(tmp_path / name)
