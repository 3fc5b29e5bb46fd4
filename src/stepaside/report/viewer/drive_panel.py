"""Panels for pushes and for teleoperation of a robot."""

from collections.abc import Callable
from dataclasses import replace
from math import radians
from typing import Any

import viser

from ...core.errors import StepAsideError
from ...games.player_settings import PLAYERS, PURSUER
from ...games.players import RobotPlayer
from ...strategies import Strategy, Walk
from .live_session import LiveSession

DIRECTIONS = {"left": 90, "right": -90, "forward": 0, "backward": 180}  # [deg]
TURN = radians(50.0)  # desired heading of a turn
TURNS = {"left": 1.0, "straight": 0.0, "right": -1.0}
KEYS: dict[str, Any] = {
    "left": "arrowleft",
    "right": "arrowright",
    "straight": "arrowup",
}


def add_push(
    gui: viser.GuiApi, session: LiveSession, notify: Callable[[str], None]
) -> None:
    """Add the controls of pushes to a page."""
    with gui.add_folder("Push"):
        robot = gui.add_dropdown("Robot", session.names)
        impulse = gui.add_number("Impulse [N s]", 0.5, step=0.1)
        direction = gui.add_dropdown("Direction", tuple(DIRECTIONS))
        push = gui.add_button("Push")

    @push.on_click
    def _(_: object) -> None:
        angle = radians(DIRECTIONS[direction.value])
        try:
            session.push(robot.value, float(impulse.value), angle)
        except StepAsideError as error:
            notify(str(error))
        else:
            notify(
                f"pushed {named(robot.value)} {direction.value} by "
                f"{impulse.value:g} N s"
            )


def named(player: str) -> str:
    """Return the name of a player in a sentence."""
    return f"the {player}" if player in PLAYERS else player


def drivable(session: LiveSession) -> tuple[str, ...]:
    """Return the robots that pursue, or all if none does, or all players."""
    robots = [p for p in session.played.players if p.body == "robot"]
    pursuers = [p for p in robots if p.role == PURSUER]
    return tuple(p.name for p in pursuers or robots) or session.names


class DrivePanel:
    """Teleoperation of one robot."""

    def __init__(self, gui: viser.GuiApi, session: LiveSession) -> None:
        """Add the controls to a page."""
        self._session = session
        self._hand: Walk | None = None
        self._own: Strategy | None = None  # of the driven robot
        with gui.add_folder("Drive"):
            gui.add_markdown(
                "Buttons or keys: arrows left, right and up (straight), g "
                "(go), h (halt)."
            )
            names = drivable(session)
            self._choice = gui.add_dropdown(
                "Driven robot", names, visible=len(names) > 1
            )
            turn = gui.add_button_group("Turn", tuple(TURNS))
            walk = gui.add_button_group("Walk", ("go", "halt"))
            self._state = gui.add_markdown(self._state_text())
            self._stop = gui.add_button("Stop driving", disabled=True)
        self._choice.on_update(lambda _: self._release())
        turn.on_click(lambda _: self._drive(bearing=TURN * TURNS[turn.value]))
        walk.on_click(
            lambda _: self._drive(speed_factor=float(walk.value == "go"))
        )
        self._stop.on_click(lambda _: self._release())
        for name, key, change in (
            *((n, k, {"bearing": TURN * TURNS[n]}) for n, k in KEYS.items()),
            ("go", "G", {"speed_factor": 1.0}),
            ("halt", "H", {"speed_factor": 0.0}),
        ):
            command: Any = gui.add_command(f"Drive: {name}", hotkey=key)
            command.on_trigger(lambda _, change=change: self._drive(**change))

    def reset(self) -> None:
        """End teleoperation, since another game has begun."""
        self._choice.options = drivable(self._session)
        self._own = None
        self._set_hand(None)

    def show(self) -> None:
        """End teleoperation at the end of the game."""
        if self._session.outcome is not None and self._hand is not None:
            self._set_hand(None)

    def _drive(self, **change: float) -> None:
        """Change the command, taking over the robot if it is one."""
        name = self._choice.value
        if self._is_robot(name):
            changes: Any = change
            hand = replace(self._hand or Walk(), **changes)
            self._set_hand(hand)
            self._adopt(name, hand)

    def _release(self) -> None:
        """Return the robot to its own strategy."""
        name = self._session.driven
        self._set_hand(None)
        if name:
            self._adopt(name, None)

    def _set_hand(self, hand: Walk | None) -> None:
        """Set and show the command of teleoperation; None for none."""
        self._hand = hand
        self._session.driven = "" if hand is None else self._choice.value
        self._state.content = self._state_text()
        self._stop.disabled = hand is None

    def _is_robot(self, name: str) -> bool:
        """Return whether a player is a robot with its own strategy."""
        return isinstance(self._session.world.player(name), RobotPlayer)

    def _state_text(self) -> str:
        """Return the state of teleoperation as text."""
        hand, who = self._hand, named(self._choice.value)
        if not self._is_robot(self._choice.value):
            return f"{who[0].upper()}{who[1:]} cannot be driven."
        if hand is None:
            return f"Not driven: {who} follows its own strategy."
        direction = "straight ahead"
        if hand.bearing:
            direction = f"to the {'left' if hand.bearing > 0.0 else 'right'}"
        motion = f"walks {direction}" if hand.speed_factor else "halts"
        return f"**Driven by hand**: {who} {motion}."

    def _adopt(self, name: str, strategy: Strategy | None) -> None:
        """Set the strategy of a robot; None for its own again."""

        def change() -> None:
            robot = self._session.world.player(name)
            if isinstance(robot, RobotPlayer):
                decisions = robot.scheme.decisions
                own = self._own or decisions.strategy
                decisions.adopt(strategy or own)
                self._own = own if strategy else None

        self._session.call(change)
