"""A run on the page, with a slider for time."""

import logging
import threading
from time import perf_counter, sleep

import numpy as np
import viser
from viser import uplot

from ...games.run import Run
from ...games.settings import PLAYERS
from ..inert import for_markdown
from ..stage import Stage
from ..style import COLOURS, EVADER, PURSUER, THEORY
from .bodies import Bodies
from .layers import HEIGHTS, Layers, chain, ring, safety_of
from .serving import open_server

LOG = logging.getLogger(__name__)
RATE = 30.0  # updates of the scene a second
REPLAYED = ("CoM trace", "line of sight", "safety area", "circle of theory")


class ReplayPage:
    """A run on a server.

    Attributes:
        server: The server.
        slider: Time of the run that is shown, in [s].
    """

    def __init__(self, run: Run, *, port: int) -> None:
        """Serve a run on this machine alone."""
        self._run, self._stage = run, Stage(run)
        self.server = open_server("127.0.0.1", port).server
        self._closing = threading.Event()
        self._playing = False
        scene, gui = self.server.scene, self.server.gui
        scene.set_up_direction("+z")
        scene.add_grid(
            "/floor", width=12.0, height=12.0, cell_size=0.25, plane="xy"
        )
        place = run.evader.torso[0]
        self.server.initial_camera.position = (
            float(place[0]) - 1.5,
            float(place[1]) - 1.6,
            1.3,
        )
        self.server.initial_camera.look_at = (*place[:2].tolist(), 0.2)
        self._bodies = Bodies(scene, self._stage.model)
        self._layers = Layers(scene)
        self._status = gui.add_markdown("")
        self._play = gui.add_button("Play")
        self.slider: viser.GuiSliderHandle[float] = gui.add_slider(
            "Time [s]",
            min=0.0,
            max=max(0.02, float(run.times[-1])),
            step=0.02,
            initial_value=0.0,
        )
        self._speed = gui.add_slider(
            "Speed", min=0.25, max=8.0, step=0.25, initial_value=1.0
        )
        with gui.add_folder("Layers"):
            for layer in REPLAYED:
                self._add_layer(layer)
        theory = run.theory
        for title, values, level, colour in (
            ("Distance [m]", run.distance, theory and theory[1], PURSUER),
            (
                "Angle between the headings [deg]",
                run.orientation,
                theory and theory[2],
                EVADER,
            ),
        ):
            thin = slice(None, None, max(1, len(run.times) // 1500))
            gui.add_uplot(
                (
                    run.times[thin],
                    values[thin],
                    np.full(len(run.times[thin]), level or np.nan),
                ),
                (
                    uplot.Series(label="time [s]"),
                    uplot.Series(label="run", stroke=colour, width=2),
                    uplot.Series(label="theory", stroke=THEORY, dash=(5, 5)),
                ),
                title=title,
                height=170,
            )

        @self._play.on_click
        def _(_: object) -> None:
            self._playing = not self._playing

        self._thread = threading.Thread(target=self._loop, daemon=True)

    def _add_layer(self, layer: str) -> None:
        box = self.server.gui.add_checkbox(layer[0].upper() + layer[1:], True)

        @box.on_update
        def _(_: object) -> None:
            self._layers.shown[layer] = box.value

    def start(self) -> None:
        """Start to show."""
        self._thread.start()

    def close(self) -> None:
        """Stop the server."""
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
                self._show(float(self.slider.value))
            except Exception:
                LOG.exception("the replay could not be shown")
            sleep(max(0.001, 1.0 / RATE - (perf_counter() - now)))

    def _show(self, time: float) -> None:
        run = self._run
        index = int(np.searchsorted(run.times, time - 1e-9))
        index = min(index, len(run.times) - 1)
        self._stage.put(index)
        data = self._stage.data
        with self.server.atomic():
            self._bodies.move(data.xpos, data.xquat)
            self._draw(index)
        self._play.label = "Pause" if self._playing else "Play"
        text = (
            f"**{for_markdown(run.name)}**: "
            f"{for_markdown(run.words(index))}\n\n{run.times[index]:.2f} s, "
            f"distance {run.distance[index]:.2f} m, between the headings "
            f"{run.orientation[index]:.0f}\u00b0"
        )
        if self._status.content != text:
            self._status.content = text

    def _draw(self, index: int) -> None:
        run, layers = self._run, self._layers
        first = max(0, index - 1500)
        places = []
        for name in PLAYERS:
            trace = run.tracks[name].com[first : index + 1 : 5, :2]
            lines = chain(trace, HEIGHTS["CoM trace"])
            layers.draw("CoM trace", name, lines, COLOURS[name])
            places.append(run.tracks[name].torso[index, :2])
        radius = run.settings.strategy.safety_radius
        layers.draw(
            "safety area", "evader", safety_of(places[1], radius), EVADER
        )
        sight = np.array([[[*places[0], 0.25], [*places[1], 0.25]]])
        layers.draw("line of sight", "both", sight, THEORY)
        if run.circle is not None:
            circle = ring(*run.circle, HEIGHTS["circle of theory"])
            layers.draw("circle of theory", "both", circle, THEORY)
