"""Layers of a film: traces, footprints, pushes, rings and line of sight."""

from collections.abc import Mapping
from functools import cache
from math import hypot

import mujoco
import numpy as np

from ..core.poses import Array
from ..games.run import Run
from .figure_style import PUSHED, THEORY, colours_of

LINE_WIDTH = 0.005  # half width, in [m]
TRACE_POINTS = 80  # of a trace, approximately
LIGHT_DISTANCE = 4.0  # from a light to its target, in [m]
PUSH_HEIGHT = 0.3  # of an arrow over the floor, in [m]
PUSH_LENGTH = 0.25  # of an arrow, in [m] per [N s]
PUSH_SHOWN = 1.0  # time for which an arrow is shown, in [s]
FOOTPRINT = (0.045, 0.025)  # half sizes, in [m]


def add_layers(
    scene: mujoco.MjvScene,
    *,
    run: Run,
    footsteps: Mapping[str, Array],
    index: int,
    trail: float,
) -> None:
    """Add traces, footprints, pushes, line of sight and rings to a scene.

    Args:
        scene: Scene to add to.
        run: The run.
        footsteps: Rows (time [s], side, x [m], y [m], heading [rad]) by
            player; see :func:`.landed_footsteps.footsteps_in`.
        index: Sample that is drawn.
        trail: Duration of the traces, in [s].
    """
    now = float(run.times[index])
    first = int(np.searchsorted(run.times, now - trail))
    every = max(1, (index - first) // TRACE_POINTS)
    for name, colour in colours_of(run.players, run.identities).items():
        track = run.tracks[name]
        com = track.com[first : index + 1 : every, :2]
        _add_lines(scene, com, 0.004, colour)
        _add_pushes(scene, track.pushes, now)
        landed = footsteps[name]
        shown = landed[
            (landed[:, 0] <= now + 0.5) & (landed[:, 0] > now - trail)
        ]
        for _, _, x, y, heading in shown.tolist():
            _add_footprint(scene, x, y, heading, colour)
    for pair in run.lines_of_sight:
        one, other = (
            np.array([*run.tracks[n].torso[index, :2], 0.25]) for n in pair
        )
        _add_line(scene, one, other, 0.5 * LINE_WIDTH, THEORY)
    for player, radius in run.safety_areas:
        center = run.tracks[player].torso[index, :2]
        colour = colours_of(run.players, run.identities)[player]
        _add_lines(scene, _ring(center, radius), 0.003, colour)
    if run.circle is not None:
        x, y, radius = run.circle
        _add_lines(scene, _ring(np.array([x, y]), radius), 0.002, THEORY)


def aim_light(scene: mujoco.MjvScene, target: Array) -> None:
    """Move the lights that cast shadows so that they shine on a target.

    Args:
        scene: Scene with the lights of the model.
        target: Center of the shadows, in [m]. Shape (3,).
    """
    for light in scene.lights[: scene.nlight]:
        if light.castshadow:
            light.pos[:] = target - LIGHT_DISTANCE * np.asarray(light.dir)


def _add_pushes(
    scene: mujoco.MjvScene, pushes: Array | None, now: float
) -> None:
    """Add arrows of the pushes of the last second."""
    for time, _, x, y, *impulse in () if pushes is None else pushes.tolist():
        if 0.0 <= now - time < PUSH_SHOWN:
            tip = np.array([x, y, PUSH_HEIGHT])
            start = tip - [*(PUSH_LENGTH * np.array(impulse)), 0.0]
            _add_arrow(scene, start, tip, 3.0 * LINE_WIDTH, PUSHED)


def _ring(center: Array, radius: float) -> Array:
    angle = np.linspace(0.0, 2.0 * np.pi, 61)
    ring: Array = center + radius * np.column_stack(
        [np.cos(angle), np.sin(angle)]
    )
    return ring


def _add_lines(
    scene: mujoco.MjvScene, points: Array, height: float, colour: str
) -> None:
    raised = np.column_stack([points, np.full(len(points), height)])
    for a, b in zip(raised[:-1], raised[1:], strict=True):
        _add_line(scene, a, b, LINE_WIDTH, colour)


def _add_line(
    scene: mujoco.MjvScene, a: Array, b: Array, width: float, colour: str
) -> None:
    """Add a line as a bar, which has far fewer vertices than a capsule."""
    x, y, z = (b - a).tolist()
    length = hypot(x, y, z)
    if scene.ngeom >= scene.maxgeom or length < 1e-9:
        return
    mujoco.mjv_initGeom(
        scene.geoms[scene.ngeom],
        mujoco.mjtGeom.mjGEOM_BOX,
        np.array([width, 0.3 * width, 0.5 * length]),
        0.5 * (a + b),
        rotation_along(x / length, y / length, z / length),
        _rgba(colour),
    )
    scene.ngeom += 1


def rotation_along(x: float, y: float, z: float) -> Array:
    """Return a rotation whose third axis is a unit vector.

    Its first axis is horizontal unless the vector is nearly vertical.
    Computed with scalars, since an image has hundreds of lines.

    Args:
        x: First component of the unit vector.
        y: Second component.
        z: Third component.

    Returns:
        Rotation matrix, row by row. Shape (9,).
    """
    if abs(z) < 0.9:
        level = hypot(x, y)
        a, b, c = -y / level, x / level, 0.0
    else:
        steep = hypot(y, z)
        a, b, c = 0.0, -z / steep, y / steep
    first_row = (a, y * c - z * b, x)
    second_row = (b, z * a - x * c, y)
    third_row = (c, x * b - y * a, z)
    return np.array([*first_row, *second_row, *third_row])


def _add_arrow(
    scene: mujoco.MjvScene, a: Array, b: Array, width: float, colour: str
) -> None:
    if scene.ngeom >= scene.maxgeom:
        return
    geom, kind = scene.geoms[scene.ngeom], mujoco.mjtGeom.mjGEOM_ARROW
    mujoco.mjv_initGeom(
        geom, kind, np.zeros(3), np.zeros(3), np.eye(3).ravel(), _rgba(colour)
    )
    mujoco.mjv_connector(geom, kind, width, a, b)
    scene.ngeom += 1


def _add_footprint(
    scene: mujoco.MjvScene, x: float, y: float, heading: float, colour: str
) -> None:
    if scene.ngeom >= scene.maxgeom:
        return
    c, s = np.cos(heading), np.sin(heading)
    rotation = np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]])
    mujoco.mjv_initGeom(
        scene.geoms[scene.ngeom],
        mujoco.mjtGeom.mjGEOM_BOX,
        np.array([*FOOTPRINT, 0.0015]),
        np.array([x + 0.02 * c, y + 0.02 * s, 0.0015]),
        rotation.ravel(),
        _rgba(colour, 0.55),
    )
    scene.ngeom += 1


@cache
def _rgba(colour: str, opacity: float = 1.0) -> Array:
    parts = [part / 255.0 for part in bytes.fromhex(colour[1:])]
    return np.array([*parts, opacity], dtype=np.float32)
