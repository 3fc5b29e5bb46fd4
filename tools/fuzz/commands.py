"""Every option of every command, with every invalid value."""

from collections.abc import Iterator
from functools import cache
from math import tau
from pathlib import Path
from random import Random
from typing import Any

import click

from stepaside.cli.main import all_commands
from stepaside.cli.options.parameter_types import (
    UNITS,
    AngleType,
    NameType,
    NumberType,
    WordOrValueType,
)
from stepaside.cli.options.setting_options import SettingOption
from stepaside.core.ranges import Range

from .case import Case
from .invoking import command_case
from .values import ANGLES, NUMBERS, TEXTS, around

# Arguments that keep commands short; other commands are short by themselves.
SHORT = ["--duration=0.02", "--json"]
BASES = {
    "duel": SHORT,
    "game": ["--level=unicycle", *SHORT],
    "games": ["--seeds=0:1", "--workers=1", "--level=unicycle", *SHORT],
    "duels": ["--seeds=0:1", *SHORT],
    "view": ["--no-open", "--serve-for=0.01", "--port=8601"],
    "replay": ["--no-open", "--serve-for=0.01", "--port=8602"],
    "export": ["--to=urdf", "--json"],
    "walk": SHORT,
    "robustness": ["--kind=friction", "--seeds=1", "--json"],
    "plan": ["--role=evader", "--bearing=0.3", "--steps=4", "--json"],
    "unicycles": ["--duration=1", "--json"],
    "circle": ["--starts=2", "--json"],
    "map": ["--grid=2", "--distances=1", "--duration=1", "--json"],
    "bound": ["--grid=16", "--refine=0", "--games=0", "--horizon=0.05"],
    "play": [
        *("--role=evader", "--robot=lola:none", "--duration=0.1"),
        "--wait=0.05",
    ],
    "serve": ["--lola=evader=socket", "--wait=0.05", "--lockstep", *SHORT],
    "reproduce": ["--runs=1", "--json"],
    "tournament": [
        *("--seeds=0:1", "--duration=1", "--evader=aside"),
        *("--room=open", "--workers=1", "--json"),
    ],
    "rate": ["aside", "--games=1", "--duration=1", "--workers=1", "--json"],
    "robot": ["--json"],
}
# What they read, where that is no run.
EXAMPLES = Path(__file__).parents[2] / "examples"
FILES = dict.fromkeys(("game", "games"), EXAMPLES / "two-pursuers.toml")
PATHS = (
    *("", ".", "..", "/", "/proc/x", "/dev/full", "/dev/null", "here/x"),
    *("a" * 300, "file/x", "loop", "dangling", "o.xyz", "file"),
    *("folder", "\x1b[2J.png", "a\udc80.png", "x.png/", "fifo", "x.html"),
)


def command_cases(random: Random, run: Path) -> Iterator[Case]:
    """Yield each option alone with each value, in random order.

    Args:
        random: Determines the order.
        run: Run folder, for commands that read one.
    """
    cases = [
        (name, option, text)
        for name in all_commands()
        for option in options_of(name)
        for text in texts_for(option)
    ]
    random.shuffle(cases)
    for name, option, text in cases:
        words = [
            *name.split(),
            *base_of(name, run),
            f"{option.opts[0]}={text}",
        ]
        refused = must_be_refused(option, text)
        yield command_case(f"options of {name}", words, refused=refused)


def combined_cases(random: Random, run: Path) -> Iterator[Case]:
    """Yield combinations of several options, without end."""
    while True:
        name = random.choice(list(all_commands()))
        words = [*name.split(), *base_of(name, run)]
        refused = False
        for option in random.choices(options_of(name), k=random.randint(2, 5)):
            text = random.choice(texts_for(option))
            words.append(f"{option.opts[0]}={text}")
            refused |= must_be_refused(option, text) and option.multiple
        yield command_case("options together", words, refused=refused)


def base_of(name: str, run: Path) -> list[str]:
    """Return the arguments that a command requires and that keep it short."""
    base = list(BASES.get(name, ()))
    for param in command_of(name).params:
        if isinstance(param, click.Argument) and param.required:
            base.append(str(FILES.get(name, run)))
    return base


@cache
def command_of(name: str) -> click.Command:
    """Return a command by its name."""
    return all_commands()[name]


@cache
def options_of(name: str) -> list[click.Option]:
    """Return the options of a command."""
    found = command_of(name).params
    return [param for param in found if isinstance(param, click.Option)]


@cache
def texts_for(option: click.Option) -> tuple[str, ...]:
    """Return values to try for an option."""
    kind: Any = option.type
    more: list[str] = []
    if isinstance(kind, WordOrValueType):
        more, kind = [*kind.words], kind.kind
    allowed = range_of(option)
    if option.is_flag:
        return ("", "1", "no")
    if isinstance(kind, AngleType):
        more += ANGLES
    if allowed is not None:
        return (*NUMBERS, *around(allowed), *more)
    if isinstance(kind, NameType):
        return (*kind.choices, *TEXTS, *more)
    if "output" in option.opts[0] or kind.name in ("file", "path"):
        return (*PATHS, *TEXTS)
    return (*TEXTS, *more)


@cache
def range_of(option: click.Option) -> Range | None:
    """Return the range of a numeric option; None for other options."""
    kind: Any = option.type
    if isinstance(kind, WordOrValueType):
        kind = kind.kind
    if isinstance(option, SettingOption):
        return option.entry.setting.range
    if isinstance(kind, NumberType):
        return kind.range
    if isinstance(kind, AngleType):
        return Range(-tau, tau, "rad", "one turn")
    if isinstance(kind, click.IntRange):
        assert kind.min is not None and kind.max is not None, option.opts
        return Range(kind.min, kind.max, "1", "", whole=True)
    return None


def must_be_refused(option: click.Option, text: str) -> bool:
    """Return whether a value is outside the option's range, independently."""
    kind: Any = option.type
    if option.is_flag:
        return True
    if isinstance(kind, WordOrValueType):
        if text in kind.words:
            return False
        kind = kind.kind
    if isinstance(kind, NameType):
        return text not in kind.choices
    allowed = range_of(option)
    if allowed is None:
        return False
    number = _number_in(text, isinstance(kind, AngleType))
    if number is None:
        return True
    # None is a word of its own, and infinity is where it is named.
    return not allowed._replace(whole=False).holds(number)


def _number_in(text: str, angle: bool) -> float | None:
    scale = 1.0
    for unit, factor in UNITS.items():
        if angle and text.endswith(unit):
            text, scale = text.removesuffix(unit), factor
            break
    for kind in (int, float):  # whole numbers have all their digits
        try:
            return kind(text) * scale if angle else kind(text)
        except ValueError:
            pass
    return None
