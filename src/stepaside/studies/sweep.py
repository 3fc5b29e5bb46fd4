"""Studies of a user: any grid or list of settings of a game, from a file."""

import json
from collections import defaultdict
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from functools import partial
from hashlib import sha256
from math import prod
from pathlib import Path
from typing import Any

import numpy as np

from ..core.entries import load_entries
from ..core.errors import ConfigurationError
from ..games.configuration_file import (
    json_settings,
    over,
    parse_settings,
)
from ..strategies.registry import file_of
from .case_grid import CaseGrid
from .study import MOST_CASES, Study
from .sweep_games import GAMES, SweepGame
from .tabulation import Record, half_interval

SEED = "seed"
SECTIONS = ("game", "settings", "grid", "cases")
SPACING = ("first", "last", "number")  # of evenly spaced values

Case = tuple[Any, ...]
"""One value of each axis; of the axis of cases, a table of settings."""


@dataclass(frozen=True)
class Sweep:
    """Grid or list of settings of a game.

    Attributes:
        game: Name of the game, a key of ``GAMES``.
        base: Entries that all cases share, as in a configuration file.
        axes: Names of the varied settings with dots, like
            ``strategy.safety_radius``; the first is empty for the list of
            cases.
        values: Values along each axis.
    """

    game: str
    base: dict[str, Any]
    axes: tuple[str, ...]
    values: tuple[Sequence[Any], ...]

    @property
    def cases(self) -> CaseGrid:
        """All cases, in the order of nested loops."""
        return CaseGrid(*self.values)

    def changes(self, case: Case) -> dict[str, Any]:
        """Return the varied settings of a case, by name with dots."""
        found: dict[str, Any] = {}
        for name, value in zip(self.axes, case, strict=True):
            found |= {name: value} if name else value
        return found

    def settings(self, case: Case) -> Any:
        """Return the settings of a case.

        Raises:
            ConfigurationError: If an entry is unknown or out of its range.
        """
        entries = self.base
        for name, value in self.changes(case).items():
            entries = over(entries, _nested(name, value))
        kind = GAMES[self.game].settings
        source = json.dumps(self.changes(case)) or "the settings"
        return parse_settings(kind, entries, source)


def load_sweep(file: Path) -> Sweep:
    """Read a study file.

    It has ``game``; optionally the table ``settings`` that all cases share;
    and ``grid``, a table of lists whose combinations are played, or
    ``cases``, a list of tables, or both. In a grid, ``"0:40"`` for the seed
    is a range without its end, and ``{first, last, number}`` gives evenly
    spaced values.

    Args:
        file: TOML file.

    Raises:
        ConfigurationError: If the file is not TOML, or an entry is unknown,
            of the wrong type or out of its range.
    """
    entries = load_entries(file)
    for name in entries:
        if name not in SECTIONS:
            raise ConfigurationError(
                f"{file}: unknown entry {name}; there are "
                f"{', '.join(SECTIONS)}"
            )
    game = entries.get("game")
    if not isinstance(game, str) or game not in GAMES:
        raise ConfigurationError(
            f"{file}: game must be one of {', '.join(GAMES)}, got {game!r:.40}"
        )
    cases, grid = entries.get("cases"), entries.get("grid", {})
    axes: list[str] = []
    values: list[Sequence[Any]] = []
    if cases is not None:
        axes.append("")
        values.append([dict(_flat(case, file)) for case in cases])
    for name, value in _flat(grid, file, leaves=SPACING):
        axes.append(name)
        values.append(_axis(name, value, file))
    if not values or not all(values):
        raise ConfigurationError(
            f"{file}: grid or cases must have at least one case, got none"
        )
    number = prod(map(len, values))
    if number > MOST_CASES:
        raise ConfigurationError(
            f"{file}: there must be at most {MOST_CASES} cases, got {number}"
        )
    base = entries.get("settings", {})
    sweep = Sweep(game, base, tuple(axes), tuple(values))
    _check(sweep)
    return sweep


def sweep_study(sweep: Sweep) -> Study[Case]:
    """Return the study of a sweep."""
    inputs = [sweep.game, sweep.base, list(_strategy_files(sweep))]
    own = sha256(json.dumps(inputs, sort_keys=True).encode())
    prefix = f"{sweep.game}/{own.hexdigest()[:12]}"

    def key_of(case: Case) -> str:
        return f"{prefix}/{json.dumps(sweep.changes(case), sort_keys=True)}"

    return Study(
        "study",
        sweep.cases,
        partial(_play_case, sweep),
        key_of,
    )


