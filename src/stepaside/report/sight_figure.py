"""Film strip of what the robots saw, and how far off they were."""

from math import degrees
from pathlib import Path
from typing import Any

import cv2
import numpy as np

from ..core.poses import Array, wrap_angles
from ..games.duel_run import DuelRun
from ..games.run import Run
from ..games.sight_evaluation import EvaluatedImage
from ..games.trajectory import Trajectory
from ..perception.images import ColourImage, DepthImage, Pixels
from .figure_sizes import sheet
from .figure_style import THEORY, colours_of, new_figure, save
from .sole_outlines import draw_heading

FOUND = (30, 170, 60)  # red, green and blue of what was detected
TRUE = (235, 0, 190)  # of where the other truly is
SCALE = 3  # by which depth images are enlarged


def draw_sight(run: Run, path: Path) -> None:
    """Write the film strip of a duel with cameras.

    Args:
        run: The duel.
        path: File, of a format that its suffix tells.
    """
    rows = _rows(run)
    count = max(1, *(len(run.stills[name][kind]) for name, kind, _ in rows))
    ratios = [1.0] * len(rows) + [1.1, 0.8, 0.8]
    height = 1.86 * sum(ratios)
    figure = new_figure(2.45 * count, height)
    grid = figure.add_gridspec(len(ratios), count, height_ratios=ratios)
    for row, (name, kind, label) in enumerate(rows):
        for column, still in enumerate(run.stills[name][kind]):
            axes = figure.add_subplot(grid[row, column])
            axes.imshow(picture(still))
            axes.set(xticks=[], yticks=[])
            axes.grid(visible=False)
            if row == 0:
                axes.set_title(f"{still.report.image.time:.1f} s")
            if column == 0:
                axes.set_ylabel(label)
    first, kind, _ = rows[0]
    for column, still in enumerate(run.stills[first][kind]):
        axes = figure.add_subplot(grid[len(rows), column])
        _draw_top(axes, run, still.report.image.time)
    _draw_errors(figure, grid, run)
    figure.suptitle(
        f"What the robots saw, seed {run.settings.seed}: detections in "
        "green, the true direction as a tick",
    )
    save(figure, path)


def _rows(run: Run) -> list[tuple[str, str, str]]:
    """Player, camera and label of each row of pictures."""
    rows = []
    for name, stills in run.stills.items():
        if stills["colour"] or not stills["depth"]:
            rows.append((name, "colour", f"{name} sees"))
        if stills["depth"]:
            said = "its" if stills["colour"] else f"{name}'s"
            rows.append((name, "depth", f"{said} depth"))
    return rows


def picture(still: EvaluatedImage) -> Pixels:
    """Image with what was detected drawn in. Shape (height, width, 3)."""
    image = still.report.image
    if isinstance(image, ColourImage):
        canvas = image.pixels.copy()
        found = still.report.colour
        if found is not None:
            corner = int(found.left), int(found.top)
            other = int(found.right), int(found.bottom)
            cv2.rectangle(canvas, corner, other, FOUND, 2)
            middle = int(found.column)
            cv2.line(canvas, (middle, corner[1]), (middle, other[1]), FOUND, 2)
        scale = 1
    else:
        canvas, scale = _depth_picture(still, image), SCALE
    camera = image.camera
    truth = 0.5 * camera.width - camera.focal_x * np.tan(still.azimuth)
    if abs(degrees(still.azimuth)) < 80.0:
        at = int(np.clip(scale * truth, -1e4, 1e4))
        bottom = canvas.shape[0] - 1
        cv2.line(canvas, (at, bottom), (at, bottom - 14), TRUE, 2)
    return canvas


