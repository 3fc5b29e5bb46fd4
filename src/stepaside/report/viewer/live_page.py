"""Live page: a running game with controls, in a browser."""

import logging
import threading
from math import inf, isfinite
from pathlib import Path
from time import perf_counter, sleep
from typing import Any

import numpy as np

from ...core.errors import StepAsideError
from ...games.duel_settings import EVADER, PLAYERS, DuelSettings
from ...games.game_settings import GameSettings
from ..palette import THEMES
from ..text_escaping import for_markdown
from .camera_panel import CameraPanel
from .drive_panel import DrivePanel, add_push, named
from .duel_panel import DuelPanel
from .game_panel import GamePanel
from .live_drawing import draw_session
from .live_match import (
    LiveSettings,
    has_cameras,
    room_of,
    stage_of,
    trigger_distance,
)
from .live_session import LiveSession, LiveSnapshot
from .page_layout import arrange_panels
from .page_server import Notices, open_server
from .plots import Plots
from .run_saving import RunSaver
from .scene_bodies import SceneBodies
from .scene_layers import LAYERS, SceneLayers, legend
from .status_text import outlook, players_text, status_text
from .viewer_clients import (
    CAMERAS,
    EVERYBODY,
    ViewerClients,
    order_in_view,
)

LOG = logging.getLogger(__name__)
RATE = 30.0  # updates of the scene per second
PLOT_RATE = 4.0  # updates of plots and camera images per second
SPEEDS = ("0.25", "0.5", "1", "2", "4", "as fast as possible")


