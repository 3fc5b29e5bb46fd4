"""The live page: controls on one side, the scene on the other."""

import logging
import threading
from math import inf
from pathlib import Path
from time import perf_counter, sleep
from typing import Any

import numpy as np

from ...core.errors import StepAsideError
from ...games.duel_settings import PLAYERS, DuelSettings
from ...games.strategy_objects import EVASION
from ..palette import LIGHTS
from ..text_escaping import for_markdown
from .camera_panel import CameraPanel
from .dragging import PushDragging
from .drive_panel import DrivePanel, add_push
from .duel_panel import DuelPanel
from .live_drawing import draw_session
from .live_session import LiveFrame, LiveSession
from .notices import Notices
from .page_layout import arrange
from .page_server import open_server
from .plots import Plots
from .run_saving import RunSaver
from .scene_bodies import SceneBodies
from .scene_layers import LAYERS, SceneLayers, legend
from .status_text import outlook, words_of
from .viewer_clients import CAMERAS, ViewerClients

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
            self.session = LiveSession(settings)
        except BaseException:
            self.server.stop()
            raise
        self._say = Notices(self.server).say
        served.listener.say = self._say
        self._closing = threading.Event()
        self._layers, self._viewers = self._set_scene()
        self._generation = self.session.generation
        gui = self.server.gui
        layout = arrange(gui)
        self._status = gui.add_markdown("starting")
        self._add_time()
        self._add_keys()
        self._plots = Plots(gui)
        with layout.play:
            self._cameras = CameraPanel(gui)
            add_push(gui, self.session, self._say)
            self._drive = DrivePanel(gui, self.session)
        served.hand.attend(self._drive.steer)
        with layout.settings:
            self._duel = DuelPanel(gui, self.session, self._say)
        with layout.shown:
            self._add_layers()
        self._watch_cameras()
        self._saving = RunSaver(Path("runs"))
        self._publisher = threading.Thread(target=self._publish, daemon=True)

    def _set_scene(self) -> tuple[SceneLayers, ViewerClients]:
        """Put the robots with their names into the scene, with light."""
        scene, model = self.server.scene, self.session.duel.world.model
        scene.set_up_direction("+z")
        scene.configure_default_lights(cast_shadow=True)
        self.server.initial_camera.position = (-0.5, -1.6, 1.3)
        self.server.initial_camera.look_at = (0.5, 0.0, 0.2)
        self._bodies = SceneBodies(scene, model)
        self._bodies.name(model, PLAYERS)
        dragging = PushDragging(scene, self.session, self._say)
        for number, player in enumerate(PLAYERS):
            dragging.attend(number, self._bodies.meshes_of(model, player))
        return SceneLayers(scene), ViewerClients(
            self.server, self.session.settings.room.plan
        )

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
        self._play = gui.add_button("Start", hint="Key: space.")
        acting = gui.add_button_group("Duel", ("step", "reset", "save"))
        speed = gui.add_dropdown("Speed", SPEEDS, initial_value="1")
        camera = gui.add_button_group("Camera", CAMERAS)
        light = gui.add_button_group("Light", LIGHTS)
        acts = {"step": self._step, "reset": self._reset, "save": self._save}

        @self._play.on_click
        def _(_: object) -> None:
            session.running = not session.running

        @acting.on_click
        def _(_: object) -> None:
            acts[acting.value]()

        @speed.on_update
        def _(_: object) -> None:
            value = speed.value
            session.speed = inf if value == SPEEDS[-1] else float(value)

        @camera.on_click
        def _(event: Any) -> None:
            self._viewers.choose(event.client, camera.value)

        @light.on_click
        def _(event: Any) -> None:
            self._viewers.light_up(event.client, light.value)

    def _add_keys(self) -> None:
        """Do the same by keys; viser lists them under ctrl-K."""
        gui, session, viewers = self.server.gui, self.session, self._viewers
        play = gui.add_command("Play or pause", hotkey="space")
        step = gui.add_command("Step 0.1 s", hotkey="N")
        again = gui.add_command("Begin again", hotkey="R")
        save = gui.add_command("Save this duel", hotkey="S")
        light = gui.add_command("Light or dark", hotkey="L")
        free = gui.add_command("Camera: free", hotkey="1")
        follow = gui.add_command("Camera: follow", hotkey="2")
        top = gui.add_command("Camera: top", hotkey="3")
        eyes = gui.add_command("Camera: evader's eyes", hotkey="4")

        @play.on_trigger
        def _(_: object) -> None:
            session.running = not session.running

        step.on_trigger(lambda _: self._step())
        again.on_trigger(lambda _: self._reset())
        save.on_trigger(lambda _: self._save())
        light.on_trigger(lambda event: viewers.turn_light(event.client))
        free.on_trigger(lambda e: viewers.choose(e.client, CAMERAS[0]))
        follow.on_trigger(lambda e: viewers.choose(e.client, CAMERAS[1]))
        top.on_trigger(lambda e: viewers.choose(e.client, CAMERAS[2]))
        eyes.on_trigger(lambda e: viewers.choose(e.client, CAMERAS[3]))

    def _step(self) -> None:
        """Let a tenth of a second pass, if no time passes."""
        if not self.session.running:
            self.session.step(0.1)

    def _reset(self) -> None:
        """Begin again with what the settings say."""
        if self._duel.restart():
            self._drive.forget()

    def _save(self) -> None:
        """Write a run folder, and say where it is."""
        try:
            folder = self.session.save(self._saving)
        except StepAsideError as error:
            self._say(str(error))
        else:
            self._say(f"saved: stepaside replay {folder}")

    def _add_layers(self) -> None:
        for layer in LAYERS:
            self._add_layer(layer)
        self.server.gui.add_markdown(legend(LAYERS))

    def _add_layer(self, layer: str) -> None:
        box = self.server.gui.add_checkbox(layer[0].upper() + layer[1:], True)

        @box.on_update
        def _(_: object) -> None:
            self._layers.shown[layer] = box.value

    def _watch_cameras(self) -> None:
        """Show the cameras of the duel that runs, if it has any."""
        with_cameras = self.session.settings.sensing == "cameras"
        self._cameras.forget(visible=with_cameras)

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
        self._viewers.aim(
            [np.array(each.torso[:2]) for each in moment.players],
            [float(each.com[2]) for each in moment.players],
        )
        self._play.label = "Pause" if session.running else "Start"
        words = words_of(
            moment.phases,
            moment.distance,
            moment.angle,
            self._begins,
            session.theory,
            approach=moment.approach,
        )
        pace = ""
        if session.running and session.factor > 0.0:  # it is known
            pace = f", {session.factor:.1f} x real time"
        text = (
            f"{words}\n\n{self._outlook(moment)}\n\n"
            f"{moment.time:.1f} s simulated{pace}\n\n"
            f"distance {moment.distance:.2f} m, "
            f"closest {moment.closest:.2f} m"
        )
        if session.outcome is not None:
            text += f"\n\n**over: {session.outcome.value}**; reset to go on"
            text += f"\n\n{moment.message}"
        if session.error is not None:
            text += f"\n\n**stopped: {for_markdown(session.error)}**"
        if self._status.content != text:
            self._status.content = text
        self._drive.show(moment.time, moment.distance)

    @property
    def _begins(self) -> float:
        """Distance at which the evader begins to move, in [m].

        Infinite for strategies that do not wait for a distance.
        """
        settings = self.session.settings
        if settings.evader_strategy != EVASION:
            return inf
        if settings.pursuer == "person":
            return settings.strategy.begins_at(settings.person.speed)
        walked = settings.gait.stride / settings.gait.step_duration
        return settings.strategy.begins_at(walked)

    def _outlook(self, moment: LiveFrame) -> str:
        """What is expected next."""
        session = self.session
        if session.driven:
            return "**A hand drives the pursuer**: theory says nothing of it."
        return outlook(
            moment.distance,
            moment.phases[1],
            safety=self._begins,
            approach=moment.approach,
            theory=session.theory,
            settling=session.settling,
        )
