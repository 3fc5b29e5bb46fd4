"""``stepaside robot``: show a robot, and fit a stranger's."""

from typing import Any

import click

from .robot_check import check
from .robot_init import init
from .robot_show import show
from .robot_tune import tune


class _ShowsByDefault(click.Group):
    """A group whose first word may be left out: then it shows a robot."""

    def parse_args(self, ctx: click.Context, args: list[str]) -> list[str]:
        """Take a first word that is no command for the name of a robot."""
        names = (*self.commands, *self.get_help_option_names(ctx))
        if not args or args[0] not in names:
            args = ["show", *args]
        return super().parse_args(ctx, args)


@click.group("robot", cls=_ShowsByDefault)
def robot(**_: Any) -> None:
    """Show a robot, or fit one from its published model.

    ``stepaside robot NAME`` shows the robot NAME: one that comes with the
    package (nao), or a folder with a robot.toml and a model.
    """


for command in (show, init, check, tune):
    robot.add_command(command)
