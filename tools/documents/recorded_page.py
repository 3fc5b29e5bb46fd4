"""Write the page of the site that shows a recorded duel in the browser.

``make docs`` runs this::

    python -m tools.documents.recorded_page build/site/recorded.html
"""

import sys
from pathlib import Path

from stepaside.games.duel_settings import DuelSettings
from stepaside.games.recorded_game import run_duel
from stepaside.report.replay_page import write_page

if __name__ == "__main__":
    write_page(run_duel(DuelSettings(seed=7)), Path(sys.argv[1]))
