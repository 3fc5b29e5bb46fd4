"""List of all commands."""

import click

from .main import main


def all_commands() -> dict[str, click.Command]:
    """Return every command by its full name, like ``robot check``."""
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
            else:
                commands[full_name] = command
    return commands
