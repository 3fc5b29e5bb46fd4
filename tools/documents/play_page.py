"""Write the page of the site on which robots play in the browser.

``make docs`` runs this::

    python -m tools.documents.play_page build/site/play

Without npm, which fetches MuJoCo's WebAssembly build, the page shows a
recorded duel instead.
"""

import shutil
from argparse import ArgumentParser
from pathlib import Path

from stepaside.core.errors import ConfigurationError
from stepaside.games.duel import run_duel
from stepaside.games.duel_settings import DuelSettings
from stepaside.report.game_page import write_game_page
from stepaside.report.replay_page import write_page

SETTINGS = DuelSettings(seed=7, duration=60.0)


def write(folder: Path, engine: Path | None = None) -> str:
    """Write the page into a folder.

    Args:
        folder: Folder of the page; replaced if it exists.
        engine: Package of MuJoCo's WebAssembly build; None to fetch it.

    Returns:
        Message that says what was written.
    """
    shutil.rmtree(folder, ignore_errors=True)
    try:
        write_game_page(SETTINGS, folder, engine)
    except ConfigurationError as error:
        folder.mkdir(parents=True)
        write_page(run_duel(SETTINGS), folder / "index.html")
        return f"{folder} shows a recorded duel: {error}"
    return f"{folder} plays in the browser"


def main() -> None:
    """Write the page."""
    parser = ArgumentParser(
        prog="python -m tools.documents.play_page", description=__doc__
    )
    parser.add_argument("folder", type=Path)
    parser.add_argument("--engine", type=Path)
    given = parser.parse_args()
    print(write(given.folder, given.engine))


if __name__ == "__main__":
    main()
