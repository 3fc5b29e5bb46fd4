"""Panel with the players of a game and the settings of the next one."""

from collections.abc import Callable
from dataclasses import replace

import viser

from ...core.errors import StepAsideError
from ...games.game_settings import GameSettings
from ..text_escaping import for_markdown
from .live_session import LiveSession


def players_table(settings: GameSettings) -> str:
    """Return the players of a game as a table in Markdown."""
    rows = ["| player | role | body | strategy |", "|--|--|--|--|"]
    for own in settings.resolved().named().players:
        strategy = str(own.strategy) if own.decides else ""
        cells = own.name, own.role, own.body, for_markdown(strategy)
        rows.append(f"| {' | '.join(cells)} |")
    return "\n".join(rows)


class GamePanel:
    """Players of a game file, and the seed of the next game."""

    def __init__(
        self,
        gui: viser.GuiApi,
        session: LiveSession,
        notify: Callable[[str], None],
    ) -> None:
        """Add the controls to a page.

        Args:
            gui: Controls of the page.
            session: Session of a game file.
            notify: Function that shows a message.
        """
        self._session, self._notify = session, notify
        assert isinstance(session.settings, GameSettings)
        with gui.add_folder("Next game (from the next reset)"):
            self._seed = gui.add_number("Seed", session.settings.seed, step=1)
        gui.add_markdown(players_table(session.settings))

    def restart(self) -> bool:
        """Start a game with the seed of the control.

        Returns:
            Whether the settings were valid.
        """
        session = self._session
        try:
            seed = int(self._seed.value)
            session.reset(replace(session.settings, seed=seed))
        except (StepAsideError, ArithmeticError, ValueError) as error:
            self._notify(str(error))
            return False
        self._notify("")
        return True
