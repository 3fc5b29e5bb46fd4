"""A button that pushes a robot."""

from collections.abc import Callable
from math import radians

import viser

from ...errors import StepAsideError
from .session import Session

DIRECTIONS = {"left": 90, "right": -90, "forward": 0, "backward": 180}
ROBOTS = ("pursuer", "evader")


def add_push(
    gui: viser.GuiApi, session: Session, say: Callable[[str], None]
) -> None:
    """Add the controls to a page.

    Args:
        gui: Of the page.
        session: Whose robots are pushed.
        say: Shows a message.
    """
    with gui.add_folder("Push"):
        who = gui.add_dropdown("Robot", ROBOTS)
        strength = gui.add_number("Impulse [N s]", 0.5, step=0.1)
        direction = gui.add_dropdown("To", tuple(DIRECTIONS))
        push = gui.add_button("Push")

    @push.on_click
    def _(_: object) -> None:
        angle = radians(DIRECTIONS[direction.value])
        try:
            session.push(ROBOTS.index(who.value), float(strength.value), angle)
        except StepAsideError as error:
            say(str(error))
        else:
            say(
                f"pushed the {who.value} {direction.value} by "
                f"{strength.value:g} N s"
            )
