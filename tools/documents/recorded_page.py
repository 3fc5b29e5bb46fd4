"""Write the page of the site that shows a recorded duel in the browser.

``make docs`` runs this::

    python -m tools.documents.recorded_page build/site/recorded.html
"""

import sys
from pathlib import Path

from stepaside.games.game_settings import duel
from stepaside.games.recorded_game import run_game
from stepaside.report.replay_page import write_page

if __name__ == "__main__":
    write_page(run_game(duel(seed=7)), Path(sys.argv[1]))
