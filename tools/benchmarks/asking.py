"""What every measuring command asks, and what machine it runs on."""

import os
import platform
from argparse import ArgumentParser, Namespace, RawDescriptionHelpFormatter
from collections.abc import Callable, Iterable
from pathlib import Path
from typing import Any

from stepaside.core.atomic_output import check_file
from stepaside.core.errors import ConfigurationError

RESULTS = Path(__file__).parents[2] / "docs" / "results"


class _Asking(ArgumentParser):
    """Parser that tells where the results go before they are measured."""

    name_of: Callable[[Namespace], str]

    def parse_args(
        self, args: Iterable[str] | None = None, namespace: Any = None
    ) -> Any:
        """Read the command line; exit with a message if it is wrong."""
        given = super().parse_args(args, namespace)
        try:
            given.output = _file_of(given.output, self.name_of(given))
        except ConfigurationError as error:
            self.error(str(error))
        return given


def ask(
    description: str | None, name: str | Callable[[Namespace], str]
) -> ArgumentParser:
    """Parser with the one option that all have.

    What it reads holds ``output``, the file of results: a place that can be
    written, so that nothing is measured in vain.

    Args:
        description: Of the command.
        name: Of the file of results, in the folder of results or in one
            that is given; or what tells it from all that was asked.
    """
    parser = _Asking(
        description=description, formatter_class=RawDescriptionHelpFormatter
    )
    parser.name_of = (lambda _: name) if isinstance(name, str) else name
    parser.add_argument(
        "--output",
        type=Path,
        default=RESULTS,
        help="file of results, or the folder that it goes to",
    )
    return parser


def _file_of(output: Path, name: str) -> Path:
    """File of results that is meant by a file or folder.

    Raises:
        ConfigurationError: If it cannot be written.
    """
    file = output / name if output.is_dir() else output
    check_file(file, suffixes=[".json"], overwrite=True)
    return file


def seeds_of(text: str) -> range:
    """Seeds ``first:end``, the end not among them.

    Raises:
        ValueError: If the text is none.
    """
    first, end = map(int, text.split(":"))
    if not 0 <= first < end:
        raise ValueError(f"seeds must be FIRST:END, got {text!r}")
    return range(first, end)


def machine() -> dict[str, str | int | float | None]:
    """Where times were measured, and how busy it was when they had been."""
    return {
        "python": platform.python_version(),
        "processor": platform.machine(),
        "cores": os.cpu_count(),
        "load": os.getloadavg()[0],
    }
