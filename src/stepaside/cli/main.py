"""The command line: words in, tables and files out."""

import sys
from concurrent.futures import BrokenExecutor
from importlib import import_module
from typing import Any, NoReturn

import click

from .. import __version__
from ..core.errors import StepAsideError, shortened
from ..core.extras import remedy
from ..core.interrupts import interruptible

INTERRUPTED = 130  # exit status
COMMANDS = {
    "duel": "Let two humanoids chase each other in physics.",
    "duels": "Play many duels, on all cores, and say what came out.",
    "view": "Watch a duel in a browser, push the robots, drive one.",
    "replay": "See a run again: page, offline page, film.",
    "compare": "Draw several runs on one figure.",
    "walk": "Let one humanoid walk, push it, and measure.",
    "robustness": "Walk under disturbances, on all cores, and tabulate.",
    "plan": "Plan one maneuver: footsteps, ZMP and CoM.",
    "unicycles": "Play one game of two unicycles (Sec. II).",
    "circle": "Find all circles of a game, and which starts end on which.",
    "map": "Map games over their starts: closest approach, worst start.",
    "bound": "Compute the best that any evader can do.",
    "tournament": "Let evaders play pursuers, in rooms by seed.",
    "room": "Make a room by seed: walls, doors, discs, boxes, polygons.",
    "play": "Drive a robot over LoLA, NAOqi or ROS 2.",
    "serve": "Offer simulated robots over LoLA, NAOqi or ROS 2.",
    "reproduce": "Measure every claim of the paper and write a page.",
    "robot": "Show a robot, or write its model.",
}


class LazyGroup(click.Group):
    """A group that imports a command when it is called."""

    def list_commands(self, ctx: click.Context) -> list[str]:
        """List the commands."""
        return list(COMMANDS)

    def get_command(
        self, ctx: click.Context, cmd_name: str
    ) -> click.Command | None:
        """Import a command."""
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
        """Turn every refusal into one line and exit status 2."""
        extra["standalone_mode"] = False
        try:
            with interruptible():
                status = super().main(*args, **extra)
        except click.ClickException as error:
            _refuse(error.format_message())
        except StepAsideError as error:
            _refuse(str(error))
        except ModuleNotFoundError as error:
            _refuse(remedy(error))
        except BrokenExecutor:
            _refuse(
                "a worker was killed, perhaps for memory; what is done is kept"
            )
        except OSError as error:
            place = f"{error.filename}: " if error.filename else ""
            _refuse(f"{place}{(error.strerror or str(error)).lower()}")
        except (click.Abort, KeyboardInterrupt):
            _leave()
        sys.exit(status if isinstance(status, int) else 0)


def all_commands() -> dict[str, click.Command]:
    """Every command by the words that call it, like ``duel``.

    Of a group whose commands have names of their own, each is there, and the
    group itself if it does something alone.
    """
    found: dict[str, click.Command] = {}
    waiting: list[tuple[str, click.Group]] = [("", main)]
    while waiting:
        before, group = waiting.pop(0)
        context = click.Context(group)
        for name in group.list_commands(context):
            command = group.get_command(context, name)
            assert command is not None
            words = f"{before} {name}".strip()
            alone = True
            if isinstance(command, click.Group):
                waiting.append((words, command))
                alone = command.invoke_without_command
            if alone:
                found[words] = command
    return found


def _leave() -> NoReturn:
    said = "stepaside: interrupted; what is not whole is not kept"
    click.echo(said, err=True)
    sys.exit(INTERRUPTED)


def _refuse(message: str) -> NoReturn:
    from .terminal import echo

    said = shortened(" ".join(message.split()))
    echo(f"stepaside: {said}", err=True)
    sys.exit(2)


@click.group(cls=LazyGroup, invoke_without_command=True)
@click.version_option(__version__)
@click.pass_context
def main(context: click.Context) -> None:
    """Real-time pursuit and evasion for humanoid robots."""
    if context.invoked_subcommand is None:
        click.echo(context.get_help())
