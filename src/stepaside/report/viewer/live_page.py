"""Live page: a running game with controls, in a browser."""

import logging
import threading
from functools import partial
from math import inf
from pathlib import Path
from time import perf_counter, sleep
from typing import Any

import viser

from ...core.errors import StepAsideError
from ...games.game_settings import GameSettings
from ..overlays import LAYERS
from ..palette import rgb
from ..scene import wall_corners
from .drive_panel import DrivePanel, add_push
from .live_overlays import SceneLayers, live_overlays, places_of
from .live_session import LiveSession
from .page_server import open_server, show_notice
from .scene_bodies import SceneBodies
from .settings_panel import SettingsPanel
from .status_panel import Plots, camera_picture, names_text, page_text
from .viewer_cameras import CAMERAS, ViewerCameras

LOG = logging.getLogger(__name__)
RATE = 30.0  # updates of the scene per second
PLOT_RATE = 4.0  # updates of plots and camera images per second
SPEEDS = ("0.25", "0.5", "1", "2", "4", "as fast as possible")
STATUS_WIDTH = 340.0  # of the panel on the right, in [pixels]
CONTROL_WIDTH = 290.0  # of the panel on the left, in [pixels]
FLOOR, FLOOR_LINES = rgb("#f0efec"), rgb("#dad9d4")


