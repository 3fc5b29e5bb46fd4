"""The live page: controls on one side, the scene on the other."""

import logging
import threading
from dataclasses import replace
from math import degrees, inf, radians
from time import perf_counter, sleep

import numpy as np
import viser
from viser import uplot

from ...control.driving import Driven
from ...control.settings import OPEN_LOOP, STABILISED
from ...errors import StepAsideError
from ...simulation.body_settings import BODIES
from ...simulation.duel import Duel
from ...simulation.settings import DuelSettings
from ..style import EVADER, PURSUER, THEORY
from .bodies import Bodies
from .drawing import draw_session
from .layers import LAYERS, Layers
from .session import Session
from .words import phases_of, words_of

LOG = logging.getLogger(__name__)
RATE = 30.0  # updates of the scene a second
PLOTS = 2.0  # updates of the plots a second
SPEEDS = ("0.25", "0.5", "1", "2", "4", "as fast as it goes")


class Page:
    """A live duel on a server.

    Attributes:
        server: The server.
        session: The duel.
    """

    def __init__(
        self, settings: DuelSettings, *, host: str, port: int
    ) -> None:
        """Serve a duel; time does not pass before somebody lets it.

        Args:
            settings: Of the duel.
            host: Address to serve at.
            port: Port to serve at.
        """
        self.session = Session(settings)
        self.server = viser.ViserServer(
            host=host, port=port, label="stepaside", verbose=False
        )
        self._closing = threading.Event()
        self._hand: Driven | None = None
        self._drive_began: float | None = None
        self._closest = inf
        scene, gui = self.server.scene, self.server.gui
        scene.set_up_direction("+z")
        scene.add_grid(
            "/floor",
            width=12.0,
            height=12.0,
            cell_size=0.25,
            section_size=1.0,
            plane="xy",
        )
        self.server.initial_camera.position = (-0.5, -1.6, 1.3)
        self.server.initial_camera.look_at = (0.5, 0.0, 0.2)
        gui.configure_theme(control_layout="collapsible", dark_mode=False)
        self._layers = Layers(scene)
        self._bodies = Bodies(scene, self.session.duel.world.model)
        self._generation = self.session.generation
        self._status = gui.add_markdown("starting")
        self._message = gui.add_markdown("", visible=False)
        self._add_time()
        self._add_duel()
        self._add_push()
        self._add_drive()
        self._add_layers()
        self._add_plots()
        self._publisher = threading.Thread(target=self._publish, daemon=True)

    def start(self) -> None:
        """Start the loop and the publisher."""
        self.session.start()
        self._publisher.start()

    def close(self) -> None:
        """Stop both and the server."""
        self._closing.set()
        self.session.close()
        self._publisher.join(timeout=5.0)
        self.server.stop()

    def _add_time(self) -> None:
        gui, session = self.server.gui, self.session
        self._play = gui.add_button("Start")
        step = gui.add_button("Step 0.1 s", hint="When paused.")
        reset = gui.add_button("Reset", hint="Begin again with this start.")
        speed = gui.add_dropdown("Speed", SPEEDS, initial_value="1")
        dark = gui.add_checkbox("Dark", False)

        @self._play.on_click
        def _(_: object) -> None:
            session.running = not session.running

        @step.on_click
        def _(_: object) -> None:
            if not session.running:
                session.step(0.1)

        @reset.on_click
        def _(_: object) -> None:
            self._restart()

        @speed.on_update
        def _(_: object) -> None:
            value = speed.value
            session.speed = inf if value == SPEEDS[-1] else float(value)

        @dark.on_update
        def _(_: object) -> None:
            gui.configure_theme(
                control_layout="collapsible", dark_mode=dark.value
            )

    def _add_duel(self) -> None:
        gui = self.server.gui
        settings = self.session.settings
        start = self.session.duel.settings.start
        with gui.add_folder("Strategy (acts at the next step)"):
            self._angle = gui.add_number(
                "Angle [deg]", degrees(settings.strategy.angle), step=5.0
            )
            self._law = gui.add_dropdown(
                "Law", ("proportional (4)", "saturated (6)")
            )
        with gui.add_folder("Start (acts at the next reset)"):
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
                "Driving speed [m/s]", settings.gait.speed, step=0.01
            )
            self._gain = gui.add_number(
                "Gain k [1/s]", settings.gait.gain, step=0.05
            )
            self._body = gui.add_dropdown(
                "Body", tuple(BODIES), initial_value="ideal"
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
                self.session.settings.strategy,
                angle=radians(float(self._angle.value)),
                saturated=self._law.value.startswith("saturated"),
            )
            role = strategy.role()
        except StepAsideError as error:
            self._say(str(error))
            return
        self._say("")
        session = self.session
        session.settings = replace(session.settings, strategy=strategy)

        def change(duel: Duel) -> None:
            old = duel.schemes[1].role
            role.evading = getattr(old, "evading", False)
            duel.schemes[1].role = role

        session.change(change)

    def _restart(self) -> None:
        """Begin again with what the controls say."""
        session = self.session
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
                body=BODIES[self._body.value],
                control=OPEN_LOOP
                if self._body.value == "ideal"
                else STABILISED,
            )
            session.reset(settings)
        except StepAsideError as error:
            self._say(str(error))
            return
        self._hand = None
        self._say("")

    def _add_push(self) -> None:
        gui = self.server.gui
        with gui.add_folder("Push"):
            who = gui.add_dropdown("Robot", ("pursuer", "evader"))
            strength = gui.add_number("Impulse [N s]", 0.5, step=0.1)
            direction = gui.add_dropdown(
                "To", ("left", "right", "forward", "backward")
            )
            push = gui.add_button("Push")
        angles = {"left": 90, "right": -90, "forward": 0, "backward": 180}

        @push.on_click
        def _(_: object) -> None:
            robot = ("pursuer", "evader").index(who.value)
            angle = radians(angles[direction.value])
            try:
                self.session.push(robot, float(strength.value), angle)
            except StepAsideError as error:
                self._say(str(error))
            else:
                self._say(
                    f"pushed the {who.value} {direction.value} by "
                    f"{strength.value:g} N s"
                )

    def _add_drive(self) -> None:
        gui = self.server.gui
        with gui.add_folder("Drive the pursuer"):
            gui.add_markdown(
                "Catch the evader with the buttons or the keys: arrows "
                "left, right and up (straight), g (go), h (halt)."
            )
            wheel = gui.add_button_group("Turn", ("left", "straight", "right"))
            walk = gui.add_button_group("Walk", ("go", "stop"))
            release = gui.add_button("Let it pursue by itself")
            self._score = gui.add_markdown("")
        turns = {"left": 1.0, "straight": 0.0, "right": -1.0}

        @wheel.on_click
        def _(_: object) -> None:
            self._drive(turn=turns[wheel.value])

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

    def _drive(
        self, *, turn: float | None = None, going: bool | None = None
    ) -> None:
        """Take the pursuer over, or steer it."""
        if self._hand is None:
            self._hand = hand = Driven(going=True)
            self._drive_began = self.session.duel.world.time
            self._closest = inf
            self.session.change(
                lambda duel: setattr(duel.schemes[0], "role", hand)
            )
        if turn is not None:
            self._hand.turn = turn
        if going is not None:
            self._hand.going = going

    def _release(self) -> None:
        """Give the pursuer back to itself."""
        from ...control import Pursuit

        self._hand = None
        self.session.change(
            lambda duel: setattr(duel.schemes[0], "role", Pursuit())
        )

    def _add_layers(self) -> None:
        gui = self.server.gui
        with gui.add_folder("Layers", expand_by_default=False):
            for layer in LAYERS:
                self._add_layer(layer)

    def _add_layer(self, layer: str) -> None:
        box = self.server.gui.add_checkbox(layer.capitalize(), True)

        @box.on_update
        def _(_: object) -> None:
            self._layers.shown[layer] = box.value

    def _add_plots(self) -> None:
        gui = self.server.gui
        empty = (np.zeros(1), np.zeros(1), np.zeros(1))
        self._plots = [
            gui.add_uplot(
                empty,
                (
                    uplot.Series(label="time [s]"),
                    uplot.Series(label=label, stroke=colour, width=2),
                    uplot.Series(label="theory", stroke=THEORY, dash=(5, 5)),
                ),
                title=title,
                height=170,
            )
            for title, label, colour in (
                ("Distance [m]", "distance", PURSUER),
                ("Angle between the headings [deg]", "angle", EVADER),
            )
        ]

    def _say(self, text: str) -> None:
        self._message.content = f"**{text}**" if text else ""
        self._message.visible = bool(text)

    def _publish(self) -> None:
        plotted = 0.0
        while not self._closing.is_set():
            began = perf_counter()
            try:
                self._refresh()
                if began - plotted > 1.0 / PLOTS:
                    plotted = began
                    self._plot()
            except Exception:
                LOG.exception("the page could not be refreshed")
            rest = 1.0 / RATE - (perf_counter() - began)
            watched = len(self.server.get_clients()) > 0
            sleep(max(rest, 0.001) if watched else 0.2)

    def _refresh(self) -> None:
        session = self.session
        if session.generation != self._generation:
            self._generation = session.generation
            self._layers.clear()
        moment = session.moment()
        with self.server.atomic():
            self._bodies.move(moment.positions, moment.quaternions)
            draw_session(self._layers, session)
        self._play.label = "Pause" if session.running else "Start"
        duel = session.duel
        history = session.history[-1] if session.history else (0.0, 0.0, 0.0)
        distance, angle = duel.distance, history[2]
        words = words_of(
            phases_of(duel),
            distance,
            angle,
            session.settings.strategy.safety_radius,
            session.theory,
        )
        text = (
            f"{words}\n\n{moment.time:.1f} s simulated, distance "
            f"{distance:.2f} m, closest {duel.min_distance:.2f} m, "
            f"{session.factor:.1f} x real time"
        )
        if session.outcome is not None:
            text += f"\n\n**over: {session.outcome.value}**; reset to go on"
        if session.error is not None:
            text += f"\n\n**stopped: {session.error}**"
        if self._status.content != text:
            self._status.content = text
        if self._hand is not None and self._drive_began is not None:
            self._closest = min(self._closest, distance)
            survived = moment.time - self._drive_began
            self._score.content = (
                f"the evader survived {survived:.1f} s; closest approach "
                f"{self._closest:.2f} m"
            )

    def _plot(self) -> None:
        rows = np.array(self.session.history).reshape(-1, 3)
        if len(rows) < 2:
            return
        theory = self.session.theory or (np.nan, np.nan)
        for column, plot in enumerate(self._plots, start=1):
            level = np.full(len(rows), theory[column - 1])
            plot.data = (rows[:, 0], rows[:, column], level)
