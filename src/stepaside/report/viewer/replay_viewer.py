"""Replay of a run on a served page, with a time slider."""

import logging
import threading
from time import perf_counter, sleep
from typing import Any

import numpy as np
import viser

from ...core.poses import Array
from ...games.run import Run
from ...games.run_captions import describe_state
from ..figure_style import EVADER, PURSUER, PUSHED, THEORY, colours_of
from ..landed_footsteps import footsteps_in
from ..palette import THEMES
from ..scene import RunScene
from ..text_escaping import for_markdown
from .page_layout import STATUS_WIDTH
from .page_server import open_server
from .plots import TITLES, SignalPlot, add_plot, plot_data
from .scene_bodies import SceneBodies
from .scene_layers import (
    HEIGHTS,
    SceneLayers,
    footprints_at,
    legend,
    polyline,
    push_arrows,
    ring,
    safety_ring,
)
from .viewer_clients import (
    CAMERAS,
    EVERYBODY,
    ViewerClients,
    order_in_view,
)

LOG = logging.getLogger(__name__)
RATE = 30.0  # updates of the scene per second
PLOT_SAMPLES = 1500  # of a curve, approximately
COLUMNS = {  # of the arrays of a trajectory, by the end of their names
    "com": ("x [m]", "y [m]", "z [m]"),
    "torso": ("x [m]", "y [m]", "heading [rad]"),
    "place": ("x [m]", "y [m]", "heading [rad]"),
    "reference": ("x [m]", "y [m]"),
    "zmp": ("x [m]", "y [m]"),
    "velocity": ("x [m/s]", "y [m/s]"),
    "tilt": ("roll [rad]", "pitch [rad]"),
}
REPLAY_LAYERS = (
    "CoM trace",
    "footsteps",
    "pushes",
    "line of sight",
    "safety radius",
    "theoretical circle",
)


