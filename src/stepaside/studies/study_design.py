"""Studies from files, presets and Python: a grid or list of settings."""

import json
import re
import tomllib
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from fnmatch import fnmatchcase
from functools import cache
from hashlib import sha256
from math import prod
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from ..core.entries import load_entries, read_entries
from ..core.errors import (
    AnyPath,
    ConfigurationError,
    as_path,
    check_choice,
    nearest_hint,
)
from ..games.player_settings import nested
from ..strategies.registry import file_of
from .study import MOST_CASES, Study
from .study_games import GAMES
from .tabulation import Record

PRESETS = Path(__file__).with_name("presets")
SEED = "seed"
COMMA = re.compile(r",(?![^(\[{]*[)\]}])")  # not one within brackets
OWN = re.compile(r'"([^"]+\.(?:py:[^"]+|onnx))"')  # file of a strategy
SPACING = {"first", "last", "number"}  # of evenly spaced values
RANGE = re.compile(r"(\d+):(\d+)")  # of seeds, without its end
SEEDS_OF_A_GAME = "0:20"  # of a game file
ENCODER = json.JSONEncoder(sort_keys=True, ensure_ascii=False)

Case = Mapping[str, Any]
"""Varied settings by name with dots; the name of each variant."""


class Cases(Sequence[Case]):
    """Product of axes, as a sequence that is not in memory.

    The last axis changes fastest, as in nested loops.
    """

    def __init__(self, axes: Sequence[tuple[str, Sequence[Any]]]) -> None:
        """Make the product of axes; values without a name are settings."""
        self.axes, self._number, self._places = axes, 1, list[Any]()
        for name, values in reversed(axes):
            self._places.insert(0, (name, values, self._number))
            self._number *= len(values)

    def __len__(self) -> int:
        """Return the number of cases."""
        return self._number

    def __getitem__(self, at: Any) -> Any:
        """Return the case of a number."""
        number, case = range(self._number)[at], dict[str, Any]()
        for name, values, stride in self._places:
            place, number = divmod(number, stride)
            if name:
                case[name] = values[place]
            else:
                case.update(values[place])
        return case


class _Design(NamedTuple):
    """What all cases share, and what the variants mean."""

    game: str | Callable[..., Record]
    settings: Mapping[str, Any]
    variants: Mapping[str, Mapping[Any, Mapping[str, Any]]]
    shown: tuple[str, ...]  # values of the table

    def settings_of(self, case: Case) -> Any:
        """Return the settings of a case."""
        if not isinstance(self.game, str):
            return {**self.settings, **case}
        entries = nested(self.settings)
        for name, value in case.items():
            changes = {name: value}
            if name in self.variants:
                changes = dict(self.variants[name][value])
            entries = nested(changes, entries)
        return GAMES[self.game].settings_of(entries)

    def measure(self, case: Case) -> Record:
        """Play the game of a case; return its record."""
        settings = self.settings_of(case)
        if not isinstance(self.game, str):
            return {**case, **self.game(**settings)}
        record = {**case, **GAMES[self.game].play(settings)}
        for name in self.shown:
            if "." not in name:  # those with dots depend on the players
                check_choice(name, record, "by or value")
        return record

    def fingerprint(self, axes: Sequence[tuple[str, Sequence[Any]]]) -> str:
        """Return a hash of what all share and of the strategy files."""
        varied = [each for _, each in axes if not isinstance(each, range)]
        game = self.game
        if not isinstance(game, str):
            game = f"{game.__module__}.{game.__qualname__}"
        shared = _json([game, self.settings, self.variants])
        found = [shared]
        for word in dict.fromkeys(OWN.findall(shared + _json(varied))):
            file = file_of(word)
            if file is not None and file.is_file():
                found.append(file.read_bytes().hex())
        return sha256(" ".join(found).encode()).hexdigest()[:12]