class Page:
    """Live game on a server.

    Attributes:
        server: viser's server.
        session: The game.
        layers: Layers drawn over the scene.
        plots: Plots of the history.
    """

    def __init__(
        self,
        settings: LiveSettings,
        *,
        port: int,
    ) -> None:
        """Serve a game, which is paused at first.

        Args:
            settings: Settings of the game.
            port: First port to try.

        Raises:
            StepAsideError: If the address cannot be used or the settings are
                invalid.
        """
        self.server = open_server(port)
        try:
            self.session = LiveSession(settings)
        except BaseException:
            self.server.stop()
            raise
        self._notify = Notices(self.server).show
        self._closing = threading.Event()
        self.layers, self._viewers = self._set_scene()
        self._generation = self.session.generation
        gui = self.server.gui
        layout = arrange_panels(gui)
        self._status = gui.add_markdown("starting")
        self._add_buttons()
        self._add_keys()
        is_duel = isinstance(settings, DuelSettings)
        self.plots = Plots(gui, with_angle=is_duel)
        self._drive: DrivePanel | None = None
        with layout.play:
            self._cameras = CameraPanel(gui)
            if self.session.settings.robots:
                add_push(gui, self.session, self._notify)
                self._drive = DrivePanel(gui, self.session)
        self._panel: DuelPanel | GamePanel
        with layout.settings:
            if is_duel:
                self._panel = self._add_duel_panel()
            else:
                self._panel = GamePanel(gui, self.session, self._notify)
        with layout.layers:
            self._add_layers()
        self._reset_cameras()
        self._saving = RunSaver(Path("runs"))
        self._publisher = threading.Thread(target=self._publish, daemon=True)

    def _add_duel_panel(self) -> DuelPanel:
        """Add the panel of a duel, whose presets start at once."""
        panel = DuelPanel(self.server.gui, self.session, self._notify)
        panel.preset.on_update(lambda _: self._play_preset(panel))
        return panel

    def _set_scene(self) -> tuple[SceneLayers, ViewerClients]:
        """Add lights, players and labels to the scene."""
        scene = self.server.scene
        scene.set_up_direction("+z")
        scene.configure_default_lights(cast_shadow=True)
        self.server.initial_camera.position = (-0.5, -1.6, 1.3)
        self.server.initial_camera.look_at = (0.5, 0.0, 0.2)
        self._bodies = self._add_bodies()
        return SceneLayers(scene), ViewerClients(
            self.server, room_of(self.session.settings)
        )

    def _add_bodies(self) -> SceneBodies:
        """Add the bodies of the game."""
        model = self.session.match.in_physics.model
        bodies = SceneBodies(self.server.scene, model)
        bodies.add_labels(model, self.session.names)
        self._shown = stage_of(self.session.settings)
        return bodies

    def start(self) -> None:
        """Start the thread that updates the page."""
        self._publisher.start()

    def close(self) -> None:
        """Stop the game, the updates and the server."""
        self._closing.set()
        self.session.close()
        self._publisher.join(timeout=5.0)
        self.server.stop()

    def _add_buttons(self) -> None:
        """Add the buttons of game, speed, camera and theme."""
        gui, session = self.server.gui, self.session
        self._play = gui.add_button("Start", hint="Key: space.")
        action = gui.add_button_group(
            "Duel" if isinstance(session.settings, DuelSettings) else "Game",
            ("step", "reset", "save"),
        )
        speed = gui.add_dropdown("Speed", SPEEDS, initial_value="1")
        camera = gui.add_button_group("Camera", CAMERAS)
        self._follow = gui.add_dropdown(
            "Follow",
            (EVERYBODY, *session.names),
            visible=len(session.names) > 2,
        )
        theme = gui.add_button_group("Light", THEMES)
        actions = {
            "step": self._step,
            "reset": self._reset,
            "save": self._save,
        }

        @self._play.on_click
        def _(_: object) -> None:
            session.running = not session.running

        @action.on_click
        def _(_: object) -> None:
            actions[action.value]()

        @speed.on_update
        def _(_: object) -> None:
            value = speed.value
            session.speed = inf if value == SPEEDS[-1] else float(value)

        @camera.on_click
        def _(event: Any) -> None:
            self._viewers.choose(event.client, camera.value)

        @theme.on_click
        def _(event: Any) -> None:
            self._viewers.set_theme(event.client, theme.value)

    def _add_keys(self) -> None:
        """Add the same actions as commands with keys, listed by ctrl-K."""
        gui, session, viewers = self.server.gui, self.session, self._viewers
        play = gui.add_command("Play or pause", hotkey="space")
        step = gui.add_command("Step 0.1 s", hotkey="N")
        reset = gui.add_command("Reset", hotkey="R")
        save = gui.add_command("Save this run", hotkey="S")
        theme = gui.add_command("Light or dark", hotkey="L")
        free = gui.add_command("Camera: free", hotkey="1")
        follow = gui.add_command("Camera: follow", hotkey="2")
        top = gui.add_command("Camera: top", hotkey="3")
        eyes = gui.add_command("Camera: player's view", hotkey="4")

        @play.on_trigger
        def _(_: object) -> None:
            session.running = not session.running

        step.on_trigger(lambda _: self._step())
        reset.on_trigger(lambda _: self._reset())
        save.on_trigger(lambda _: self._save())
        theme.on_trigger(lambda event: viewers.toggle_theme(event.client))
        free.on_trigger(lambda e: viewers.choose(e.client, CAMERAS[0]))
        follow.on_trigger(lambda e: viewers.choose(e.client, CAMERAS[1]))
        top.on_trigger(lambda e: viewers.choose(e.client, CAMERAS[2]))
        eyes.on_trigger(lambda e: viewers.choose(e.client, CAMERAS[3]))

    def _step(self) -> None:
        """Advance a paused game by 0.1 s."""
        if not self.session.running:
            self.session.step(0.1)

    def _reset(self) -> None:
        """Start a new game with the settings of the page."""
        if self._panel.restart() and self._drive is not None:
            self._drive.reset()

    def _play_preset(self, panel: DuelPanel) -> None:
        """Start the duel of the chosen preset."""
        if panel.play_preset() and self._drive is not None:
            self._drive.reset()

    def _save(self) -> None:
        """Write a run folder, and show its path."""
        try:
            folder = self.session.save(self._saving)
        except StepAsideError as error:
            self._notify(str(error))
        else:
            self._notify(f"saved; to show it: stepaside show {folder}")

    def _add_layers(self) -> None:
        for layer in LAYERS:
            self._add_layer(layer)
        self.server.gui.add_markdown(legend(LAYERS))

    def _add_layer(self, layer: str) -> None:
        box = self.server.gui.add_checkbox(layer[0].upper() + layer[1:], True)

        @box.on_update
        def _(_: object) -> None:
            self.layers.shown[layer] = box.value

    def _reset_cameras(self) -> None:
        """Show the camera panel if the game has cameras."""
        self._cameras.reset(visible=has_cameras(self.session.settings))

    def _publish(self) -> None:
        plotted = 0.0
        while not self._closing.is_set():
            began = perf_counter()
            try:
                self.refresh()
                if began - plotted > 1.0 / PLOT_RATE:
                    plotted = began
                    self.plots.show(self.session)
                    self._cameras.show(self.session.new_frames())
            except Exception:
                LOG.exception("the page could not be refreshed")
            rest = 1.0 / RATE - (perf_counter() - began)
            watched = len(self.server.get_clients()) > 0
            sleep(max(rest, 0.001) if watched else 0.2)

    def refresh(self) -> None:
        """Show the present state of the session."""
        session = self.session
        with session.lock:  # another game may begin meanwhile
            is_new = session.generation != self._generation
            self._generation = session.generation
            snapshot = session.snapshot()
            if is_new:
                self._renew_stage()
        if is_new:
            self.layers.clear()
            self._reset_cameras()
        with self.server.atomic():
            self._bodies.move(snapshot.positions, snapshot.quaternions)
            draw_session(self.layers, session)
        self._aim(snapshot)
        self._play.label = "Pause" if session.running else "Start"
        text = self._text(snapshot)
        if self._status.content != text:
            self._status.content = text
        if self._drive is not None:
            self._drive.show()

    def _aim(self, snapshot: LiveSnapshot) -> None:
        """Move the cameras that are not free."""
        seen = {player.name: player for player in snapshot.players}
        places = {n: np.array(p.torso[:2]) for n, p in seen.items()}
        order = order_in_view(
            places, self.session.opponents, self._follow.value
        )
        self._viewers.aim(
            [places[name] for name in order],
            [float(seen[name].com[2]) for name in order],
        )

    def _text(self, snapshot: LiveSnapshot) -> str:
        """Return the status text."""
        session, speed = self.session, ""
        if session.running and session.real_time_factor > 0.0:
            speed = f", {session.real_time_factor:.1f} x real time"
        text = (
            f"{self._state(snapshot)}\n\n{self._outlook(snapshot)}\n\n"
            f"{snapshot.time:.1f} s simulated{speed}"
        )
        if isfinite(snapshot.distance):
            least = "least " if len(snapshot.players) > 2 else ""
            text += (
                f"\n\n{least}distance {snapshot.distance:.2f} m, "
                f"closest approach {snapshot.closest:.2f} m"
            )
        if session.outcome is not None:
            text += f"\n\n**over: {session.outcome.value}**; reset to restart"
            text += f"\n\n{snapshot.message}"
        if session.error is not None:
            text += f"\n\n**stopped: {for_markdown(session.error)}**"
        return text

    def _state(self, snapshot: LiveSnapshot) -> str:
        """Return the state of the players as text."""
        settings = self.session.settings
        if isinstance(settings, GameSettings):
            return players_text(self.session.names, snapshot.phases)
        pursuer, evader = snapshot.phases
        return status_text(
            (pursuer, evader),
            snapshot.distance,
            snapshot.angle,
            trigger_distance(settings),
            self.session.theory,
            approach=snapshot.approach,
        )

    def _renew_stage(self) -> None:
        """Replace the bodies if those of the duel are others."""
        settings = self.session.settings
        if self._shown != stage_of(settings):
            self._bodies.remove()
            self._bodies = self._add_bodies()
            self._viewers.show_room(room_of(settings))

    def _outlook(self, snapshot: LiveSnapshot) -> str:
        """Return what is expected next, as text."""
        session, settings = self.session, self.session.settings
        if session.driven:
            who = named(session.driven)
            who = who[0].upper() + who[1:]
            return f"{who} is **driven by hand**: no theory applies."
        if isinstance(settings, GameSettings):
            return ""
        return outlook(
            snapshot.distance,
            snapshot.phases[PLAYERS.index(EVADER)],
            safety=trigger_distance(settings),
            approach=snapshot.approach,
            theory=session.theory,
            settling=session.settling,
        )
