"""What every measuring command asks, and what machine it runs on."""

import os
import platform
from argparse import ArgumentParser, RawDescriptionHelpFormatter
from pathlib import Path

RESULTS = Path(__file__).parents[1] / "docs" / "results"


def ask(description: str | None, name: str) -> ArgumentParser:
    """Parser with the one option that all have.

    Args:
        description: Of the command.
        name: Of the file of results, by default.
    """
    parser = ArgumentParser(
        description=description, formatter_class=RawDescriptionHelpFormatter
    )
    parser.add_argument("--output", type=Path, default=RESULTS / name)
    return parser


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
