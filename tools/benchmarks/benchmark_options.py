"""Common arguments of the benchmark commands, and the machine they run on."""

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
    """Parser that checks the output file before anything is measured."""

    name_of: Callable[[Namespace], str]

    def parse_args(
        self, args: Iterable[str] | None = None, namespace: Any = None
    ) -> Any:
        """Parse the command line; exit with a message if it is invalid."""
        given = super().parse_args(args, namespace)
        try:
            given.output = _file_of(given.output, self.name_of(given))
        except ConfigurationError as error:
            self.error(str(error))
        return given


def ask(
    description: str | None, name: str | Callable[[Namespace], str]
) -> ArgumentParser:
    """Return a parser with the option that all benchmarks share.

    The parsed arguments have ``output``, the file of results. It is checked to
    be writable before anything is measured.

    Args:
        description: Description of the command.
        name: Name of the file of results within the folder of results, or a
            function that derives it from the arguments.
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
    """Return the file of results for a file or a folder.

    Raises:
        ConfigurationError: If it cannot be written.
    """
    file = output / name if output.is_dir() else output
    check_file(file, suffixes=[".json"], overwrite=True)
    return file


def seeds_of(text: str) -> range:
    """Parse a range of seeds ``first:end``; the end is excluded.

    Raises:
        ValueError: If the text is not a range.
    """
    first, end = map(int, text.split(":"))
    if not 0 <= first < end:
        raise ValueError(f"seeds must be FIRST:END, got {text!r}")
    return range(first, end)


def machine() -> dict[str, str | int | float | None]:
    """Return a description of the machine and its load."""
    return {
        "python": platform.python_version(),
        "processor": platform.machine(),
        "cores": os.cpu_count(),
        "load": os.getloadavg()[0],
    }
