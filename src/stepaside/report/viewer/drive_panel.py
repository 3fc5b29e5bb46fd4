"""Buttons, keys and a stick with which a hand drives the pursuer."""

from collections.abc import Callable
from dataclasses import replace
from math import radians

import viser

from ...core.errors import StepAsideError
from ...games.duel import Duel
from ...games.walker import Walker
from ...strategies import Pursuit, Strategy, TeleoperatedPursuit
from .live_session import LiveSession
from .scoreboard import Scoreboard

DIRECTIONS = {"left": 90, "right": -90, "forward": 0, "backward": 180}
ROBOTS = ("pursuer", "evader")


def add_push(
    gui: viser.GuiApi, session: LiveSession, say: Callable[[str], None]
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


TURNS = {"left": 1.0, "straight": 0.0, "right": -1.0}
SLOW = 0.25  # of the speed, while the closest approach is made


class DrivePanel:
    """Takes the pursuer over, and keeps the score."""

    def __init__(self, gui: viser.GuiApi, session: LiveSession) -> None:
        """Add the controls to a page."""
        self._session = session
        self._hand: TeleoperatedPursuit | None = None
        self._score = Scoreboard()
        with gui.add_folder("Drive the pursuer"):
            gui.add_markdown(
                "Catch the evader with the buttons, a gamepad, the stick on "
                "a phone or the keys: arrows left, right and up (straight), "
                "g (go), h (halt)."
            )
            wheel = gui.add_button_group("Turn", tuple(TURNS))
            walk = gui.add_button_group("Walk", ("go", "stop"))
            self._state = gui.add_markdown(self._words())
            self._release_button = gui.add_button(
                "Let it pursue by itself", disabled=True
            )
            self._slows = gui.add_checkbox("Slow at the closest", True)
            self._told = gui.add_markdown("")

        @wheel.on_click
        def _(_: object) -> None:
            self._drive(turn=TURNS[wheel.value])

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

    def forget(self) -> None:
        """Note that another duel began, which nobody drives."""
        self._take(None)
        self._score.end("begun anew")

    def show(self, time: float, distance: float) -> None:
        """Show the score, and let what is close pass slowly.

        Args:
            time: Simulated time, in [s].
            distance: Between the robots, in [m].
        """
        session = self._session
        self._score.watch(time, distance)
        if session.outcome is not None and self._hand is not None:
            self._take(None)
            self._score.end(session.outcome.value)
        radius = session.settings.strategy.area
        close = self._slows.value and self._score.is_close(radius)
        session.slow = SLOW if close else 1.0
        text = self._score.words()
        if self._told.content != text:
            self._told.content = text

    def steer(self, turn: float, going: bool) -> None:
        """Drive as a stick is held.

        Args:
            turn: From -1, a full turn to the right, to 1, one to the left.
            going: Whether the robot walks.
        """
        self._drive(turn=turn, going=going)

    def _drive(
        self, *, turn: float | None = None, going: bool | None = None
    ) -> None:
        """Take the pursuer over, or steer it; a person takes no orders."""
        if not isinstance(self._session.duel.players[0], Walker):
            return
        hand = self._hand
        if hand is None:
            hand = TeleoperatedPursuit(going=True)
            self._score.begin(self._session.duel.world.time)
        if turn is not None:
            hand = replace(hand, turn=turn)
        if going is not None:
            hand = replace(hand, going=going)
        self._take(hand)
        self._session.note(turn=hand.turn, going=hand.going)
        self._give(hand)

    def _release(self) -> None:
        """Give the pursuer back to itself."""
        self._take(None)
        self._score.end("let go")
        self._session.note(released=True)
        self._give(Pursuit())

    def _take(self, hand: TeleoperatedPursuit | None) -> None:
        """Note how the pursuer is driven, and show it; None if by itself."""
        self._hand = hand
        self._session.driven = hand is not None
        self._state.content = self._words()
        self._release_button.disabled = hand is None

    def _words(self) -> str:
        """Say who steers the pursuer, and where to."""
        hand = self._hand
        if not isinstance(self._session.duel.players[0], Walker):
            return "A person cannot be driven."
        if hand is None:
            return "Not driven: the pursuer follows its own strategy."
        way = "straight ahead"
        if hand.turn:
            way = f"to the {'left' if hand.turn > 0.0 else 'right'}"
        does = f"walks {way}" if hand.going else "halts"
        return f"**Driven by hand**: the pursuer {does}."

    def _give(self, strategy: Strategy) -> None:
        """Let a pursuer that is a robot follow a strategy from now on."""

        def change(duel: Duel) -> None:
            pursuer = duel.players[0]
            if isinstance(pursuer, Walker):
                pursuer.scheme.decisions.adopt(strategy)

        self._session.change(change)
