"""Large caption of a page that is shown to an audience."""

from collections.abc import Mapping
from html import escape
from math import isfinite

import viser

from .live_session import LiveSnapshot

WIDTH, HEIGHT, GAP = 640.0, 225.0, 24.0  # of the panel, in [pixels]
ROUND = 75.0  # after which the next duel begins, in [s] of simulated time


class DemoCaption:
    """Panel in the upper left corner with distance and phases in large text.

    All other panels are minimised.
    """

    def __init__(self, gui: viser.GuiApi, colours: Mapping[str, str]) -> None:
        """Add the panel to a page.

        Args:
            gui: Controls of the page.
            colours: Colour of each player, by name.
        """
        self._colours = colours
        panel = gui.add_panel()
        panel.float(x=GAP, y=GAP, width=WIDTH, height=HEIGHT)
        with panel.add_tab("stepaside"):
            self._text = gui.add_html("")
        gui.main_panel.minimize()

    def show(self, snapshot: LiveSnapshot, outlook: str) -> None:
        """Show the state of a game.

        Args:
            snapshot: The state.
            outlook: What is expected next, in one line.
        """
        line = escape(outlook.replace("**", ""))
        angle = ""
        if isfinite(snapshot.angle):
            angle = f"angle <b>{snapshot.angle:.0f}&deg;</b>, "
        players = ", ".join(
            f'<b style="color:{self._colours[player.name]}">'
            f"{escape(player.name)}</b> {phase.value}"
            for player, phase in zip(
                snapshot.players, snapshot.phases, strict=True
            )
        )
        self._text.content = (
            '<div style="font-size:26px;line-height:1.35;padding:8px">'
            f"{players}<br>"
            f"distance <b>{snapshot.distance:.2f} m</b>, {angle}"
            f"{snapshot.time:.0f} s<br>"
            f'<span style="font-size:20px">{line}</span></div>'
        )


def is_over(snapshot: LiveSnapshot, *, ended: bool) -> bool:
    """Return whether the next duel of a demonstration should begin.

    Args:
        snapshot: State of the present duel.
        ended: Whether it has ended.
    """
    return ended or snapshot.time > ROUND
