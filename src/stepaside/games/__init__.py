"""Games in physics: players, the one loop, and the run that it leaves."""

from typing import TYPE_CHECKING

from ..doors import door

if TYPE_CHECKING:
    from .duel import Duel, run_duel
    from .duel_run import DuelRun
    from .outcome import Outcome
    from .run import Run
    from .settings import DuelSettings
    from .walk_run import WalkRun
else:
    __getattr__ = door(
        __name__,
        {
            "Duel": "duel",
            "DuelRun": "duel_run",
            "DuelSettings": "settings",
            "Outcome": "outcome",
            "Run": "run",
            "WalkRun": "walk_run",
            "run_duel": "duel",
        },
    )

__all__ = [
    "Duel",
    "DuelRun",
    "DuelSettings",
    "Outcome",
    "Run",
    "WalkRun",
    "run_duel",
]
