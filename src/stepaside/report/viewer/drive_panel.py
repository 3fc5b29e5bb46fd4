"""Panels for pushes and for teleoperation of a robot."""

from collections.abc import Callable
from dataclasses import replace
from math import radians

import viser

from ...core.errors import StepAsideError
from ...games.duel_settings import PLAYERS, PURSUER, DuelSettings
from ...games.recorded_game import RecordedGame
from ...games.walker import RobotPlayer
from ...strategies import Strategy, Walk
from .live_match import LiveSettings
from .live_session import LiveSession

DIRECTIONS = {"left": 90, "right": -90, "forward": 0, "backward": 180}  # [deg]
TURN = radians(50.0)  # desired heading of a turn
TURNS = {"left": 1.0, "straight": 0.0, "right": -1.0}


def add_push(
    gui: viser.GuiApi, session: LiveSession, notify: Callable[[str], None]
) -> None:
    """Add the controls of pushes to a page.

    Args:
        gui: Controls of the page.
        session: Session whose robots are pushed.
        notify: Function that shows a message.
    """
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


def drivable(settings: LiveSettings) -> tuple[str, ...]:
    """Return the players that can be driven.

    They are the pursuer of a duel, the robots of a game that pursue, or all
    its robots if none does.
    """
    if isinstance(settings, DuelSettings):
        return (PURSUER,)
    robots = [p for p in settings.players if p.body == "robot"]
    pursuers = [p for p in robots if p.role == PURSUER]
    return tuple(p.name for p in pursuers or robots)


class DrivePanel:
    """Teleoperation of one robot."""

    def __init__(self, gui: viser.GuiApi, session: LiveSession) -> None:
        """Add the controls to a page, which needs a robot to drive.

        Args:
            gui: Controls of the page.
            session: Session whose robot is driven.
        """
        self._session = session
        self._hand: Walk | None = None
        self._own: Strategy | None = None  # of the driven robot
        names = drivable(session.settings)
        duel = names == (PURSUER,)
        with gui.add_folder("Drive the pursuer" if duel else "Drive a robot"):
            gui.add_markdown(
                f"{'Catch the evader' if duel else 'Walk'} with the buttons "
                "or the keys: arrows left, right and up (straight), g (go), "
                "h (halt)."
            )
            self._choice = gui.add_dropdown(
                "Driven robot", names, visible=len(names) > 1
            )
            turn = gui.add_button_group("Turn", tuple(TURNS))
            walk = gui.add_button_group("Walk", ("go", "halt"))
            self._state = gui.add_markdown(self._state_text())
            self._release_button = gui.add_button(
                "Stop driving", disabled=True
            )

        @self._choice.on_update
        def _(_: object) -> None:
            if self._hand is not None:
                self._release()
            self._state.content = self._state_text()

        @turn.on_click
        def _(_: object) -> None:
            self._drive(turn=TURNS[turn.value])

        @walk.on_click
        def _(_: object) -> None:
            self._drive(going=walk.value == "go")

        @self._release_button.on_click
        def _(_: object) -> None:
            self._release()

        left = gui.add_command("Drive left", hotkey="arrowleft")
        right = gui.add_command("Drive right", hotkey="arrowright")
        straight = gui.add_command("Drive straight", hotkey="arrowup")
        go = gui.add_command("Drive: go", hotkey="G")
        halt = gui.add_command("Drive: halt", hotkey="H")
        left.on_trigger(lambda _: self._drive(turn=1.0))
        right.on_trigger(lambda _: self._drive(turn=-1.0))
        straight.on_trigger(lambda _: self._drive(turn=0.0))
        go.on_trigger(lambda _: self._drive(going=True))
        halt.on_trigger(lambda _: self._drive(going=False))

    def reset(self) -> None:
        """End teleoperation, since another game has begun."""
        self._own = None
        self._set_hand(None)

    def show(self) -> None:
        """End teleoperation at the end of the game."""
        if self._session.outcome is not None and self._hand is not None:
            self._set_hand(None)

    def _drive(
        self, *, turn: float | None = None, going: bool | None = None
    ) -> None:
        """Change the command, taking over the robot if it is one."""
        name = self._choice.value
        if not self._is_robot(name):
            return
        hand = self._hand
        if hand is None:
            hand = Walk()
        if turn is not None:
            hand = replace(hand, bearing=turn * TURN)
        if going is not None:
            hand = replace(hand, speed_factor=float(going))
        self._set_hand(hand)
        going = hand.speed_factor > 0.0
        self._session.record_command(turn=hand.bearing / TURN, going=going)
        self._adopt(name, hand)

    def _release(self) -> None:
        """Return the robot to its own strategy."""
        name = self._session.driven
        self._set_hand(None)
        self._session.record_command(released=True)
        if name:
            self._adopt(name, None)

    def _set_hand(self, hand: Walk | None) -> None:
        """Set and show the command of teleoperation; None for none."""
        self._hand = hand
        self._session.driven = "" if hand is None else self._choice.value
        self._state.content = self._state_text()
        self._release_button.disabled = hand is None

    def _is_robot(self, name: str) -> bool:
        """Return whether a player is a robot with its own strategy."""
        return isinstance(
            self._session.match.in_physics.player(name), RobotPlayer
        )

    def _state_text(self) -> str:
        """Return the state of teleoperation as text."""
        hand, who = self._hand, named(self._choice.value)
        if not self._is_robot(self._choice.value):
            who = who[0].upper() + who[1:]
            return f"{who} is a person and cannot be driven."
        if hand is None:
            return f"Not driven: {who} follows its own strategy."
        direction = "straight ahead"
        if hand.bearing:
            direction = f"to the {'left' if hand.bearing > 0.0 else 'right'}"
        motion = f"walks {direction}" if hand.speed_factor else "halts"
        return f"**Driven by hand**: {who} {motion}."

    def _adopt(self, name: str, strategy: Strategy | None) -> None:
        """Set the strategy of a robot; None for its own again."""

        def change(match: RecordedGame) -> None:
            robot = match.in_physics.player(name)
            if not isinstance(robot, RobotPlayer):
                return
            decisions = robot.scheme.decisions
            if self._own is None:
                self._own = decisions.strategy
            if strategy is not None:
                decisions.adopt(strategy)
            else:
                decisions.adopt(self._own)
                self._own = None

        self._session.change(change)
