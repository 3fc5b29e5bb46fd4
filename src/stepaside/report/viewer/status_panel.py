"""Status of a live game: its state as text, plots over time, camera images."""

from collections.abc import Mapping
from html import escape
from math import degrees, tan
from typing import TYPE_CHECKING

import numpy as np
import viser
from viser import uplot

from ...core.poses import Array
from ...games.players import Player, RobotPlayer
from ...locomotion.locomotion import Phase
from ...perception.images import ColourImage, Pixels
from ..palette import PALETTES
from ..text_escaping import for_markdown
from .live_session import LiveSession

if TYPE_CHECKING:  # vision is an extra of its own
    from ...perception.pipeline import FrameReport

PADDING = (12, 12, 0, 0)  # for the last tick labels, in [pixels]
LAST = 1e6  # order of elements below all others
LIGHT = PALETTES["light"]
TITLES = ("Distance [m]", "Angle between the headings [deg]")
WIDTH = 240  # of a picture at least, approximately, in [pixels]
FOUND = (30, 190, 70)  # red, green and blue of detections


def phase_of(player: Player) -> Phase:
    """Return the phase of a player; a player without phases is walking."""
    if isinstance(player, RobotPlayer) and player.has_fallen:
        return Phase.FALLEN
    walk = player.maneuvers
    return Phase.WALKING if walk is None else walk.phase


def names_text(colours: Mapping[str, str]) -> str:
    """Return the names of players in their colours, in HTML."""
    names = "  ".join(
        f'<b style="color: {colour}">{escape(name)}</b>'
        for name, colour in colours.items()
    )
    return f'<div style="padding: 0.4em 0.8em 0">{names}</div>'


def page_text(session: LiveSession) -> str:
    """Return the state of a game, in Markdown; the caller holds its lock."""
    players, theory = session.world.players, session.theory
    phases: dict[Phase, list[str]] = {}
    for player in players:
        phases.setdefault(phase_of(player), []).append(player.name)
    lines = [
        f"**{phase.value}**: {', '.join(names)}"
        for phase, names in phases.items()
    ]
    if session.driven:
        lines.append(
            f"**{session.driven} driven by hand**: no theory applies."
        )
    elif theory is not None:
        lines.append(
            f"theory: a circle with distance {theory[1]:.2f} m and "
            f"{theory[2]:.0f}\u00b0 between the headings"
        )
    speed = ""
    if session.running and session.real_time_factor > 0.0:
        speed = f", {session.real_time_factor:.1f} x real time"
    lines.append(f"{session.world.time:.1f} s simulated{speed}")
    distance, closest = session.game.distance, session.history.closest
    if distance is not None:
        least = "least " if len(players) > 2 else ""
        closest = min(closest, distance)
        lines.append(
            f"{least}distance {distance:.2f} m, closest approach "
            f"{closest:.2f} m"
        )
    if session.outcome is not None:
        lines.append(f"**over: {session.outcome.value}**; reset to restart")
        lines.append(session.game.message)
    if session.error is not None:
        lines.append(f"**stopped: {for_markdown(session.error)}**")
    return "\n\n".join(lines)


class Plots:
    """Plots of a live game: distance, and the angle of a duel."""

    def __init__(self, gui: viser.GuiApi) -> None:
        """Start without plots; they come below all other elements."""
        self._gui = gui
        self._plots: dict[str, viser.GuiUplotHandle] = {}

    def show(self, session: LiveSession) -> None:
        """Show the history of a session."""
        with session.lock:
            rows = np.array(session.history.history).reshape(-1, 3)
        if len(rows) < 2:
            return
        theory = session.theory or (None, None, None)
        for column, title in enumerate(TITLES, 1):
            # uPlot cannot draw NaN.
            data = tuple(rows[np.isfinite(rows[:, column])][:, [0, column]].T)
            level = theory[column]
            if level is not None:
                data = (*data, np.full(len(data[0]), level))
            plot = self._plots.get(title)
            if plot is not None and len(plot.data) == len(data):
                plot.data = data
                continue
            if plot is not None:  # the number of lines of a plot is fixed
                plot.remove()
                del self._plots[title]
            if len(data[0]):
                self._plots[title] = self._add(title, data, column)

    def _add(
        self, title: str, data: tuple[Array, ...], number: int
    ) -> viser.GuiUplotHandle:
        """Add a plot: times, values, and the theory's value if it is known."""
        series = (
            uplot.Series(label="time [s]"),
            uplot.Series(label=title, stroke=LIGHT.mean, width=2),
            uplot.Series(label="theory", stroke=LIGHT.theory, dash=(5, 5)),
        )
        return self._gui.add_uplot(
            data,
            series[: len(data)],
            title=title,
            height=125,
            padding=PADDING,
            order=LAST + number,
            # uPlot takes seconds for dates by default.
            scales={"x": uplot.Scale(time=False)},
        )


def camera_picture(report: "FrameReport") -> Pixels:
    """Return an enlarged image with a line in every detected direction.

    Depth is shown as brightness, missing values are black. Shape (height,
    width, 3).
    """
    image = report.image
    if isinstance(image, ColourImage):
        pixels = image.pixels
    else:
        depth = np.clip(image.depths / image.far, 0.0, 1.0)
        grey = np.where(image.depths > 0.0, 255.0 * (1.0 - 0.85 * depth), 0.0)
        pixels = np.repeat(grey.astype(np.uint8)[:, :, None], 3, axis=2)
    scale = max(1, WIDTH // pixels.shape[1])
    large = np.kron(pixels, np.ones((scale, scale, 1), dtype=np.uint8))
    camera, half = image.camera, max(1, large.shape[1] // 240)
    for azimuth in report.azimuths:
        column = 0.5 * camera.width - camera.focal_x * tan(azimuth)
        at = int(scale * column)
        if abs(degrees(azimuth)) < 80.0 and 0 <= at < large.shape[1]:
            large[:, max(0, at - half) : at + half + 1] = FOUND
    return large
