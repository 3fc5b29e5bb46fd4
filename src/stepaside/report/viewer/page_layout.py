"""Layout and theme of a page."""

from typing import Any, NamedTuple

import viser

from ..palette import PALETTES
from .scene_layers import rgb

STATUS_WIDTH = 340.0  # of the panel on the right, in [pixels]
CONTROL_WIDTH = 290.0  # of the panel on the left, in [pixels]
# viser brightens the colour of buttons in the light theme: this one becomes
# the evader's blue, with enough contrast to white text.
BUTTON_COLOURS = {"light": "#143d7b", "dark": PALETTES["light"].evader}


class PageLayout(NamedTuple):
    """Tabs for controls, each to be filled in a ``with`` block.

    Attributes:
        play: Tab with the controls of the running duel.
        settings: Tab with the settings of the next duel.
        layers: Tab with the layers of the scene.
        controls: The panel of these tabs.
    """

    play: Any
    settings: Any
    layers: Any
    controls: Any


def arrange_panels(gui: viser.GuiApi) -> PageLayout:
    """Dock the status to the right of the scene, controls to its left.

    Elements that are added outside of a tab go to the status panel. On a
    phone viser shows both panels below the scene.

    Args:
        gui: Controls of a page.
    """
    gui.set_panel_label("stepaside")
    gui.main_panel.dock_right()
    gui.main_panel.set_width(STATUS_WIDTH)
    controls = gui.add_panel()
    play, settings, layers = (
        controls.add_tab(name) for name in ("Play", "Settings", "Layers")
    )
    controls.dock_left()
    controls.set_width(CONTROL_WIDTH)
    return PageLayout(play, settings, layers, controls)


def set_theme(gui: viser.GuiApi, theme: str) -> None:
    """Set the theme of a page, or of the page of one viewer.

    Args:
        gui: Controls of all viewers or of one.
        theme: One of :data:`~stepaside.report.palette.THEMES`.
    """
    gui.configure_theme(
        dark_mode=theme == "dark",
        show_logo=False,
        show_share_button=False,
        brand_color=rgb(BUTTON_COLOURS[theme]),
    )
