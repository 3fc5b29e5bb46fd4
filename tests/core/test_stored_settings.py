"""Test that defaults, units and ranges of settings are those that are stored.

Files, commands and Python rely on them. After a change that is meant::

    PYTHONPATH=src python tests/core/test_stored_settings.py
"""

from collections.abc import Iterable
from dataclasses import is_dataclass
from importlib import import_module
from math import inf, nan
from pathlib import Path
from pkgutil import walk_packages
from typing import Any, cast

import pytest

import stepaside
from stepaside.core.errors import StepAsideError
from stepaside.core.setting import REQUIRED, descriptions_of, entries_of

STORED = Path(__file__).parents[1] / "data" / "settings.txt"
LEFT_OUT = ("__main__", "stable_baselines")  # runs, needs more


def text_of(value: Any) -> str:
    """Return a default; of a dataclass what its own defaults are not."""
    if not is_dataclass(value):
        return repr(value).partition(" object at ")[0]
    changes = [
        f"{name}={text_of(getattr(value, name))}"
        for name, entry in entries_of(cast(Any, type(value))).items()
        if "." not in name and getattr(value, name) != entry.default
    ]
    return f"{type(value).__name__}({', '.join(changes)})"


def lines_of(kind: type[Any]) -> list[str]:
    """Return a line for each setting of a class."""
    name, entries = kind.__qualname__, entries_of(cast(Any, kind))
    lines: list[str] = []
    for field, described in descriptions_of(kind).items():
        known = described.range
        limits = known and f"{known.words} [{known.unit}]"
        facts: list[Any] = [
            limits,
            described.names,
            described.needs,
            described.count,
        ]
        if field in entries:
            facts.insert(0, text_of(entries[field].default))
        shown = [str(each) for each in facts if each]
        shown += map(str, described.presets or ())
        lines.append(f"{kind.__module__} {name}.{field}: {'; '.join(shown)}")
    return lines


def all_lines(paths: Iterable[str]) -> list[str]:
    """Return the lines of classes, each by its module and name."""
    lines: list[str] = []
    for path in sorted(paths):
        module, _, name = path.partition(" ")
        lines += lines_of(getattr(import_module(module), name))
    return lines


OF_DESCRIPTIONS = ("Contract", "Description", "Mount", "YawCoupling")
STORED_LINES = STORED.read_text("utf-8").splitlines()
PATHS = {x.partition(":")[0].rpartition(".")[0] for x in STORED_LINES}


def test_settings_have_the_stored_defaults_and_ranges() -> None:
    assert all_lines(PATHS) == STORED_LINES


@pytest.mark.parametrize(
    "path", sorted(x for x in PATHS if not x.endswith(OF_DESCRIPTIONS))
)
def test_values_out_of_range_are_refused_by_the_name_of_their_setting(
    path: str,
) -> None:
    module, _, name = path.partition(" ")
    kind: Any = getattr(import_module(module), name)
    described, entries = descriptions_of(kind), entries_of(kind)
    rest = {
        name: each.described.names[0] if each.described.names else 1.0
        for name, each in entries.items()
        if each.default is REQUIRED and "." not in name
    }
    for field, each in described.items():
        default = entries[field].default if field in entries else ()
        known, plain = each.range, (int, float, type(None), type(REQUIRED))
        if known is None or not isinstance(default, plain):
            continue
        for value in (nan, known.low - 1.0, known.high + 1.0):
            if value not in known.also and value not in (-inf, inf):
                with pytest.raises(StepAsideError, match=field):
                    kind(**rest | {field: value})


if __name__ == "__main__":
    paths = {
        f"{kind.__module__} {kind.__qualname__}"
        for each in walk_packages(stepaside.__path__, "stepaside.")
        if not each.name.endswith(LEFT_OUT)
        for kind in vars(import_module(each.name)).values()
        if isinstance(kind, type) and kind.__module__ == each.name
        if is_dataclass(kind) and descriptions_of(kind)
    }
    STORED.write_text("\n".join(all_lines(paths)) + "\n", "utf-8")