def sweep_rows(
    sweep: Sweep,
    results: Iterable[tuple[Case, Record]],
    values: Sequence[str] = (),
) -> list[dict[str, Any]]:
    """Tabulate the results of a sweep over seeds.

    Args:
        sweep: The sweep.
        results: Cases and their records.
        values: Names of the values to tabulate; that of the game by default.

    Returns:
        For each combination of settings other than the seed: the settings,
        the number of cases, the number of each outcome, and of each value
        mean, half of its 95 % interval, least and greatest.

    Raises:
        ConfigurationError: If no record has a value.
    """
    names = tuple(values) or (GAMES[sweep.game].value,)
    groups: dict[str, list[Record]] = defaultdict(list)
    for case, record in results:
        changes = sweep.changes(case)
        changes.pop(SEED, None)
        groups[json.dumps(changes)].append(record)
    rows = []
    for text, records in groups.items():
        outcomes = [record["outcome"] for record in records]
        row = {
            "settings": json.loads(text),
            "cases": len(records),
            "outcomes": {
                name: outcomes.count(name) for name in dict.fromkeys(outcomes)
            },
        }
        for name in names:
            found = [record.get(name) for record in records]
            row[name] = _statistics([x for x in found if x is not None])
        rows.append(row)
    for name in names:
        if rows and not any(name in r for g in groups.values() for r in g):
            some = next(iter(groups.values()))[0]
            raise ConfigurationError(
                f"value must be one of {', '.join(some)}, got {name!r:.40}"
            )
    return rows


def _play_case(sweep: Sweep, case: Case) -> Record:
    game: SweepGame = GAMES[sweep.game]
    return {**sweep.changes(case), **game.play(sweep.settings(case))}


def _statistics(values: list[float]) -> dict[str, float] | None:
    if not values:
        return None
    each = np.array(values, dtype=np.float64)
    return {
        "mean": float(each.mean()),
        "half_interval": half_interval(each),
        "least": float(each.min()),
        "greatest": float(each.max()),
    }


def _check(sweep: Sweep) -> None:
    """Build the settings for each value of each axis, others at the first."""
    first = [axis[0] for axis in sweep.values]
    for i, axis in enumerate(sweep.values):
        name = sweep.axes[i]
        checked = (axis[0], axis[-1]) if name == SEED else axis
        for value in checked:
            case = (*first[:i], value, *first[i + 1 :])
            json_settings(sweep.settings(case))


def _axis(name: str, value: Any, file: Path) -> Sequence[Any]:
    """Return the values along an axis of a grid."""
    if isinstance(value, list):
        return value
    if name == SEED and isinstance(value, str):
        first, colon, end = value.partition(":")
        if colon and first.isdigit() and end.isdigit():
            return range(int(first), int(end))
    if isinstance(value, dict) and set(value) == set(SPACING):
        try:
            spaced = np.linspace(
                value["first"],
                value["last"],
                min(value["number"], MOST_CASES + 1),
            )
        except (TypeError, ValueError) as error:
            raise ConfigurationError(f"{file}: {name}: {error}") from error
        return [float(x) for x in spaced]
    raise ConfigurationError(
        f"{file}: {name} must be a list, {{first, last, number}}, or for "
        f"{SEED} a range like '0:40', got {value!r:.60}"
    )


def _flat(
    entries: Any, file: Path, prefix: str = "", leaves: Sequence[str] = ()
) -> Iterator[tuple[str, Any]]:
    """Yield the entries of nested tables by their names with dots."""
    if not isinstance(entries, dict):
        raise ConfigurationError(
            f"{file}: grid and cases must be tables, got {entries!r:.40}"
        )
    for name, value in entries.items():
        if isinstance(value, dict) and set(value) != set(leaves):
            yield from _flat(value, file, f"{prefix}{name}.", leaves)
        else:
            yield f"{prefix}{name}", value


def _nested(name: str, value: Any) -> dict[str, Any]:
    for part in reversed(name.split(".")):
        value = {part: value}
    nested: dict[str, Any] = value
    return nested


def _strategy_files(sweep: Sweep) -> Iterator[str]:
    """Yield the content of the strategy files that a sweep names."""
    words = [v for axis in sweep.values for v in axis if isinstance(v, str)]
    for case in sweep.values[0]:
        if isinstance(case, dict):
            words += [v for v in case.values() if isinstance(v, str)]
    words += [value for value in sweep.base.values() if isinstance(value, str)]
    for word in dict.fromkeys(words):
        file = file_of(word)
        if file is not None and file.is_file():
            yield file.read_bytes().hex()