def make_study(
    game: str | Callable[..., Record],
    settings: Mapping[str, Any] | None = None,
    grid: Mapping[str, Sequence[Any]] | None = None,
    *,
    variants: Mapping[str, Mapping[Any, Mapping[str, Any]]] | None = None,
    cases: Sequence[Case] = ({},),
    by: Sequence[str] = (),
    values: Sequence[str] = (),
    name: str = "study",
) -> Study[Case]:
    """Return the study of all combinations of some settings.

    Args:
        game: Name of a game: duel, walk, push, person, game, tournament or
            unicycles; or a function that takes the settings of a case by
            name and returns its record.
        settings: Settings that all cases share, nested, or by name with dots
            like ``evasion.safety_radius``.
        grid: Values of each setting that varies, by name with dots.
        variants: Axes whose values change several settings: for each axis
            the settings by the name, or the number, of the variant.
        cases: List of settings, each combined with all others.
        by: Values that tell the rows of the table apart; by default all
            that vary but the seed.
        values: Values of the table; by default those of the game.
        name: Name of the study.

    Raises:
        ConfigurationError: If there is no case or are too many, or if a
            setting is unknown or out of its range.
    """
    shared, variants = dict(settings or {}), dict(variants or {})
    axes: list[tuple[str, Sequence[Any]]] = []
    if list(cases) != [{}]:
        axes.append(("", cases))
    axes += [(axis, list(named)) for axis, named in variants.items()]
    axes += [(axis, each) for axis, each in (grid or {}).items()]
    every = Cases(axes)
    number = prod(len(values) for _, values in axes)
    if not 1 <= number <= MOST_CASES:
        raise ConfigurationError(
            f"grid must have at least one and at most {MOST_CASES} cases, "
            f"got {number}"
        )
    varied = tuple(by) or tuple(each for each in every[0] if each != SEED)
    if isinstance(game, str):
        check_choice(game, GAMES, "game")
        values = tuple(values) or GAMES[game].values
    design = _Design(game, shared, variants, (*varied, *values))
    if isinstance(game, str):
        _check(design, every)
    own_of = cache(lambda: design.fingerprint(axes))
    return Study(
        name,
        every,
        design.measure,
        # As text it is ten times as fast as JSON.
        lambda case: f"{own_of()} {sorted(case.items())}",
        varied,
        tuple(values),
    )


@dataclass
class StudyFile:
    """Entries of a study file; see :func:`load_study`."""

    game: str = ""
    settings: dict[str, Any] = field(default_factory=dict)
    grid: dict[str, Any] = field(default_factory=dict)
    variants: dict[str, dict[str, Any]] = field(default_factory=dict)
    cases: tuple[dict[str, Any], ...] = ({},)
    by: tuple[str, ...] = ()
    values: tuple[str, ...] = ()


def load_study(
    file: AnyPath,
    sets: Sequence[str] = (),
    *,
    by: Sequence[str] = (),
    values: Sequence[str] = (),
) -> Study[Case]:
    """Return the study of a file or of a preset.

    A file has ``game``; ``settings`` that all cases share; ``grid``, a table
    of lists whose combinations are played; ``variants``, tables of named
    settings; ``cases``, a list of tables; ``by`` and ``values``, the table.
    In a grid ``"0:40"`` is a range without its end, as for seeds, and
    ``{first, last, number}`` gives evenly spaced values. A game file is the
    study of its game with 20 seeds.

    Args:
        file: TOML file, or the name of a preset.
        sets: Changes like ``duration=60``, ``evader=robust,look-ahead`` or
            ``seed=0:10``: the setting at a path, its values, or the variants
            of an axis, which may have wildcards.
        by: Values that tell the rows of the table apart; by default those
            of the file.
        values: Values of the table, likewise.

    Raises:
        ConfigurationError: If the file is not TOML, or an entry is unknown,
            of the wrong type or out of its range.
    """
    given, file = file, preset_file(file)
    if not file.is_file():
        presets = sorted(each.stem for each in PRESETS.glob("*.toml"))
        raise ConfigurationError(
            f"a study must be a file or one of {', '.join(presets)}, got "
            f"{str(given)!r:.80}{nearest_hint(str(given), presets)}"
        )
    entries = load_entries(file)
    if "game" not in entries and "players" in entries:
        made = StudyFile("game", entries, {SEED: SEEDS_OF_A_GAME})
    else:
        made = read_entries(StudyFile, entries, f"{file}")
    made.settings, made.grid = (
        dict(_flat(made.settings)),
        dict(_flat(made.grid)),
    )
    made.cases = tuple(dict(_flat(case)) for case in made.cases)
    for text in sets:
        _set(made, text)
    for axis, each in made.grid.items():
        made.grid[axis] = _values(axis, each, file)
    made.by, made.values = tuple(by) or made.by, tuple(values) or made.values
    return make_study(**vars(made), name=file.stem)


