"""Film strip of the robots' camera images, with sighting errors."""

from math import degrees
from pathlib import Path
from typing import Any

import cv2
import numpy as np

from ..core.poses import Array, wrap_angles
from ..games.run import Run, is_duel
from ..games.sight_evaluation import EvaluatedImage
from ..games.trajectory import Trajectory
from ..perception.images import ColourImage, DepthImage, Pixels
from .figure_sizes import sheet
from .figure_style import THEORY, colours_of, new_figure, save
from .sole_outlines import draw_heading

FOUND = (30, 170, 60)  # red, green and blue of detections
TRUE = (235, 0, 190)  # of the true bearing of the opponent
SCALE = 3  # factor by which depth images are enlarged


def draw_sight(run: Run, path: Path) -> None:
    """Write the film strip of a duel with cameras.

    Args:
        run: The duel.
        path: File to write; its suffix gives the format.
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
        f"{run.title}, camera images: detections green, true bearing magenta",
    )
    save(figure, path)


def _rows(run: Run) -> list[tuple[str, str, str]]:
    """Return player, camera and label of each row of images."""
    rows = []
    for name, stills in run.stills.items():
        if stills["colour"] or not stills["depth"]:
            rows.append((name, "colour", f"{name}'s camera"))
        if stills["depth"]:
            rows.append((name, "depth", f"{name}'s depth"))
    return rows


def picture(still: EvaluatedImage) -> Pixels:
    """Return an image with its detections. Shape (height, width, 3)."""
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
    """Return depth as brightness, with missing values black."""
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
        # An opponent below the least depth is drawn as a bracket.
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
    """Draw the top view at a time, with the paths so far."""
    times = run.times
    index = min(int(np.searchsorted(times, time)), len(times) - 1)
    for name, colour in colours_of(run.players, run.identities).items():
        track = run.tracks[name]
        path = track.torso[: index + 1]
        axes.plot(path[:, 0], path[:, 1], color=colour, lw=1.0)
        draw_heading(axes, path[-1], colour, 0.28)
        _draw_sighting(axes, track, colour, time, path[-1])
    every = np.concatenate([t.torso[:, :2] for t in run.tracks.values()])
    for thing in run.things:
        axes.plot(thing.x, thing.y, "s", color="#888888", ms=5)
    low, high = every.min(axis=0) - 0.3, every.max(axis=0) + 0.3
    axes.set(xlim=(low[0], high[0]), ylim=(low[1], high[1]), aspect="equal")
    axes.tick_params(labelsize=sheet().font - 2.0)


def _draw_sighting(
    axes: Any, track: Trajectory, colour: str, time: float, torso: Array
) -> None:
    """Draw a line from a robot to the estimated position of its opponent."""
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
    """Draw the errors of bearing and distance over time."""
    upper = figure.add_subplot(grid[-2, :])
    lower = figure.add_subplot(grid[-1, :], sharex=upper)
    for name, colour in colours_of(run.players, run.identities).items():
        rows = run.tracks[name].sight
        if rows is None:
            continue
        bearing = np.degrees(wrap_angles(rows[:, 1] - rows[:, 3]))
        upper.plot(rows[:, 0], bearing, color=colour, lw=0.7, label=name)
        distance = rows[:, 2] - rows[:, 4]
        lower.plot(rows[:, 0], distance, color=colour, lw=0.7, label=name)
    for axes, label, limit in (
        (upper, "bearing error [deg]", 8.0),
        (lower, "distance error [m]", 0.2),
    ):
        axes.axhline(0.0, color=THEORY, lw=0.6)
        axes.set(ylabel=label, ylim=(-limit, limit))
    since = run.summary.triggered_at_s if is_duel(run) else None
    if since is not None:
        upper.axvline(
            since, color=THEORY, ls=":", lw=1.0, label="evasion begins"
        )
    upper.legend(loc="lower right", bbox_to_anchor=(1.0, 0.97), ncols=3)
    lower.set_xlabel("time [s]")
