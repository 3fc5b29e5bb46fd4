"""Commands that take settings: groups of options, a file, or both.

What a command gets is its defaults, changed by the file of ``--config``,
changed by presets such as ``--body``, changed by single options.
"""

from collections.abc import Callable, Collection, Mapping
from functools import wraps
from pathlib import Path
from typing import Any

import click
from click.core import ParameterSource

from ..value_types import answer
from .body_options import METHOD
from .declaration import DeclaredOption, Kind, OptionDeclaration, OptionGroup
from .game_options import SENSING
from .room_options import with_room
from .settings_builder import changed, with_control, with_senses, with_trigger

CONFIG = OptionDeclaration(
    "--config",
    "Configuration file (TOML); options given beside it win.",
    kind=click.Path(exists=True, dir_okay=False, path_type=Path),
)
PRINT_CONFIG = OptionDeclaration(
    "--print-config/--no-print-config",
    "Print the configuration that would be used, with what each entry means, "
    "and do nothing else.",
)
CONFIGURATION = OptionGroup("Configuration", (CONFIG, PRINT_CONFIG))


class SettingsCommand(click.Command):
    """A command whose help shows its options by group."""

    def format_options(
        self, ctx: click.Context, formatter: click.HelpFormatter
    ) -> None:
        """Write those of the command first, then each group."""
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
    kind: Kind,
    *groups: OptionGroup,
    aside: Callable[[], Collection[str]] = tuple,
    meanings: Mapping[OptionDeclaration, str] | None = None,
) -> Callable[[Callable[..., Any]], Callable[..., Any]]:
    """Give a command groups of options, ``--config`` and its ``settings``.

    Args:
        kind: Gives the class of the settings.
        groups: Of options that change them.
        aside: Gives entries of a file that belong to other commands.
        meanings: Help of options that mean something else here.

    Returns:
        Decorator of a command with an argument ``settings``.
    """
    groups = (*groups, CONFIGURATION)

    def decorate(function: Callable[..., Any]) -> Callable[..., Any]:
        @wraps(function)
        def command(**values: Any) -> Any:
            settings = _settings(kind, values, aside)
            if values.pop("print_config"):
                from .print_config import commented

                answer(commented(settings))
                return None
            return function(settings=settings, **values)

        taken: Callable[..., Any] = command
        for group in reversed(groups):
            for declaration in reversed(group.options):
                told = (meanings or {}).get(declaration, declaration.help)
                taken = declaration.option(kind, help=told)(taken)
        taken.groups = groups  # type: ignore[attr-defined]
        return taken

    return decorate


def _begin(
    kind: Kind,
    given: dict[str, Any],
    config: Path | None,
    aside: Callable[[], Collection[str]],
) -> tuple[Any, bool]:
    """Settings of the robot that is meant, changed by the file.

    Args:
        kind: Gives the class of the settings.
        given: Options by path; those that name a player's robot are taken.
        config: File, if there is one.
        aside: Gives entries of it that belong to other commands.

    Returns:
        The settings, and whether the robot needs feedback.
    """
    base, entries = kind()(), {}
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
            kind(), entries, source, aside=aside(), base=base
        )
    return base, needed


def _says(config: Path | None, path: str) -> bool:
    """Whether a file of settings, if there is one, says an entry."""
    if config is None:
        return False
    from ...games.configuration_file import says

    return says(config, path)


def _settings(
    kind: Kind, values: dict[str, Any], aside: Callable[[], Collection[str]]
) -> Any:
    """Take the options of settings out of a command's values, and build."""
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
    settings, needed = _begin(kind, given, config, aside)
    if hasattr(settings, "control"):
        told = _says(config, METHOD.path)
        control = settings.control
        given = with_control(given, control, needed=needed, told_method=told)
    if hasattr(settings, "pursuer"):
        given = with_trigger(given, settings.pursuer)
    if hasattr(settings, "sensing"):
        given = with_senses(
            given,
            in_room=settings.room.plan is not None,
            told=_says(config, SENSING.path),
        )
    for path in given.keys() & declarations.keys():
        given[path] = declarations[path].value_of(given[path])
    settings = changed(settings, with_room(given))
    if not getattr(settings, "uses_evasion", True):
        _refuse_unused(declarations, settings.named().evader_strategy)
    return settings


def _refuse_unused(
    declarations: Mapping[str, OptionDeclaration], played: str
) -> None:
    """Refuse options of the paper's evader where no player plays it."""
    from ...strategies.registry import OF_EVASION

    unused = [
        declaration.name.partition("/")[0]
        for path, declaration in declarations.items()
        if path.startswith("strategy.")
    ]
    if unused:
        raise click.UsageError(
            f"{', '.join(unused)} must be left out beside a strategy other "
            f"than {' and '.join(OF_EVASION)}, which alone use it, got "
            f"--strategy {played}"
        )
