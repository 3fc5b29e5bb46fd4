"""Where things stand on a page: what is watched, what is done, what is set."""

from typing import Any, NamedTuple

import viser

from ..palette import PALETTES
from .scene_layers import rgb

WATCH, ACT = 340.0, 290.0  # widths of the panels, in [pixels]
# viser paints buttons of a light page in a brighter shade than it is given:
# of this one it makes the evader's blue, on which white words are read.
BRAND = {"light": "#143d7b", "dark": PALETTES["light"].evader}


class PageLayout(NamedTuple):
    """Places for controls, each to be filled in a ``with``.

    Attributes:
        play: Tab of what a hand does to the robots.
        settings: Tab of what the next game is.
        shown: Tab of what is drawn.
    """

    play: Any
    settings: Any
    shown: Any


def arrange(gui: viser.GuiApi) -> PageLayout:
    """Dock what is watched to the right of the scene, what acts to its left.

    What is added without a place is watched. On a phone viser makes sheets
    below the scene of both.

    Args:
        gui: Of a page.
    """
    gui.set_panel_label("stepaside")
    gui.main_panel.dock_right()
    gui.main_panel.set_width(WATCH)
    acting = gui.add_panel()
    tabs = [acting.add_tab(name) for name in ("Play", "Settings", "Shown")]
    acting.dock_left()
    acting.set_width(ACT)
    return PageLayout(*tabs)


def dress(gui: viser.GuiApi, light: str) -> None:
    """Let a page, or the page of one viewer, be light or dark.

    Args:
        gui: Of a page or of one viewer.
        light: One of :data:`~stepaside.report.palette.LIGHTS`.
    """
    gui.configure_theme(
        dark_mode=light == "dark",
        show_logo=False,
        show_share_button=False,
        brand_color=rgb(BRAND[light]),
    )
