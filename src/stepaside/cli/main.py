"""Command-line interface: the group of all commands and its errors."""

import re
import sys
from importlib import import_module
from typing import Any, NoReturn

import click

from .. import __version__
from ..core.errors import StepAsideError
from ..core.extras import install_hint
from ..core.signal_handling import interrupted_status, interruptible

COMMANDS = {
    "duel": "Simulate a duel of two humanoids in physics.",
    "game": "Play a game of any number of players, from a file.",
    "study": "Play any grid of settings, or a preset: tournament, people.",
    "merge": "Join the files of the shards of a study.",
    "view": "Watch a duel in the browser; push or drive the robots.",
    "show": "Show runs: page, film, figure, tables, MCAP, URDF.",
    "walk": "Simulate the walk of one humanoid and measure it.",
    "plan": "Plan one maneuver: footsteps, ZMP and CoM.",
    "unicycles": "Simulate one game of two unicycles (Sec. II).",
    "circle": "Find all circles of a game and their basins of attraction.",
    "map": "Map the closest approach over initial poses; find the worst.",
    "bound": "Compute the best closest approach any evader can achieve.",
    "room": "Generate a random room, or inspect a room file.",
    "play": "Control a robot over LoLA, NAOqi or ROS 2.",
    "serve": "Serve simulated robots over LoLA or ROS 2.",
    "reproduce": "Measure every claim of the paper and write a report.",
    "robot": "Show, describe, check or tune a robot.",
    "legs": "Inspect or measure a learned walking policy.",
    "doctor": "Report what is installed, what is missing, and how to get it.",
}


class LazyGroup(click.Group):
    """Command group that imports each command on first use."""

    def list_commands(self, ctx: click.Context) -> list[str]:
        """Return the names of all commands."""
        return list(COMMANDS)

    def get_command(
        self, ctx: click.Context, cmd_name: str
    ) -> click.Command | None:
        """Import and return one command, or None if it does not exist."""
        if cmd_name not in COMMANDS:
            return None
        module = import_module(f"stepaside.cli.{cmd_name}")
        command: click.Command = getattr(module, cmd_name)
        return command

    def format_commands(
        self, ctx: click.Context, formatter: click.HelpFormatter
    ) -> None:
        """Write the list of commands without importing any."""
        with formatter.section("Commands"):
            formatter.write_dl(list(COMMANDS.items()))

    def main(self, *args: Any, **extra: Any) -> NoReturn:
        """Run a command; report each expected error in one line, status 2."""
        extra["standalone_mode"] = False
        try:
            with interruptible():
                status = super().main(*args, **extra)
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
            _leave()
        sys.exit(status if isinstance(status, int) else 0)


def all_commands() -> dict[str, click.Command]:
    """Return every command by its full name, like ``robot check``.

    A group appears itself only if it can be invoked without a subcommand.
    """
    commands: dict[str, click.Command] = {}
    queue: list[tuple[str, click.Group]] = [("", main)]
    while queue:
        prefix, group = queue.pop(0)
        context = click.Context(group)
        for name in group.list_commands(context):
            command = group.get_command(context, name)
            assert command is not None
            full_name = f"{prefix} {name}".strip()
            if isinstance(command, click.Group):
                queue.append((full_name, command))
                if not command.invoke_without_command:
                    continue
            commands[full_name] = command
    return commands


def _errors_of_executors() -> type[Exception]:
    """Return the error of a lost worker; its module is imported late."""
    from concurrent.futures import BrokenExecutor

    return BrokenExecutor


def _leave() -> NoReturn:
    click.echo("stepaside: interrupted; partial output discarded", err=True)
    sys.exit(interrupted_status())


def _refuse(message: str) -> NoReturn:
    from .terminal import echo

    line = re.sub(r"(\S{60})\S{181,}", r"\1...", " ".join(message.split()))
    echo(f"stepaside: {line}", err=True)
    sys.exit(2)


@click.group(cls=LazyGroup, invoke_without_command=True)
@click.version_option(__version__)
@click.pass_context
def main(context: click.Context) -> None:
    """Real-time pursuit and evasion for humanoid robots."""
    if context.invoked_subcommand is None:
        click.echo(context.get_help())
