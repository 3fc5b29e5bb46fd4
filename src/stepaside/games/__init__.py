"""Games in physics: players, the one loop, and the run that it leaves."""

from typing import TYPE_CHECKING

from ..doors import door

if TYPE_CHECKING:
    from .duel import Duel, run_duel
    from .outcome import Outcome
    from .run import Run
    from .settings import DuelSettings
else:
    __getattr__ = door(
        __name__,
        {
            "Duel": "duel",
            "DuelSettings": "settings",
            "Outcome": "outcome",
            "Run": "run",
            "run_duel": "duel",
        },
    )

__all__ = ["Duel", "DuelSettings", "Outcome", "Run", "run_duel"]
