"""Settings of commands: a few as options, all by ``--set PATH=VALUE``.

In order of increasing priority: defaults, the file of ``--config``, presets
such as ``--body``, single settings.
"""

import tomllib
from collections.abc import Callable, Collection, Iterator, Mapping, Sequence
from functools import partial, wraps
from math import degrees
from operator import attrgetter
from pathlib import Path
from typing import Any, get_args, get_origin

import click

from ..arena import RoomRecipe
from ..core.setting import (
    NONE,
    REQUIRED,
    Entry,
    entries_of,
    similar_paths,
)
from ..games.game_settings import (
    NOT_PLAYERS,
    OF_ALL,
    RECIPE,
    GameSettings,
    read_game,
)
from ..games.player_settings import PlayerSettings, nested, settings_of
from ..games.settings_reader import load_settings
from .options import EXISTING_FILE
from .terminal import write_result

lists_option = click.option(
    "--settings",
    "lists",
    is_flag=True,
    help="Print all settings with meaning, unit and range, and end.",
)
config_option = click.option(
    "--config",
    type=EXISTING_FILE,
    help="File of settings (TOML); options override it.",
)
set_option = click.option(
    "--set",
    "sets",
    multiple=True,
    metavar="PATH=VALUE",
    help="Any setting, as --settings lists them; repeatable.",
)
Decorator = Callable[[Callable[..., Any]], Callable[..., Any]]
MEANINGS = {
    "robot": "Robot: nao, or the folder of a description",
    "gait": "Gait of NAO",
    "body": "Imperfections of the body",
    "senses": "Sensing of opponents",
    "room": "Room: a file, or the seed of a random one",
    "strategy": "Strategy of the player (docs/strategies.md)",
    "evader.strategy": "Strategy of the evader (docs/strategies.md)",
    "pursuer.body": "Body of the pursuer: robot or person",
    "start.distance": "Initial distance [m]; drawn by default",
    "pushes": "Push: 1.2@5:90deg is 1.2 N s at 5 s, to the left; repeatable",
}
"""Short meanings of options, by path; --settings has the long ones."""
FLAGS = {
    "senses": "--sensing",
    "pursuer.body": "--pursuer",
    "pushes": "--push",
}
"""Options that are not named like their setting, by its path."""
CONTROL = ("control.method", "control.feedback")
IMPLY: Mapping[str, tuple[str, ...]] = {
    "body": CONTROL,
    "gait": (*CONTROL, "evasion.trigger"),
    "pursuer.body": ("evasion.trigger",),
}
"""Entries of a file that an option leaves open again, as it implies them."""
GIVEN = "stepaside.given"  # of a context: given settings, and --config


def takes_settings(
    named: Sequence[str],
    kind: Any,
    *,
    config: Decorator = config_option,
) -> Decorator:
    """Add options of settings, ``--set``, ``--config`` and ``--settings``.

    Args:
        named: Paths of settings with an option of their own.
        kind: Class of the argument ``settings``, or the game that they change.
        config: Option, or argument, of the file.
    """
    entries = _entries_of(kind)

    def decorate(function: Callable[..., Any]) -> Callable[..., Any]:
        @wraps(function)
        def command(**values: Any) -> Any:
            texts = [
                (path, text)
                for path in named
                for text in _texts(values.pop(_argument(path)))
            ]
            texts += [set_pair(text) for text in values.pop("sets")]
            settings = _read(kind, texts, values.pop("config"))
            if values.pop("lists"):
                from .settings_text import commented

                return write_result(commented(settings))
            return function(settings=settings, **values)

        command.__dict__["entries"] = entries  # for hints
        result: Callable[..., Any] = command
        for option in (lists_option, config, set_option):
            result = option(result)
        for path in reversed(named):
            result = _option(path, entries[path])(result)
        return result

    return decorate


def _entries_of(kind: Any) -> Mapping[str, Entry]:
    """Return every setting of a class, or of a game, by its path."""
    if not isinstance(kind, GameSettings):
        return entries_of(kind)
    game, own = entries_of(GameSettings), entries_of(PlayerSettings)
    common = {k: v for k, v in own.items() if k.split(".")[0] in OF_ALL}
    found = {k: v for k, v in game.items() if k != "players"} | common
    for name in kind.names:
        if name not in NOT_PLAYERS:
            found |= entries_of(PlayerSettings, name)
    return found | entries_of(RoomRecipe, RECIPE)


def flag_of(path: str) -> str:
    """Return the option of a setting that has one of its own."""
    name = path.rpartition(".")[2].replace("_", "-")
    return FLAGS.get(path, f"--{name}")


def _option(path: str, entry: Entry) -> Decorator:
    """Return the option of a setting; its value is a text."""
    described, default = entry.described, _default(entry)
    text = MEANINGS.get(path, described.text).rstrip(".") + "."
    if default:
        text += f"  [default: {default}]"
    option = partial(click.option, flag_of(path), _argument(path), help=text)
    if entry.hint is bool:
        return option(is_flag=True, default=None)
    names = described.presets or described.names
    unit = described.range and described.range.unit
    metavar = "|".join(names) if names else "NUMBER" if unit else "TEXT"
    return option(
        multiple=_is_list(entry),
        metavar="ANGLE" if unit == "rad" else metavar,
    )


def _default(entry: Entry) -> str:
    """Return the default as a user writes it; empty if there is none."""
    described, value = entry.described, entry.default
    if described.default_text:
        return described.default_text
    for name, meant in (described.presets or {}).items():
        if value == meant:
            return str(name)
    if value in (None, (), "", False, REQUIRED):
        return ""
    if described.range and described.range.unit == "rad":
        return f"{degrees(value):g}deg"
    return f"{value:g}" if isinstance(value, float) else str(value)


