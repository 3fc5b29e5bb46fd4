"""What a live page lets its visitor choose of the duel."""

from collections.abc import Callable
from dataclasses import replace
from math import degrees, radians

import viser

from ...core.errors import StepAsideError
from ...games.duel import Duel
from ...games.duel_settings import SENSING
from ...games.strategy_objects import EVASION
from ...games.walker import Walker
from ...planning import GaitSettings
from .body_choices import body_choices
from .live_session import LiveSession

LAWS = ("proportional (4)", "saturated (6)")


def walking_words(gait: GaitSettings) -> str:
    """Say how fast robots walk, which the template's speed does not set."""
    walked = gait.stride / gait.step_duration
    return (
        f"sets the circle with the gain; the robots walk {walked:.3f} m/s, "
        f"a stride of {gait.stride:g} m in {gait.step_duration:.3g} s"
    )


class DuelPanel:
    """Strategy, which acts at the next step, and start, at the next reset."""

    def __init__(
        self,
        gui: viser.GuiApi,
        session: LiveSession,
        say: Callable[[str], None],
    ) -> None:
        """Add the controls to a page, with the values that it began with.

        Args:
            gui: Of the page.
            session: Whose duel is chosen.
            say: Shows a message.
        """
        self._session, self._say = session, say
        settings = session.settings
        self._bodies_by_name, self._body_name = body_choices(settings)
        start = self._session.duel.settings.start
        with gui.add_folder("Evader, from its next step on"):
            self._angle = gui.add_number(
                "Angle [deg]", degrees(settings.strategy.angle), step=5.0
            )
            self._law = gui.add_dropdown(
                "Law", LAWS, initial_value=LAWS[settings.strategy.saturated]
            )
        with gui.add_folder("Next duel, at a reset"):
            self._seed = gui.add_number("Seed", settings.seed, step=1)
            self._distance = gui.add_number(
                "Distance [m]", round(start.distance or 1.0, 3), step=0.05
            )
            self._pursuer_off = gui.add_number(
                "Pursuer turned by [deg]",
                round(degrees(start.pursuer_offset or 0.0), 1),
                step=5.0,
            )
            self._evader_off = gui.add_number(
                "Evader turned by [deg]",
                round(degrees(start.evader_offset or 0.0), 1),
                step=5.0,
            )
            self._speed_m_s = gui.add_number(
                "Template speed [m/s]", settings.gait.speed, step=0.01
            )
            self._walks = gui.add_markdown(walking_words(settings.gait))
            self._gain = gui.add_number(
                "Gain k [1/s]", settings.gait.gain, step=0.05
            )
            self._sensing = gui.add_dropdown(
                "Sensing", SENSING, initial_value=settings.sensing
            )
            self._body = gui.add_dropdown(
                "Body",
                tuple(self._bodies_by_name),
                initial_value=self._body_name,
            )

        @self._angle.on_update
        def _(_: object) -> None:
            self._strategy()

        @self._law.on_update
        def _(_: object) -> None:
            self._strategy()

    def _strategy(self) -> None:
        """Give the evader another strategy at its next replan."""
        try:
            strategy = replace(
                self._session.settings.strategy,
                angle=radians(float(self._angle.value)),
                saturated=self._law.value.startswith("saturated"),
            )
        except StepAsideError as error:
            self._say(str(error))
            return
        self._say("")
        session = self._session
        session.settings = replace(
            session.settings, strategy=strategy, evader_strategy=EVASION
        )
        session.expect()

        def change(duel: Duel) -> None:
            evader = duel.players[1]
            if isinstance(evader, Walker):
                evader.scheme.decisions.adopt(strategy)

        session.change(change)

    def restart(self) -> bool:
        """Begin again with what the controls say; false if they may not."""
        session = self._session
        body, control = self._bodies_by_name[self._body.value]
        try:
            settings = replace(
                session.settings,
                seed=int(self._seed.value),
                start=replace(
                    session.settings.start,
                    distance=float(self._distance.value),
                    pursuer_offset=radians(float(self._pursuer_off.value)),
                    evader_offset=radians(float(self._evader_off.value)),
                ),
                gait=replace(
                    session.settings.gait,
                    speed=float(self._speed_m_s.value),
                    gain=float(self._gain.value),
                ),
                sensing=self._sensing.value,
                body=body,
                control=control,
            )
            session.reset(settings)
        except StepAsideError as error:
            self._say(str(error))
            return False
        except (ArithmeticError, ValueError) as error:  # no range names it
            self._say(f"no duel can begin so: {error}")
            return False
        self._say("")
        return True
