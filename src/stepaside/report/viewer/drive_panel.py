"""Panels for pushes and for teleoperation of the pursuer."""

from collections.abc import Callable
from dataclasses import replace
from math import radians

import viser

from ...core.errors import StepAsideError
from ...games.duel import Duel
from ...games.walker import SimulatedPlayer
from ...strategies import Pursuit, Strategy, TeleoperatedPursuit
from .live_session import LiveSession
from .scoreboard import Scoreboard

DIRECTIONS = {"left": 90, "right": -90, "forward": 0, "backward": 180}  # [deg]
ROBOTS = ("pursuer", "evader")
TURNS = {"left": 1.0, "straight": 0.0, "right": -1.0}
SLOW_MOTION = 0.25  # factor of the speed at a closest approach


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
        robot = gui.add_dropdown("Robot", ROBOTS)
        impulse = gui.add_number("Impulse [N s]", 0.5, step=0.1)
        direction = gui.add_dropdown("Direction", tuple(DIRECTIONS))
        push = gui.add_button("Push")

    @push.on_click
    def _(_: object) -> None:
        angle = radians(DIRECTIONS[direction.value])
        number = ROBOTS.index(robot.value)
        try:
            session.push(number, float(impulse.value), angle)
        except StepAsideError as error:
            notify(str(error))
        else:
            notify(
                f"pushed the {robot.value} {direction.value} by "
                f"{impulse.value:g} N s"
            )


class DrivePanel:
    """Teleoperation of the pursuer, with a scoreboard."""

    def __init__(self, gui: viser.GuiApi, session: LiveSession) -> None:
        """Add the controls to a page."""
        self._session = session
        self._hand: TeleoperatedPursuit | None = None
        self._score = Scoreboard()
        with gui.add_folder("Drive the pursuer"):
            gui.add_markdown(
                "Catch the evader with the buttons, a gamepad, the joystick "
                "on a touch screen or the keys: arrows left, right and up "
                "(straight), g (go), h (halt)."
            )
            turn = gui.add_button_group("Turn", tuple(TURNS))
            walk = gui.add_button_group("Walk", ("go", "halt"))
            self._state = gui.add_markdown(self._state_text())
            self._release_button = gui.add_button(
                "Stop driving", disabled=True
            )
            self._slow_motion = gui.add_checkbox(
                "Slow motion at the closest approach", True
            )
            self._score_text = gui.add_markdown("")

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
        """End teleoperation, since another duel has begun."""
        self._set_hand(None)
        self._score.end("reset")

    def show(self, time: float, distance: float) -> None:
        """Show the score, and set slow motion at a closest approach.

        Args:
            time: Simulated time, in [s].
            distance: Between the players, in [m].
        """
        session = self._session
        self._score.update(time, distance)
        if session.outcome is not None and self._hand is not None:
            self._set_hand(None)
            self._score.end(session.outcome.value)
        radius = session.settings.strategy.area
        close = self._slow_motion.value and self._score.is_close(radius)
        session.slow_motion = SLOW_MOTION if close else 1.0
        text = self._score.text()
        if self._score_text.content != text:
            self._score_text.content = text

    def steer(self, turn: float, going: bool) -> None:
        """Drive the pursuer by a joystick.

        Args:
            turn: From -1 (right) to 1 (left).
            going: Whether to walk.
        """
        self._drive(turn=turn, going=going)

    def _drive(
        self, *, turn: float | None = None, going: bool | None = None
    ) -> None:
        """Change the command, taking over the pursuer if it is a robot."""
        if not isinstance(self._session.duel.players[0], SimulatedPlayer):
            return
        hand = self._hand
        if hand is None:
            hand = TeleoperatedPursuit(going=True)
            self._score.begin(self._session.duel.world.time)
        if turn is not None:
            hand = replace(hand, turn=turn)
        if going is not None:
            hand = replace(hand, going=going)
        self._set_hand(hand)
        self._session.record_command(turn=hand.turn, going=hand.going)
        self._adopt(hand)

    def _release(self) -> None:
        """Return the pursuer to its own strategy."""
        self._set_hand(None)
        self._score.end("released")
        self._session.record_command(released=True)
        self._adopt(Pursuit())

    def _set_hand(self, hand: TeleoperatedPursuit | None) -> None:
        """Set and show the command of teleoperation; None for none."""
        self._hand = hand
        self._session.driven = hand is not None
        self._state.content = self._state_text()
        self._release_button.disabled = hand is None

    def _state_text(self) -> str:
        """Return the state of teleoperation as text."""
        hand = self._hand
        if not isinstance(self._session.duel.players[0], SimulatedPlayer):
            return "The pursuer is a person and cannot be driven."
        if hand is None:
            return "Not driven: the pursuer follows its own strategy."
        direction = "straight ahead"
        if hand.turn:
            direction = f"to the {'left' if hand.turn > 0.0 else 'right'}"
        motion = f"walks {direction}" if hand.going else "halts"
        return f"**Driven by hand**: the pursuer {motion}."

    def _adopt(self, strategy: Strategy) -> None:
        """Set the strategy of the pursuer if it is a robot."""

        def change(duel: Duel) -> None:
            pursuer = duel.players[0]
            if isinstance(pursuer, SimulatedPlayer):
                pursuer.scheme.decisions.adopt(strategy)

        self._session.change(change)