def _argument(path: str) -> str:
    return f"option_{path.replace('.', '_')}"


def _is_list(entry: Entry) -> bool:
    kind, kinds = get_origin(entry.hint), get_args(entry.hint)
    return kind is list or kind is tuple and kinds[-1] is ...


def _texts(value: Any) -> tuple[str, ...]:
    if isinstance(value, bool | None):
        return () if value is None else (str(value).lower(),)
    return value if isinstance(value, tuple) else (value,)


def set_pair(text: str) -> tuple[str, str]:
    """Return path and value of ``--set``.

    Raises:
        UsageError: If it has no value.
    """
    path, equals, value = text.partition("=")
    if not equals:
        raise click.UsageError(
            f"--set must be PATH=VALUE like gait.stride=0.03, got {text}"
        )
    return path, value


def changes_of(
    texts: Collection[tuple[str, str]],
    entries: Mapping[str, Entry],
) -> dict[str, Any]:
    """Return values by path; those of a list are collected.

    Args:
        texts: Paths and values as a user writes them.
        entries: Settings by path.

    Raises:
        UsageError: If there is no such path; the message names similar ones.
    """
    found = dict[str, Any]()
    for path, text in texts:
        if path not in entries:
            near = similar_paths(entries, path)
            hint = f"; did you mean {' or '.join(near)}?" if near else ""
            raise click.UsageError(
                f"unknown setting {path}; --settings lists all{hint}"
            )
        entry = entries[path]
        value = _value(text, entry)
        presets = entry.described.presets or {}
        if _is_list(entry) and value not in [*presets]:
            more = value if isinstance(value, list) else [value]
            value = [*found.get(path, ()), *(x for x in more if x != NONE)]
        found[path] = value
    return found


def _value(text: str, entry: Entry) -> Any:
    """Return what a text means: a text, a value of TOML, or a number."""
    if entry.hint in (str, Path) or str in get_args(entry.hint):
        return text
    try:
        value = tomllib.loads(f"x = {text}")["x"]
    except (ValueError, RecursionError):
        try:
            return float(text)
        except ValueError:
            return text
    plain = isinstance(value, bool | int | float | str | list | dict)
    return value if plain else text


def _read(
    kind: Any,
    texts: Sequence[tuple[str, str]],
    config: Path | None,
) -> Any:
    """Return the settings of a command from options and file."""
    file = {} if config is None else load_settings(config)
    left_open = {e for path, _ in texts for e in IMPLY.get(path, ())}
    file, source = _without(file, left_open), str(config or "")
    base = kind
    if kind is GameSettings:
        base = read_game(file, source)
    elif isinstance(kind, GameSettings):
        base = read_game(file, source, base=kind)
        if base.game != kind.game:
            raise click.UsageError(
                f"game must be {kind.game} in {source}, got {base.game}"
            )
    entries = _entries_of(base)
    changes = changes_of(texts, entries)
    given = {*changes, *(["--config"] if config else [])}
    click.get_current_context().meta[GIVEN] = given
    if isinstance(base, GameSettings):
        settings = read_game(nested(changes), base=base)
    else:
        chosen = nested(nested(changes), file)
        settings = settings_of(kind, chosen, source if not changes else "")
    if hasattr(settings, "resolved"):
        settings = settings.resolved()
    _refuse_unused(changes, entries, settings)
    return settings


def _without(
    entries: Mapping[str, Any], paths: Collection[str], section: str = ""
) -> dict[str, Any]:
    """Return the nested entries of a file without those at some paths.

    A path is one of the game, and one of each player that the file lists.
    """
    found = dict[str, Any]()
    for name, value in entries.items():
        if name == "players" and isinstance(value, list):
            own = [_without(x, paths) for x in value if isinstance(x, dict)]
            value = own if len(own) == len(value) else value
        elif isinstance(value, dict):
            value = _without(value, paths, f"{section}{name}.")
        if f"{section}{name}" not in paths:
            found[name] = value
    return found


def _needs(
    path: str, entries: Mapping[str, Entry]
) -> Iterator[tuple[str, str]]:
    """Yield the conditions of a setting and of its sections."""
    parts = path.split(".")
    for number in range(1, len(parts) + 1):
        entry = entries.get(".".join(parts[:number]))
        if entry is not None and entry.described.needs:
            yield entry.described.needs


def _refuse_unused(
    given: Collection[str], entries: Mapping[str, Entry], settings: Any
) -> None:
    """Refuse settings that have no effect with the others."""
    players = getattr(settings, "players", ())
    for own in given:
        first = own.split(".")[0]
        holders = [p for p in players if p.name == first] or players
        for path, needed in _needs(own, entries):
            owners = [
                each
                for each in (settings, *holders)
                if hasattr(each, path.split(".")[0])
            ]
            values = [attrgetter(path)(each) for each in owners]
            met = [
                value == needed if needed else value not in (None, False)
                for value in values
            ]
            if values and not any(met):
                if own not in (path, f"{first}.{path}"):
                    got = f", got {values[-1]}" if needed else ""
                    if ".py:" in got:
                        got += "; a user strategy takes arguments as NAME(...)"
                    raise click.UsageError(
                        f"{own} requires {path} {needed}".rstrip() + got
                    )


def refuse_settings(beginnings: tuple[str, ...], requirement: str) -> None:
    """Refuse settings that have no effect in this call.

    Args:
        beginnings: Beginnings of their paths.
        requirement: What they require, for the message.

    Raises:
        UsageError: If one of them is given.
    """
    given = click.get_current_context().meta[GIVEN]
    for path in sorted(given):
        if path.startswith(beginnings):
            raise click.UsageError(f"{path} requires {requirement}")