def preset_file(file: AnyPath) -> Path:
    """Return the file of a study: of a preset, or the file itself."""
    own = Path(as_path(file, "file"))
    preset = PRESETS / f"{own}.toml"
    return preset if preset.is_file() else own


def _set(made: StudyFile, text: str) -> None:
    """Change one setting, its values, or the variants of an axis."""
    path, equals, word = text.partition("=")
    if not equals or not path:
        raise ConfigurationError(
            f"a change must be PATH=VALUE like duration=60, got {text!r:.60}"
        )
    value = _value(word)
    named = made.variants.get(path)
    if named is not None:
        patterns = value if isinstance(value, list) else [value]
        chosen = dict[str, Any]()
        for each in map(str, patterns):
            found = [name for name in named if fnmatchcase(name, each)]
            if not found:
                check_choice(each, named, path)
            chosen |= {name: named[name] for name in found}
        made.variants[path] = chosen
    elif isinstance(value, list | dict) or RANGE.fullmatch(word):
        made.settings.pop(path, None)
        made.grid[path] = value
    elif path in made.grid:
        made.grid[path] = [value]
    else:
        made.settings[path] = value


def _value(word: str) -> Any:
    """Return what a word of a change means: TOML, a list, or text."""
    try:
        return tomllib.loads(f"value = {word}")["value"]
    except tomllib.TOMLDecodeError:
        parts = COMMA.split(word)
        return [_value(p) for p in parts] if len(parts) > 1 else word


def _values(axis: str, value: Any, file: Path) -> Sequence[Any]:
    """Return the values along an axis of a grid."""
    if isinstance(value, list):
        return value
    if isinstance(value, str) and (ends := RANGE.fullmatch(value)):
        return range(*map(int, ends.groups()))
    if isinstance(value, dict) and set(value) == SPACING:
        try:
            number = min(value["number"], MOST_CASES + 1)
            spaced = np.linspace(value["first"], value["last"], number)
        except (TypeError, ValueError) as error:
            raise ConfigurationError(f"{file}: {axis}: {error}") from error
        return [float(x) for x in spaced]
    raise ConfigurationError(
        f"{file}: {axis} must be a list, {{first, last, number}} or a range "
        f"like '0:40', got {value!r:.60}"
    )


def _flat(
    entries: dict[str, Any], prefix: str = ""
) -> Iterator[tuple[str, Any]]:
    """Yield the entries of nested tables by their names with dots."""
    for name, value in entries.items():
        if isinstance(value, dict) and set(value) != SPACING:
            yield from _flat(value, f"{prefix}{name}.")
        else:
            yield f"{prefix}{name}", value


def _check(design: _Design, cases: Cases) -> None:
    """Build the settings for each value of each axis, others at the first."""
    first = cases[0]
    design.settings_of(first)
    for name, values in cases.axes:
        ends = values if len(values) < 1000 else (values[0], values[-1])
        for value in ends:
            change = {name: value} if name else value
            _json(change)
            design.settings_of({**first, **change})


def _json(value: Any) -> str:
    """Return a value of a record, or of its key, as JSON."""
    try:
        return ENCODER.encode(value)
    except TypeError as error:
        raise ConfigurationError(
            "values that vary or are stored must be numbers, texts or "
            f"arrays, such as the name of a strategy: {error}"
        ) from error
