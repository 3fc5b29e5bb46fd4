"""Command-line interface: the group of all commands and its errors."""

import re
import sys
from collections.abc import Mapping
from importlib import import_module
from pathlib import Path
from typing import Any, NoReturn

import click

from .. import __version__
from ..core.errors import StepAsideError, check_choice, nearest_hint
from ..core.extras import install_hint
from ..core.signal_handling import interrupted_status, interruptible

COMMANDS = {
    "duel": "Simulate a duel of two humanoids in physics.",
    "run": "Run a game file, a walk, unicycles, or a random room.",
    "study": "Play any grid of settings, or a preset: tournament, people.",
    "view": "Watch a game in the browser; push or drive the robots.",
    "show": "Show runs: page, film, figure, tables, MCAP, URDF.",
    "theory": "Compute circles, maps, bounds and plans.",
    "reproduce": "Measure every claim of the paper and write a report.",
    "play": "Control a robot over LoLA, NAOqi, ROS 2 or its own SDK.",
    "serve": "Serve simulated robots over ROS 2.",
    "robot": "Show, describe, check or tune a robot and its legs.",
    "doctor": "Report what is installed, what is missing, and how to get it.",
}


class LazyGroup(click.Group):
    """Command group that imports each command on first use."""

    def __init__(
        self,
        *args: Any,
        lazy: Mapping[str, str],
        module: str = "",
        modules: Mapping[str, str] | None = None,
        default: str = "",
        **values: Any,
    ) -> None:
        """List the commands.

        Args:
            args: As for :class:`click.Group`.
            lazy: Short help of each command by name.
            module: Module of the commands; one each of their names if empty.
            modules: Other modules of some commands.
            default: Command for words that are no command; none if empty.
            values: As for :class:`click.Group`.
        """
        super().__init__(*args, **values)
        self._lazy, self._default = lazy, default
        self._modules = {name: module or name for name in lazy}
        self._modules |= modules or {}

    def parse_args(self, ctx: click.Context, args: list[str]) -> list[str]:
        """Insert the default command if none is named; help, if nothing."""
        if not args and not ctx.resilient_parsing:
            click.echo(ctx.get_help())
            ctx.exit()
        names = (*self._lazy, *self.get_help_option_names(ctx))
        if self._default and args and args[0] not in names:
            hint = nearest_hint(args[0], self._lazy)
            if hint and not Path(args[0]).exists():
                ctx.fail(f"no command or file {args[0]!r}{hint}")
            args = [self._default, *args]
        return super().parse_args(ctx, args)

    def list_commands(self, ctx: click.Context) -> list[str]:
        """Return the names of all commands."""
        return list(self._lazy)

    def get_command(
        self, ctx: click.Context, cmd_name: str
    ) -> click.Command | None:
        """Import and return one command, or None if it does not exist."""
        if cmd_name not in self._lazy:
            check_choice(cmd_name, self._lazy, "the command")
        module = import_module(f"stepaside.cli.{self._modules[cmd_name]}")
        command: click.Command = getattr(module, cmd_name)
        return command

    def format_commands(
        self, ctx: click.Context, formatter: click.HelpFormatter
    ) -> None:
        """Write the list of commands without importing any."""
        with formatter.section("Commands"):
            formatter.write_dl(list(self._lazy.items()))

    def main(self, *args: Any, **extra: Any) -> NoReturn:
        """Run a command; report each expected error in one line, status 2."""
        extra["standalone_mode"] = False
        with interruptible():  # it knows the signal until it ends
            try:
                status = super().main(*args, **extra)
            except click.NoSuchOption as error:
                from .options import tell_no_option

                _refuse(tell_no_option(error))
            except click.ClickException as error:
                _refuse(error.format_message())
            except StepAsideError as error:
                _refuse(str(error))
            except ModuleNotFoundError as error:
                _refuse(install_hint(error))
            except _errors_of_executors():
                _refuse(
                    "a worker process was killed, possibly out of memory; "
                    "finished results are saved"
                )
            except OSError as error:
                file = f"{error.filename}: " if error.filename else ""
                _refuse(f"{file}{(error.strerror or str(error)).lower()}")
            except (click.Abort, KeyboardInterrupt):
                click.echo(
                    "stepaside: interrupted; half-written files are "
                    "discarded, finished ones and records stay",
                    err=True,
                )
                sys.exit(interrupted_status())
        sys.exit(status if isinstance(status, int) else 0)


def _errors_of_executors() -> type[Exception]:
    """Return the error of a lost worker; its module is imported late."""
    from concurrent.futures import BrokenExecutor

    return BrokenExecutor


def _refuse(message: str) -> NoReturn:
    from .terminal import echo

    line = re.sub(r"(\S{60})\S{181,}", r"\1...", " ".join(message.split()))
    echo(f"stepaside: {line}", err=True)
    sys.exit(2)


@click.group(cls=LazyGroup, lazy=COMMANDS)
@click.version_option(__version__)
def main() -> None:
    """Real-time pursuit and evasion for humanoid robots."""
