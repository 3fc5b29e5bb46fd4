"""Run folders: a duel on disk, whole or not at all."""

import json
import os
import shutil
import tempfile
from pathlib import Path
from typing import Any

import numpy as np

from ..errors import ConfigurationError
from ..games.configuration import dump_configuration
from ..games.duel import DuelResult
from .duel_figure import draw_duel

CONFIGURATION = "configuration.toml"
SUMMARY = "summary.json"
TRAJECTORIES = "trajectories.npz"
FIGURE = "duel.png"
SIGHT = "sight.png"


def check_output(folder: Path) -> None:
    """Refuse a folder that a run cannot be written to.

    Raises:
        ConfigurationError: If it holds something already, or cannot be.
    """
    if folder.is_dir() and not any(folder.iterdir()):
        return
    if folder.exists():
        raise ConfigurationError(
            f"output must be a new or an empty folder, got {folder}"
        )
    parent = folder.absolute().parent
    while not parent.exists():
        parent = parent.parent
    if not parent.is_dir() or not os.access(parent, os.W_OK):
        raise ConfigurationError(
            f"output must lie in a folder that can be written, got {folder}"
        )


def free_folder(parent: Path, name: str) -> Path:
    """Folder in ``parent`` that does not exist yet: name, name-2, ..."""
    folder, number = parent / name, 1
    while folder.exists():
        number += 1
        folder = parent / f"{name}-{number}"
    return folder


def write_run(
    folder: Path, result: DuelResult, summary: dict[str, Any]
) -> Path:
    """Write a duel: configuration, summary, trajectories and figure.

    The folder appears when it is complete.

    Args:
        folder: Where it shall lie.
        result: The duel.
        summary: Its figures.

    Returns:
        Path of the figure.
    """
    folder.parent.mkdir(parents=True, exist_ok=True)
    draft = Path(tempfile.mkdtemp(prefix=".draft-", dir=folder.parent))
    try:
        (draft / CONFIGURATION).write_text(
            dump_configuration(result.settings), encoding="utf-8"
        )
        (draft / SUMMARY).write_text(
            json.dumps(summary, indent=2) + "\n", encoding="utf-8"
        )
        np.savez_compressed(
            draft / TRAJECTORIES, allow_pickle=False, **result.arrays
        )
        draw_duel(result.arrays, summary, result.settings, draft / FIGURE)
        if result.stills:
            from .sight_figure import draw_sight

            draw_sight(result, draft / SIGHT)
        if folder.is_dir():
            folder.rmdir()
        draft.chmod(0o755)
        draft.rename(folder)
    except BaseException:
        shutil.rmtree(draft, ignore_errors=True)
        raise
    return folder / FIGURE
