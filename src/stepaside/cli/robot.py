"""``stepaside robot``: show, describe, check or tune a robot."""

from typing import Any

import click

from .robot_check import check
from .robot_init import init
from .robot_show import show
from .robot_tune import tune


class _ShowByDefault(click.Group):
    """Command group whose default command is ``show``."""

    def parse_args(self, ctx: click.Context, args: list[str]) -> list[str]:
        """Insert ``show`` unless the first argument is a command."""
        names = (*self.commands, *self.get_help_option_names(ctx))
        if not args or args[0] not in names:
            args = ["show", *args]
        return super().parse_args(ctx, args)


@click.group("robot", cls=_ShowByDefault)
def robot(**_: Any) -> None:
    """Show a robot, or describe a new one from its published model.

    `stepaside robot NAME` is short for `stepaside robot show NAME`. NAME is
    a built-in robot (nao) or a folder with a robot.toml and a model.
    """


for command in (show, init, check, tune):
    robot.add_command(command)
