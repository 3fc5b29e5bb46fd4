"""Every entry of every configuration, with every invalid value."""

import tomllib
from collections.abc import Iterator
from pathlib import Path
from random import Random
from typing import Any

from stepaside.cli.plan import PlanSettings
from stepaside.core.errors import StepAsideError
from stepaside.core.setting import ranges_of
from stepaside.games.configuration_file import read_settings
from stepaside.games.duel_settings import DuelSettings
from stepaside.games.walk_settings import WalkSettings
from tools.documents.tables.settings import LISTS, all_settings

from .case import Case
from .values import around

KINDS = {"duel": DuelSettings, "walk": WalkSettings, "plan": PlanSettings}
VALUES = (
    *("nan", "inf", "-inf", "true", "false", '"text"', '""', "[]", "{}"),
    *("1e18", "-1e18", "1e300", "5e-324", "-1", "0", "-0.0", "1e-18", "1.5"),
    *("9" * 5000, "9" * 300, "[" * 900 + "]" * 900, "[1, 2]", "{ a = 1 }"),
    *("1979-05-27", "0x10", "1_000", "'''\n'''", '"\\u0000"', '"\\u202e"'),
    *("[{}]", "[[]]", "[true]", "", "=", "nope", '"\\ud800"', "07:32:00"),
)


def configuration_cases(random: Random) -> Iterator[Case]:
    """Yield each entry alone with each value, in random order."""
    cases = []
    for path, setting in all_settings().items():
        allowed = ranges_of(setting.kind).get(setting.name)
        values = [*VALUES, *(around(allowed) if allowed is not None else ())]
        for text in values:
            bad = allowed is not None and not allowed.holds(_value(text))
            cases.append((path, text, bad))
    random.shuffle(cases)
    for path, text, bad in cases:
        for name, kind in KINDS.items():
            yield _case(name, kind, path, text, bad)


def _value(text: str) -> Any:
    """Return the TOML value of a text; the text if it is invalid TOML."""
    try:
        return tomllib.loads(f"x = {text}")["x"]
    except (ValueError, RecursionError):
        return "nothing"


def _case(name: str, kind: Any, path: str, text: str, bad: bool) -> Case:
    lines = _lines(path, text)

    def run(_: Path) -> str:
        try:
            read_settings(kind, lines, "file.toml")
        except StepAsideError as error:
            said = str(error)
            short = len(said) < 1000 and said.count("\n") <= 1
            return "" if short else f"more than a line: {said[:300]!r}"
        return "accepted nonsense" if bad else ""

    shown = text if len(text) < 60 else f"{text[:20]}...({len(text)})"
    return Case("settings", f"{name} {path} = {shown}", run)


def _lines(path: str, text: str) -> str:
    """Return the entry alone, as TOML."""
    for listed in LISTS:
        if path.startswith(f"{listed}[]."):
            entry = path.removeprefix(f"{listed}[].")
            return f"{listed} = [{{ {entry} = {text} }}]"
    return f"{path} = {text}"
