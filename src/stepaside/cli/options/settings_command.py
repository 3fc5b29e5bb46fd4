"""Commands with settings from options, a configuration file, or both.

In order of increasing priority: defaults, the file of ``--config``, presets
such as ``--body``, single options.
"""

from collections.abc import Callable, Collection, Mapping
from functools import wraps
from pathlib import Path
from typing import Any

import click
from click.core import ParameterSource

from ..value_types import write_result
from .body_options import METHOD
from .declaration import (
    DeclaredOption,
    OptionDeclaration,
    OptionGroup,
    SettingsClass,
)
from .game_options import SENSING
from .room_options import with_room
from .settings_builder import (
    changed,
    with_control,
    with_sensing,
    with_trigger,
)

CONFIG = OptionDeclaration(
    "--config",
    "Configuration file (TOML); options override it.",
    kind=click.Path(exists=True, dir_okay=False, path_type=Path),
)
PRINT_CONFIG = OptionDeclaration(
    "--print-config/--no-print-config",
    "Print the resulting configuration with comments, and exit.",
)
CONFIGURATION = OptionGroup("Configuration", (CONFIG, PRINT_CONFIG))


class SettingsCommand(click.Command):
    """Command whose help shows options in sections."""

    def format_options(
        self, ctx: click.Context, formatter: click.HelpFormatter
    ) -> None:
        """Write the command's own options first, then each group."""
        titles: dict[OptionDeclaration, str] = {
            option: group.title
            for group in getattr(self.callback, "groups", ())
            for option in group.options
        }
        sections: dict[str, list[tuple[str, str]]] = {}
        for param in self.get_params(ctx):
            record = param.get_help_record(ctx)
            if record is not None:
                title = "Options"
                if isinstance(param, DeclaredOption):
                    title = titles.get(param.declaration, title)
                sections.setdefault(title, []).append(record)
        for title in ("Options", *dict.fromkeys(titles.values())):
            if title in sections:
                with formatter.section(title):
                    formatter.write_dl(sections[title])


def takes_settings(
    settings_class: SettingsClass,
    *groups: OptionGroup,
    ignored: Callable[[], Collection[str]] = tuple,
    help_texts: Mapping[OptionDeclaration, str] | None = None,
) -> Callable[[Callable[..., Any]], Callable[..., Any]]:
    """Add options and ``--config`` to a command; pass it ``settings``.

    Args:
        settings_class: Returns the class of the settings.
        groups: Options that set entries of the settings.
        ignored: Returns top-level entries of a file that belong to other
            commands.
        help_texts: Help of options whose meaning differs in this command.

    Returns:
        Decorator of a command with an argument ``settings``.
    """
    groups = (*groups, CONFIGURATION)

    def decorate(function: Callable[..., Any]) -> Callable[..., Any]:
        @wraps(function)
        def command(**values: Any) -> Any:
            settings = _settings(settings_class, values, ignored)
            if values.pop("print_config"):
                from .print_config import commented

                write_result(commented(settings))
                return None
            return function(settings=settings, **values)

        wrapped: Callable[..., Any] = command
        for group in reversed(groups):
            for declaration in reversed(group.options):
                text = (help_texts or {}).get(declaration, declaration.help)
                wrapped = declaration.option(settings_class, help=text)(
                    wrapped
                )
        wrapped.groups = groups  # type: ignore[attr-defined]
        return wrapped

    return decorate


def _base_settings(
    settings_class: SettingsClass,
    given: dict[str, Any],
    config: Path | None,
    ignored: Callable[[], Collection[str]],
) -> tuple[Any, bool]:
    """Return the settings of the chosen robots, changed by the file.

    Args:
        settings_class: Returns the class of the settings.
        given: Options by path; those that choose a player's robot are
            removed.
        config: Configuration file; None if there is none.
        ignored: Returns entries of the file that belong to other commands.

    Returns:
        The settings, and whether the robot needs feedback.
    """
    base, entries = settings_class()(), {}
    if config is not None:
        from ...games.configuration_file import load_entries, parse_settings

        entries = load_entries(config)
    if hasattr(base, "robot"):
        from ...games.robot_settings import with_players, with_robot

        robot = given.get("robot", entries.get("robot", base.robot))
        base = with_robot(base, str(robot))
        players = {}
        for player in ("pursuer", "evader"):
            path = f"{player}_robot"
            if path in given:
                entries.pop(path, None)
                players[player] = given.pop(path)
            elif isinstance(entries.get(path), dict):
                players[player] = str(entries[path].get("robot", robot))
        base = with_players(base, players) if players else base
        entries.pop("robot", None)
    needed = hasattr(base, "control") and base.control.feedback
    if config is not None:
        source = str(config)
        base = parse_settings(
            settings_class(), entries, source, aside=ignored(), base=base
        )
    return base, needed


def _in_file(config: Path | None, path: str) -> bool:
    """Return whether the configuration file sets an entry."""
    if config is None:
        return False
    from ...games.configuration_file import has_entry

    return has_entry(config, path)


def _settings(
    settings_class: SettingsClass,
    values: dict[str, Any],
    ignored: Callable[[], Collection[str]],
) -> Any:
    """Remove the options of settings from a command's values; build them."""
    context = click.get_current_context()
    given: dict[str, Any] = {}
    declarations: dict[str, OptionDeclaration] = {}
    for param in context.command.params:
        if not isinstance(param, DeclaredOption) or param.name is None:
            continue
        declaration = param.declaration
        if not param.sets_settings:
            continue
        value = values.pop(param.name)
        source = context.get_parameter_source(param.name)
        if source is not ParameterSource.DEFAULT:
            given[declaration.path] = value
            declarations[declaration.path] = declaration
    config = values.pop("config")
    settings, needed = _base_settings(settings_class, given, config, ignored)
    if hasattr(settings, "control"):
        given = with_control(
            given,
            settings.control,
            needed=needed,
            method_in_file=_in_file(config, METHOD.path),
        )
    if hasattr(settings, "pursuer"):
        given = with_trigger(given, settings.pursuer)
    if hasattr(settings, "sensing"):
        given = with_sensing(
            given,
            room_in_file=settings.room.plan is not None,
            sensing_in_file=_in_file(config, SENSING.path),
        )
    for path in given.keys() & declarations.keys():
        given[path] = declarations[path].value_of(given[path])
    settings = changed(settings, with_room(given))
    if not getattr(settings, "uses_evasion", True):
        _refuse_unused(declarations, settings.named().evader_strategy)
    return settings


def _refuse_unused(
    declarations: Mapping[str, OptionDeclaration], strategy: str
) -> None:
    """Refuse options of the paper's evader if no player uses it."""
    from ...strategies.registry import OF_EVASION

    unused = [
        declaration.name.partition("/")[0]
        for path, declaration in declarations.items()
        if path.startswith("strategy.")
    ]
    if unused:
        raise click.UsageError(
            f"{', '.join(unused)} requires the strategy "
            f"{' or '.join(OF_EVASION)}, got --strategy {strategy}"
        )