class Page:
    """Live game on a server.

    Attributes:
        server: viser's server.
        session: The game.
    """

    def __init__(self, settings: GameSettings, *, port: int) -> None:
        """Serve a game, which is paused at first, at the next free port.

        Raises:
            StepAsideError: If the settings are invalid.
        """
        self.server = open_server(port)
        try:
            self.session = LiveSession(settings)
        except BaseException:
            self.server.stop()
            raise
        self._notify = partial(show_notice, self.server)
        self._closing = threading.Event()
        self._generation = self.session.generation
        gui, scene = self.server.gui, self.server.scene
        scene.set_up_direction("+z")
        scene.configure_default_lights(cast_shadow=True)
        self.server.initial_camera.position = (-0.5, -1.6, 1.3)
        self.server.initial_camera.look_at = (0.5, 0.0, 0.2)
        self._layers = SceneLayers(scene)
        self._viewers = ViewerCameras(self.server)
        _add_floor(scene)
        self._names = gui.add_html("")
        self._add_bodies()
        play, settings_tab, layers = self._arrange()
        self._status = gui.add_markdown("starting")
        self._add_buttons()
        self._plots = Plots(gui)
        self._images: dict[str, viser.GuiImageHandle] = {}
        with play:
            add_push(gui, self.session, self._notify)
            self._drive = DrivePanel(gui, self.session)
            self._cameras = gui.add_folder("Cameras", visible=False)
        with settings_tab:
            self._panel = SettingsPanel(gui, self.session, self._notify)
        self._panel.preset.on_update(lambda _: self._play_preset())
        with layers:
            for layer, described in LAYERS.items():
                self._add_layer(layer, described.meaning)
        self._publisher = threading.Thread(target=self._publish, daemon=True)

    def _arrange(self) -> list[Any]:
        """Dock the status to the right of the scene, controls to its left.

        Elements that are added outside of a tab go to the status panel. On a
        phone viser shows both panels below the scene.

        Returns:
            Tabs for the running game, the next one, and layers.
        """
        gui = self.server.gui
        gui.set_panel_label("stepaside")
        gui.main_panel.dock_right()
        gui.main_panel.set_width(STATUS_WIDTH)
        controls = gui.add_panel()
        tabs = [
            controls.add_tab(name) for name in ("Play", "Settings", "Layers")
        ]
        controls.dock_left()
        controls.set_width(CONTROL_WIDTH)
        return tabs

    def _add_bodies(self) -> None:
        """Add the bodies of the game."""
        world, names = self.session.world, self.session.names
        self._bodies = SceneBodies(
            self.server.scene, world.model, world.data, names
        )
        self._shown = self._stage()
        self._names.content = names_text(self.session.colours)

    def _stage(self) -> tuple[Any, ...]:
        """Return what decides which bodies a game has."""
        played = self.session.played
        return played.room, *(
            (own.name, own.body, own.robot) for own in played.players
        )

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
        """Add buttons of game, speed and camera, and their keys."""
        gui, session, viewers = self.server.gui, self.session, self._viewers
        self._play = gui.add_button("Start", hint="Key: space.")
        actions = {
            "step": self._step,
            "reset": self._reset,
            "save": self._save,
        }
        action = gui.add_button_group("Game", tuple(actions))
        speed = gui.add_dropdown("Speed", SPEEDS, initial_value="1")
        camera = gui.add_button_group("Camera", CAMERAS)

        def toggle(_: object) -> None:
            session.running = not session.running

        @speed.on_update
        def _(_: object) -> None:
            value = speed.value
            session.speed = inf if value == SPEEDS[-1] else float(value)

        self._play.on_click(toggle)
        action.on_click(lambda _: actions[action.value]())
        camera.on_click(lambda e: viewers.choose(e.client, camera.value))
        for label, key, call in (
            ("Play or pause", "space", toggle),
            ("Step 0.1 s", "N", lambda _: self._step()),
            ("Reset", "R", lambda _: self._reset()),
            ("Save this run", "S", lambda _: self._save()),
        ):
            command: Any = gui.add_command(label, hotkey=key)  # type: ignore[arg-type]
            command.on_trigger(call)
        for number, name in enumerate(CAMERAS, 1):
            command = gui.add_command(f"Camera: {name}", hotkey=f"{number}")  # type: ignore[arg-type]
            command.on_trigger(
                lambda e, name=name: viewers.choose(e.client, name)
            )

    def _step(self) -> None:
        """Advance a paused game by 0.1 s."""
        if not self.session.running:
            self.session.step(0.1)

    def _reset(self) -> None:
        """Start a new game with the settings of the page."""
        if self._panel.restart():
            self._drive.reset()

    def _play_preset(self) -> None:
        """Start the game of the chosen preset."""
        if self._panel.play_preset():
            self._drive.reset()

    def _save(self) -> None:
        """Write a run folder, and show its path."""
        try:
            folder = self.session.save(Path("runs"))
        except StepAsideError as error:
            self._notify(str(error))
        else:
            self._notify(f"saved; to show it: stepaside show {folder}")

    def _add_layer(self, layer: str, meaning: str) -> None:
        label, shown = layer[0].upper() + layer[1:], self._layers.shown
        box = self.server.gui.add_checkbox(label, shown[layer], hint=meaning)

        @box.on_update
        def _(_: object) -> None:
            shown[layer] = box.value

    def _publish(self) -> None:
        plotted = 0.0
        while not self._closing.is_set():
            began = perf_counter()
            try:
                self.refresh()
                if began - plotted > 1.0 / PLOT_RATE:
                    plotted = began
                    self._plots.show(self.session)
                    self._show_cameras()
            except Exception:
                LOG.exception("the page could not be refreshed")
            rest = 1.0 / RATE - (perf_counter() - began)
            watched = len(self.server.get_clients()) > 0
            sleep(max(rest, 0.001) if watched else 0.2)

    def refresh(self) -> None:
        """Show the present state of the session."""
        session = self.session
        with session.lock:  # another game may begin meanwhile
            world = session.world
            if session.generation != self._generation:
                self._generation = session.generation
                self._renew()
            positions, quaternions = (
                world.data.xpos.copy(),
                world.data.xquat.copy(),
            )
            overlays, now = live_overlays(session), world.time
            places, text = places_of(session), page_text(session)
            heights = {
                p.name: float(p.truth.position_com_in_world[2])
                for p in world.players
            }
            first = session.opponents[0] if session.opponents else ()
            colours, walls = session.colours, wall_corners(session.played.room)
        with self.server.atomic():
            self._bodies.move(positions, quaternions)
            self._layers.draw(overlays, now, places, colours)
        order = [*first, *(name for name in places if name not in first)]
        self._viewers.aim(
            [places[name] for name in order],
            [float(heights[name]) for name in order],
            walls,
        )
        self._play.label = "Pause" if session.running else "Start"
        if self._status.content != text:
            self._status.content = text
        self._drive.show()

    def _renew(self) -> None:
        """Replace bodies and camera images by those of a new game."""
        if self._shown != self._stage():
            self._bodies.remove()
            self._add_bodies()
        for handle in self._images.values():
            handle.remove()
        self._images.clear()

    def _show_cameras(self) -> None:
        """Show images that arrived since the last call."""
        with self.session.lock:
            frames = dict(self.session.history.frames)
            self.session.history.frames.clear()
            seen = bool(self.session.played.sensing_by("cameras"))
        self._cameras.visible = seen
        for label, report in frames.items():
            image = camera_picture(report)
            if label in self._images:
                self._images[label].image = image
                continue
            with self._cameras:
                self._images[label] = self.server.gui.add_image(
                    image, label=label, format="jpeg"
                )


def _add_floor(scene: viser.SceneApi) -> None:
    """Add the floor, which receives shadows."""
    scene.add_grid(
        "/floor",
        width=40.0,
        height=40.0,
        plane="xy",
        cell_size=0.5,
        section_size=1.0,
        cell_color=FLOOR_LINES,
        section_color=FLOOR_LINES,
        plane_color=FLOOR,
        plane_opacity=1.0,
        shadow_opacity=0.3,
        fade_distance=25.0,
        position=(0.0, 0.0, -0.002),
    )