def _depth_picture(still: EvaluatedImage, image: DepthImage) -> Pixels:
    """Depth as brightness, what came back not at all in black."""
    share = np.clip(image.depths / image.far, 0.0, 1.0)
    grey = np.where(image.depths > 0.0, 255.0 - 190.0 * share, 0.0)
    small = np.repeat(grey.astype(np.uint8)[..., None], 3, axis=2)
    canvas = np.repeat(np.repeat(small, SCALE, axis=0), SCALE, axis=1)
    canvas = np.ascontiguousarray(canvas)
    scene = still.report.depth
    if scene is None:
        return canvas
    height = canvas.shape[0]
    for thing in scene.obstacles:
        half = 0.5 * thing.width / thing.nearest
        left, right = _columns(image, thing.azimuth, half)
        cv2.rectangle(canvas, (left, 4), (right, height - 5), FOUND, 2)
    for shadow in scene.shadows:
        left, right = _columns(image, shadow.azimuth, 0.5 * shadow.width)
        # Too near to be measured: a bracket, not a box.
        cv2.line(canvas, (left, 8), (right, 8), FOUND, 3)
        cv2.line(canvas, (left, 8), (left, 26), FOUND, 2)
        cv2.line(canvas, (right, 8), (right, 26), FOUND, 2)
    return canvas


def _columns(
    image: DepthImage, azimuth: float, half: float
) -> tuple[int, int]:
    camera = image.camera
    columns = [
        SCALE * (0.5 * camera.width - camera.focal_x * np.tan(angle))
        for angle in (azimuth + half, azimuth - half)
    ]
    return int(columns[0]), int(columns[1])


def _draw_top(axes: Any, run: Run, time: float) -> None:
    """Top view at a time, with the way so far."""
    times = run.times
    index = min(int(np.searchsorted(times, time)), len(times) - 1)
    for name, colour in colours_of(run.players).items():
        track = run.tracks[name]
        way = track.torso[: index + 1]
        axes.plot(way[:, 0], way[:, 1], color=colour, lw=1.0)
        draw_heading(axes, way[-1], colour, 0.28)
        _draw_belief(axes, track, colour, time, way[-1])
    every = np.concatenate([t.torso[:, :2] for t in run.tracks.values()])
    for thing in run.things:
        axes.plot(thing.x, thing.y, "s", color="#888888", ms=5)
    low, high = every.min(axis=0) - 0.3, every.max(axis=0) + 0.3
    axes.set(xlim=(low[0], high[0]), ylim=(low[1], high[1]), aspect="equal")
    axes.tick_params(labelsize=sheet().font - 2.0)


def _draw_belief(
    axes: Any, track: Trajectory, colour: str, time: float, torso: Array
) -> None:
    """Line from a robot to where it believes the other is."""
    rows = track.sight
    if rows is None or not len(rows):
        return
    row = rows[min(int(np.searchsorted(rows[:, 0], time)), len(rows) - 1)]
    _, bearing, distance = row[:3]
    if not np.isfinite(bearing):
        return
    angle = torso[2] + bearing
    end = torso[:2] + distance * np.array([np.cos(angle), np.sin(angle)])
    axes.plot(
        [torso[0], end[0]],
        [torso[1], end[1]],
        color=colour,
        lw=0.8,
        ls="--",
    )


def _draw_errors(figure: Any, grid: Any, run: Run) -> None:
    """Bearing and distance against the truth, over time."""
    upper = figure.add_subplot(grid[-2, :])
    lower = figure.add_subplot(grid[-1, :], sharex=upper)
    for name, colour in colours_of(run.players).items():
        rows = run.tracks[name].sight
        if rows is None:
            continue
        off = np.degrees(wrap_angles(rows[:, 1] - rows[:, 3]))
        upper.plot(rows[:, 0], off, color=colour, lw=0.7, label=name)
        away = rows[:, 2] - rows[:, 4]
        lower.plot(rows[:, 0], away, color=colour, lw=0.7, label=name)
    for axes, label, limit in (
        (upper, "bearing error [deg]", 8.0),
        (lower, "distance error [m]", 0.2),
    ):
        axes.axhline(0.0, color=THEORY, lw=0.6)
        axes.set(ylabel=label, ylim=(-limit, limit))
    since = run.summary.triggered_at_s if isinstance(run, DuelRun) else None
    if since is not None:
        upper.axvline(
            since, color=THEORY, ls=":", lw=1.0, label="evasion begins"
        )
    upper.legend(loc="lower right", bbox_to_anchor=(1.0, 0.97), ncols=3)
    lower.set_xlabel("time [s]")
