"""What commands write on a terminal."""

import click

from ..report.text_escaping import visible


def echo(text: str = "", *, err: bool = False, nl: bool = True) -> None:
    r"""Write text in which only lines and tabs do anything.

    Names of files and what a run folder says may hold escape sequences, with
    which a terminal would do what they say; they are written out.

    Args:
        text: It may have several lines.
        err: Whether it goes to standard error.
        nl: Whether a line ends with it.
    """
    click.echo(visible(text, but="\n\t"), err=err, nl=nl)
