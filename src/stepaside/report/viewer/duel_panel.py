"""Panel with the settings of the evader and of the next duel."""

from collections.abc import Callable
from dataclasses import replace
from math import degrees, radians
from typing import Any

import viser

from ...core.errors import StepAsideError
from ...games.duel_settings import EVADER, SENSING, DuelSettings
from ...games.implied_settings import EVASION
from ...games.recorded_game import RecordedGame
from ...games.walker import RobotPlayer
from ...locomotion.zmp.control_settings import (
    OPEN_LOOP,
    STABILISED,
    ControlSettings,
)
from ...planning import GaitSettings
from ...sim.body_settings import BODIES, BodySettings
from .duel_presets import duel_presets
from .live_session import LiveSession

LAWS = ("proportional (4)", "saturated (6)")
CUSTOM_BODY = "as started"  # name of a body that is no preset


def body_choices(
    settings: DuelSettings,
) -> tuple[dict[str, tuple[BodySettings, ControlSettings]], str]:
    """Return bodies with their control by name, and the name of the current.

    The current body has the control of the settings.

    Args:
        settings: Settings with which the page was started.
    """
    choices = {
        name: (body, OPEN_LOOP if name == "ideal" else STABILISED)
        for name, body in BODIES.items()
    }
    names = [n for n, body in BODIES.items() if body == settings.body]
    name = (names or [CUSTOM_BODY])[0]
    choices[name] = settings.body, settings.resolved().control
    return choices, name


def walking_speed_text(gait: GaitSettings) -> str:
    """Return the walking speed as text; the template speed does not set it.

    Args:
        gait: Settings of the gait.
    """
    speed = gait.stride / gait.step_duration
    return (
        "Template speed and gain set the circle. The robots walk at "
        f"{speed:.3f} m/s: a stride of {gait.stride:g} m in "
        f"{gait.step_duration:.3g} s."
    )


class DuelPanel:
    """Controls of the evader's strategy and of the next duel.

    Attributes:
        preset: Choice of a duel by name.
    """

    def __init__(
        self,
        gui: viser.GuiApi,
        session: LiveSession,
        notify: Callable[[str], None],
    ) -> None:
        """Add the controls to a page, with the current settings.

        Args:
            gui: Controls of the page.
            session: Session whose settings are changed.
            notify: Function that shows a message.
        """
        self._session = session
        self._notify = notify
        settings = self._settings
        self._bodies_by_name, self._body_name = body_choices(settings)
        self._presets = duel_presets(settings)
        self.preset = gui.add_dropdown("Preset", tuple(self._presets))
        start = self._session.match.settings.start
        with gui.add_folder("Evader (from its next step)"):
            self._angle = gui.add_number(
                "Evasion angle [deg]",
                degrees(settings.strategy.angle),
                step=5.0,
            )
            self._law = gui.add_dropdown(
                "Law", LAWS, initial_value=LAWS[settings.strategy.saturated]
            )
        with gui.add_folder("Next duel (from the next reset)"):
            self._seed = gui.add_number("Seed", settings.seed, step=1)
            self._distance = gui.add_number(
                "Distance [m]", round(start.distance or 1.0, 3), step=0.05
            )
            self._pursuer_off = gui.add_number(
                "Pursuer's heading offset [deg]",
                round(degrees(start.pursuer_offset or 0.0), 1),
                step=5.0,
            )
            self._evader_off = gui.add_number(
                "Evader's heading offset [deg]",
                round(degrees(start.evader_offset or 0.0), 1),
                step=5.0,
            )
            self._speed_m_s = gui.add_number(
                "Template speed [m/s]", settings.gait.speed, step=0.01
            )
            gui.add_markdown(walking_speed_text(settings.gait))
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
            self._update_strategy()

        @self._law.on_update
        def _(_: object) -> None:
            self._update_strategy()

    @property
    def _settings(self) -> DuelSettings:
        """Settings of the duel."""
        settings = self._session.settings
        assert isinstance(settings, DuelSettings)
        return settings

    def _update_strategy(self) -> None:
        """Change the evader's strategy from its next plan on."""
        try:
            strategy = replace(
                self._settings.strategy,
                angle=radians(float(self._angle.value)),
                saturated=self._law.value.startswith("saturated"),
            )
        except StepAsideError as error:
            self._notify(str(error))
            return
        session, settings = self._session, self._settings
        if strategy == settings.strategy:
            self._notify("")
            return
        played = settings.resolved().evader_strategy
        if played != EVASION:
            self._notify(f"angle and law are those of evasion, not {played}")
            return
        self._notify("")
        session.adopt_settings(
            replace(settings, strategy=strategy, evader_strategy=EVASION)
        )

        def change(match: RecordedGame) -> None:
            evader = match.in_physics.player(EVADER)
            if isinstance(evader, RobotPlayer):
                evader.scheme.decisions.adopt(strategy)

        session.change(change)

    def play_preset(self) -> bool:
        """Start the duel of the chosen preset.

        Returns:
            Whether its settings were valid.
        """
        settings = self._presets[self.preset.value]
        try:
            self._session.reset(settings)
        except StepAsideError as error:
            self._notify(str(error))
            return False
        body = next(
            name
            for name, (body, _) in self._bodies_by_name.items()
            if body == settings.body
        )
        controls: list[tuple[Any, Any]] = [
            (self._angle, degrees(settings.strategy.angle)),
            (self._law, LAWS[settings.strategy.saturated]),
            (self._seed, settings.seed),
            *self._starts(),
            (self._speed_m_s, settings.gait.speed),
            (self._gain, settings.gait.gain),
            (self._sensing, settings.sensing),
            (self._body, body),
        ]
        for control, value in controls:
            control.value = value
        self._notify("")
        return True

    def _starts(self) -> list[tuple[Any, float]]:
        """Return the controls of the start, with those of the duel."""
        start = self._session.match.settings.start
        off = start.pursuer_offset or 0.0, start.evader_offset or 0.0
        return [
            (self._distance, round(start.distance or 1.0, 3)),
            (self._pursuer_off, round(degrees(off[0]), 1)),
            (self._evader_off, round(degrees(off[1]), 1)),
        ]

    def restart(self) -> bool:
        """Start a duel with the settings of the controls.

        Returns:
            Whether the settings were valid.
        """
        session, started = self._session, self._settings
        body, control = self._bodies_by_name[self._body.value]
        try:
            start = started.start
            if started.room.plan is None:  # rooms draw their starts
                start = replace(
                    start,
                    distance=float(self._distance.value),
                    pursuer_offset=radians(float(self._pursuer_off.value)),
                    evader_offset=radians(float(self._evader_off.value)),
                )
            settings = replace(
                started,
                seed=int(self._seed.value),
                start=start,
                gait=replace(
                    started.gait,
                    speed=float(self._speed_m_s.value),
                    gain=float(self._gain.value),
                ),
                sensing=self._sensing.value,
                body=body,
                control=control,
            )
            session.reset(settings)
        except StepAsideError as error:
            self._notify(str(error))
            return False
        except (ArithmeticError, ValueError) as error:
            self._notify(f"invalid settings: {error}")
            return False
        self._notify("")
        return True
