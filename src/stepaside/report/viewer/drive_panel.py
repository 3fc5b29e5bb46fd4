"""Buttons and keys with which a hand drives the pursuer."""

from dataclasses import replace
from math import inf

import viser

from ...games.duel import Duel
from ...games.walker import Walker
from ...strategies import Driven, Pursuit, Strategy
from .session import Session

TURNS = {"left": 1.0, "straight": 0.0, "right": -1.0}


class DrivePanel:
    """Takes the pursuer over, and keeps the score."""

    def __init__(self, gui: viser.GuiApi, session: Session) -> None:
        """Add the controls to a page."""
        self._session = session
        self._hand: Driven | None = None
        self._began = 0.0
        self._closest = inf
        with gui.add_folder("Drive the pursuer"):
            gui.add_markdown(
                "Catch the evader with the buttons or the keys: arrows "
                "left, right and up (straight), g (go), h (halt)."
            )
            wheel = gui.add_button_group("Turn", tuple(TURNS))
            walk = gui.add_button_group("Walk", ("go", "stop"))
            release = gui.add_button("Let it pursue by itself")
            self._score = gui.add_markdown("")

        @wheel.on_click
        def _(_: object) -> None:
            self._drive(turn=TURNS[wheel.value])

        @walk.on_click
        def _(_: object) -> None:
            self._drive(going=walk.value == "go")

        @release.on_click
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
        self._hand = None
        self._score.content = ""

    def show(self, time: float, distance: float) -> None:
        """Show the score.

        Args:
            time: Simulated time, in [s].
            distance: Between the robots, in [m].
        """
        if self._hand is None:
            return
        self._closest = min(self._closest, distance)
        self._score.content = (
            f"the evader survived {time - self._began:.1f} s; closest "
            f"approach {self._closest:.2f} m"
        )

    def _drive(
        self, *, turn: float | None = None, going: bool | None = None
    ) -> None:
        """Take the pursuer over, or steer it; a person takes no orders."""
        if not isinstance(self._session.duel.players[0], Walker):
            return
        hand = self._hand
        if hand is None:
            hand = Driven(going=True)
            self._began = self._session.duel.world.time
            self._closest = inf
        if turn is not None:
            hand = replace(hand, turn=turn)
        if going is not None:
            hand = replace(hand, going=going)
        self._hand = hand
        self._session.note(turn=hand.turn, going=hand.going)
        self._give(hand)

    def _release(self) -> None:
        """Give the pursuer back to itself."""
        self._hand = None
        self._session.note(released=True)
        self._give(Pursuit())

    def _give(self, strategy: Strategy) -> None:
        """Let a pursuer that is a robot follow a strategy from now on."""

        def change(duel: Duel) -> None:
            pursuer = duel.players[0]
            if isinstance(pursuer, Walker):
                pursuer.scheme.decisions.adopt(strategy)

        self._session.change(change)
