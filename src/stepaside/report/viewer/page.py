"""The live page: controls on one side, the scene on the other."""

import logging
import threading
from math import inf
from time import perf_counter, sleep

from ...games.settings import DuelSettings
from ..inert import for_markdown
from .bodies import Bodies
from .camera_panel import CameraPanel
from .drawing import draw_session
from .drive_panel import DrivePanel
from .duel_panel import DuelPanel
from .layers import LAYERS, Layers
from .plots import Plots
from .push_panel import add_push
from .serving import open_server
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
        gate: Its door.
        session: The duel.
    """

    def __init__(
        self, settings: DuelSettings, *, host: str, port: int
    ) -> None:
        """Serve a duel; time does not pass before somebody lets it.

        Args:
            settings: Of the duel.
            host: Address to serve at.
            port: Port to serve at, or the next that is free.

        Raises:
            StepAsideError: If nothing can be served there, or the settings
                ask for what cannot be.
        """
        served = open_server(host, port)
        self.server, self.gate = served.server, served.gate
        try:
            self.session = Session(settings)
        except BaseException:
            self.server.stop()
            raise
        served.listener.say = self._say
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
        self._layers = Layers(scene)
        self._bodies = Bodies(scene, self.session.duel.world.model)
        self._generation = self.session.generation
        self._status = gui.add_markdown("starting")
        self._message = gui.add_markdown("", visible=False)
        self._add_time()
        self._duel = DuelPanel(gui, self.session, self._say)
        add_push(gui, self.session, self._say)
        self._drive = DrivePanel(gui, self.session)
        self._add_layers()
        self._plots = Plots(gui)
        self._cameras = CameraPanel(gui)
        self._watch_cameras()
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
            if self._duel.restart():
                self._drive.forget()

        @speed.on_update
        def _(_: object) -> None:
            value = speed.value
            session.speed = inf if value == SPEEDS[-1] else float(value)

        @dark.on_update
        def _(_: object) -> None:
            gui.configure_theme(dark_mode=dark.value, show_share_button=False)

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

    def _watch_cameras(self) -> None:
        """Show the cameras of the duel that runs, if it has any."""
        with_cameras = self.session.settings.sensing == "cameras"
        self._cameras.forget(visible=with_cameras)

    def _say(self, text: str) -> None:
        self._message.content = f"**{for_markdown(text)}**" if text else ""
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
                    self._cameras.show(self.session.new_frames())
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
            self._watch_cameras()
        moment = session.moment()
        with self.server.atomic():
            self._bodies.move(moment.positions, moment.quaternions)
            draw_session(self._layers, session)
        self._play.label = "Pause" if session.running else "Start"
        duel = session.duel
        history = session.trail.history
        angle = history[-1][2] if history else 0.0
        distance = duel.distance or 0.0
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
            text += f"\n\n{duel.message}"
        if session.error is not None:
            text += f"\n\n**stopped: {for_markdown(session.error)}**"
        if self._status.content != text:
            self._status.content = text
        self._drive.show(moment.time, distance)