class ReplayPage:
    """Recorded run on a server.

    Attributes:
        server: viser's server.
        slider: Slider of the time that is shown, in [s].
    """

    def __init__(self, run: Run, *, port: int) -> None:
        """Serve a run on this machine only.

        Args:
            run: The run.
            port: First port to try.
        """
        self._run = run
        self._scene = RunScene(run)
        self._footsteps = footsteps_in(run)
        self.server = open_server("127.0.0.1", port).server
        self._closing = threading.Event()
        self._playing = False
        self._set_scene()
        self._layers = SceneLayers(self.server.scene)
        self._viewers = ViewerClients(self.server, self._run.plan)
        self._add_controls()
        self._thread = threading.Thread(target=self._loop, daemon=True)

    def _set_scene(self) -> None:
        """Add lights, players and labels to the scene."""
        scene, camera = self.server.scene, self.server.initial_camera
        scene.set_up_direction("+z")
        scene.configure_default_lights(cast_shadow=True)
        starts = [track.torso[0, :2] for track in self._run.tracks.values()]
        x, y = np.mean(starts, axis=0).tolist()
        camera.position = (x - 1.5, y - 1.6, 1.3)
        camera.look_at = (x, y, 0.2)
        self._bodies = SceneBodies(scene, self._scene.model)
        self._bodies.add_labels(self._scene.model, self._run.players)

    def _add_controls(self) -> None:
        """Add status, controls and plots to the right of the scene."""
        gui = self.server.gui
        gui.set_panel_label("stepaside")
        gui.main_panel.dock_right()
        gui.main_panel.set_width(STATUS_WIDTH)
        self._status = gui.add_markdown("")
        self._play = gui.add_button("Play")
        self.slider: viser.GuiSliderHandle[float] = gui.add_slider(
            "Time [s]",
            min=0.0,
            max=max(0.02, float(self._run.times[-1])),
            step=0.02,
            initial_value=0.0,
        )
        self._speed = gui.add_slider(
            "Speed", min=0.25, max=8.0, step=0.25, initial_value=1.0
        )
        self._add_views()
        self._add_plots()
        with gui.add_folder("Layers", expand_by_default=False):
            for layer in REPLAY_LAYERS:
                self._add_layer(layer)
            gui.add_markdown(legend(REPLAY_LAYERS))

        @self._play.on_click
        def _(_: object) -> None:
            self._playing = not self._playing

    def _add_plots(self) -> None:
        """Add plots of distance and angle with the theory's values."""
        run = self._run
        _, distance, angle = run.theory or (None, None, None)
        if run.pair is not None:
            self._add_plot(TITLES[0], run.distance, distance, PURSUER)
        if run.has_orientation:
            self._add_plot(TITLES[1], run.orientation, angle, EVADER)
        self._signals = recorded_signals(run)
        self._signal = SignalPlot(self.server.gui, tuple(self._signals))
        self._signal.on_choice(self._show_signal)

    def _show_signal(self) -> None:
        """Show the chosen signal."""
        if not self._signal.label:
            self._signal.hide()
            return
        name, column = self._signals[self._signal.label]
        values = self._run.arrays()[name].reshape(len(self._run.times), -1)
        every = slice(None, None, max(1, len(values) // PLOT_SAMPLES))
        self._signal.show(
            self._run.times[every], values[every, column].astype(float)
        )

    def _add_plot(
        self, title: str, values: Array, level: float | None, colour: str
    ) -> None:
        """Add a plot of one quantity."""
        times = self._run.times
        samples = slice(None, None, max(1, len(times) // PLOT_SAMPLES))
        data = plot_data(times[samples], values[samples], level)
        add_plot(self.server.gui, title, "run", colour, data)

    def _add_views(self) -> None:
        """Add the buttons of camera and theme."""
        gui, viewers = self.server.gui, self._viewers
        single = len(self._run.players) < 2
        names = CAMERAS[:3] if single else CAMERAS
        camera = gui.add_button_group("Camera", names)
        self._follow = gui.add_dropdown(
            "Follow",
            (EVERYBODY, *(() if single else self._run.players)),
            visible=len(self._run.players) > 2,
        )
        theme = gui.add_button_group("Light", THEMES)

        @camera.on_click
        def _(event: Any) -> None:
            viewers.choose(event.client, camera.value)

        @theme.on_click
        def _(event: Any) -> None:
            viewers.set_theme(event.client, theme.value)

    def _add_layer(self, layer: str) -> None:
        box = self.server.gui.add_checkbox(layer[0].upper() + layer[1:], True)

        @box.on_update
        def _(_: object) -> None:
            self._layers.shown[layer] = box.value

    def start(self) -> None:
        """Start the thread that updates the page."""
        self._thread.start()

    def close(self) -> None:
        """Stop the updates and the server."""
        self._closing.set()
        self._thread.join(timeout=5.0)
        self.server.stop()

    def _loop(self) -> None:
        before = perf_counter()
        while not self._closing.is_set():
            now = perf_counter()
            passed, before = now - before, now
            try:
                if self._playing:
                    time = self.slider.value + passed * self._speed.value
                    end = float(self._run.times[-1])
                    self.slider.value = min(time, end)  # type: ignore[misc]
                    if time >= float(self._run.times[-1]):
                        self._playing = False
                self.show(float(self.slider.value))
            except Exception:
                LOG.exception("the replay could not be shown")
            sleep(max(0.001, 1.0 / RATE - (perf_counter() - now)))

    def show(self, time: float) -> None:
        """Show the sample of a time of the run, in [s]."""
        run = self._run
        index = run.index_at(time)
        self._scene.put(index)
        data = self._scene.data
        with self.server.atomic():
            self._bodies.move(data.xpos, data.xquat)
            self._draw(index)
        tracks = [run.tracks[name] for name in self._in_view(index)]
        self._viewers.aim(
            [track.torso[index, :2] for track in tracks],
            [float(track.com[index, 2]) for track in tracks],
        )
        self._play.label = "Pause" if self._playing else "Play"
        text = (
            f"**{for_markdown(run.name)}**: "
            f"{for_markdown(describe_state(run, index))}\n\n"
            f"{run.times[index]:.2f} s"
        )
        if run.pair is not None:
            least = "least distance" if len(run.opponents) > 1 else "distance"
            text += f", {least} {run.distance[index]:.2f} m"
        if run.has_orientation:
            angle = run.orientation[index]
            text += f", angle between the headings {angle:.0f}\u00b0"
        if self._status.content != text:
            self._status.content = text

    def _in_view(self, index: int) -> list[str]:
        """Return the players that cameras show; see order_in_view()."""
        run = self._run
        places = {n: t.torso[index, :2] for n, t in run.tracks.items()}
        return order_in_view(places, run.opponents, self._follow.value)

    def _draw(self, index: int) -> None:
        run, layers = self._run, self._layers
        first, now = max(0, index - 1500), float(run.times[index])
        colours = colours_of(run.players, run.identities)
        for name, track in run.tracks.items():
            trace = track.com[first : index + 1 : 5, :2]
            lines = polyline(trace, HEIGHTS["CoM trace"])
            layers.draw("CoM trace", name, lines, colours[name])
            prints = footprints_at(
                self._footsteps[name], run.settings.gait.sole, now
            )
            layers.draw("footsteps", name, prints, colours[name])
            layers.draw("pushes", name, push_arrows(track.pushes, now), PUSHED)
        for player, radius in run.safety_areas:
            area = safety_ring(run.tracks[player].torso[index, :2], radius)
            layers.draw("safety radius", player, area, colours[player])
        for pair in run.lines_of_sight:
            sight = [[*run.tracks[n].torso[index, :2], 0.25] for n in pair]
            owner = "-".join(pair)
            layers.draw("line of sight", owner, np.array([sight]), THEORY)
        theoretical = run.circle
        if theoretical is not None:
            circle = ring(*theoretical, HEIGHTS["theoretical circle"])
            layers.draw("theoretical circle", "both", circle, THEORY)


def recorded_signals(run: Run) -> dict[str, tuple[str, int]]:
    """Return array and column of each recorded quantity, by its label.

    Those of :class:`~stepaside.games.trajectory.Trajectory` with a row for
    every sample.
    """
    found = {}
    for name, array in run.arrays().items():
        if name == "times_s" or len(array) != len(run.times):
            continue
        count = array.reshape(len(array), -1).shape[1]
        columns = COLUMNS.get(name.rpartition("_")[2], ())
        if len(columns) < count:
            columns = tuple(str(column + 1) for column in range(count))
        for column in range(count):
            found[f"{name} {columns[column]}"] = name, column
    return found
