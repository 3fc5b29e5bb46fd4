"""Output of commands to a terminal, safe against escape sequences."""

import click

from ..report.text_escaping import visible


def echo(text: str = "", *, err: bool = False, nl: bool = True) -> None:
    r"""Print text with all control characters but ``\n`` and ``\t`` escaped.

    File names and entries of run folders may contain escape sequences that
    a terminal would execute.

    Args:
        text: One or more lines.
        err: Whether to print to standard error.
        nl: Whether to end with a newline.
    """
    click.echo(visible(text, but="\n\t"), err=err, nl=nl)
