"""Bodies that the page offers, each with its control."""

from ...games.duel_settings import DuelSettings
from ...locomotion.zmp.control_settings import (
    OPEN_LOOP,
    STABILISED,
    ControlSettings,
)
from ...sim.body_settings import BODIES, BodySettings

OWN = "as started"  # a body that is no preset


def body_choices(
    settings: DuelSettings,
) -> tuple[dict[str, tuple[BodySettings, ControlSettings]], str]:
    """Bodies by name, and the name of the one that a duel has.

    The one that the duel has keeps the control that it was given, too.

    Args:
        settings: Of the duel that the page was started with.
    """
    choices = {
        name: (body, OPEN_LOOP if name == "ideal" else STABILISED)
        for name, body in BODIES.items()
    }
    names = [n for n, body in BODIES.items() if body == settings.body]
    name = (names or [OWN])[0]
    choices[name] = settings.body, settings.control
    return choices, name
