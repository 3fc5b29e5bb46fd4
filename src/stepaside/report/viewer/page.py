"""The live page: controls on one side, the scene on the other."""

import logging
import threading
from dataclasses import replace
from math import degrees, inf, radians
from time import perf_counter, sleep

import viser

from ...control.balance.settings import OPEN_LOOP, STABILISED
from ...errors import StepAsideError
from ...games.duel import Duel
from ...games.settings import SENSING, DuelSettings
from ...world.body_settings import BODIES
from .bodies import Bodies
from .camera_panel import CameraPanel
from .drawing import draw_session
from .drive_panel import DrivePanel
from .layers import LAYERS, Layers
from .plots import Plots
from .push_panel import add_push
from .session import Session
from .words import phases_of, words_of

LOG = logging.getLogger(__name__)
RATE = 30.0  # updates of the scene a second
PLOTS = 4.0  # updates of the plots and pictures a second
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
        gui.configure_theme(dark_mode=False)
        self._layers = Layers(scene)
        self._bodies = Bodies(scene, self.session.duel.world.model)
        self._generation = self.session.generation
        self._status = gui.add_markdown("starting")
        self._message = gui.add_markdown("", visible=False)
        self._add_time()
        self._add_duel()
        add_push(gui, self.session, self._say)
        self._drive = DrivePanel(gui, self.session)
        self._add_layers()
        self._plots = Plots(gui)
        self._cameras = CameraPanel(gui)
        self._cameras.watch(self.session.duel)
        self._publisher = threading.Thread(target=self._publish, daemon=True)

    def start(self) -> None:
        """Start to publish."""
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
            gui.configure_theme(dark_mode=dark.value)

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
            self._sensing = gui.add_dropdown(
                "Sensing", SENSING, initial_value=settings.sensing
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
                sensing=self._sensing.value,
                body=BODIES[self._body.value],
                control=OPEN_LOOP
                if self._body.value == "ideal"
                else STABILISED,
            )
            session.reset(settings)
        except StepAsideError as error:
            self._say(str(error))
            return
        self._drive.forget()
        self._say("")

    def _add_layers(self) -> None:
        gui = self.server.gui
        with gui.add_folder("Layers", expand_by_default=False):
            for layer in LAYERS:
                self._add_layer(layer)

    def _add_layer(self, layer: str) -> None:
        box = self.server.gui.add_checkbox(layer[0].upper() + layer[1:], True)

        @box.on_update
        def _(_: object) -> None:
            self._layers.shown[layer] = box.value

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
                    self._plots.show(self.session)
                    self._cameras.show()
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
            self._cameras.watch(session.duel)
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
        self._drive.show(moment.time, distance)
