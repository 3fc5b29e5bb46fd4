"""Lines that are drawn into a film."""

from functools import cache
from math import hypot

import mujoco
import numpy as np

from ..core.poses import Array
from ..games.run import Run
from .figure_style import PUSHED, THEORY, colours_of

THICK = 0.005  # of a line, in [m]
POINTS = 80  # of a trace, at most about
LIGHT_AWAY = 4.0  # of a light from what it shines on, in [m]
PUSH_HEIGHT = 0.3  # of an arrow over the floor, in [m]
PUSH_LENGTH = 0.25  # in [m] per [N s]
PUSH_SHOWN = 1.0  # how long it is seen, in [s]
PRINT = (0.045, 0.025)  # half sizes of a footprint, in [m]


def decorate(
    scene: mujoco.MjvScene, *, run: Run, index: int, trail: float
) -> None:
    """Add traces, footprints, pushes, line of sight, areas and circle.

    Args:
        scene: Scene to add to.
        run: The run.
        index: Sample that is drawn.
        trail: How long traces are, in [s].
    """
    now = float(run.times[index])
    first = int(np.searchsorted(run.times, now - trail))
    every = max(1, (index - first) // POINTS)
    for name, colour in colours_of(run.players).items():
        track = run.tracks[name]
        com = track.com[first : index + 1 : every, :2]
        _lines(scene, com, 0.004, colour)
        _pushes(scene, track.pushes, now)
        landings = track.landings
        if landings is None:
            continue
        shown = landings[
            (landings[:, 0] <= now + 0.5) & (landings[:, 0] > now - trail)
        ]
        for _, _, x, y, heading in shown.tolist():
            _print(scene, x, y, heading, colour)
    if run.pair is not None:
        one, other = (
            np.array([*track.torso[index, :2], 0.25]) for track in run.pair
        )
        _line(scene, one, other, 0.5 * THICK, THEORY)
    if run.safety is not None:
        who, radius = run.safety
        place = run.tracks[who].torso[index, :2]
        colour = colours_of(run.players)[who]
        _lines(scene, _ring(place, radius), 0.003, colour)
    if run.circle is not None:
        x, y, size = run.circle
        _lines(scene, _ring(np.array([x, y]), size), 0.002, THEORY)


def light_up(scene: mujoco.MjvScene, target: Array) -> None:
    """Let the light that casts shadows shine on what is looked at.

    Args:
        scene: Whose lights lie where the model has them.
        target: Middle of what has shadows, in [m]. Shape (3,).
    """
    for light in scene.lights[: scene.nlight]:
        if light.castshadow:
            light.pos[:] = target - LIGHT_AWAY * np.asarray(light.dir)


def _pushes(scene: mujoco.MjvScene, pushes: Array | None, now: float) -> None:
    """Arrows of the pushes of the last second."""
    for time, _, x, y, *impulse in () if pushes is None else pushes.tolist():
        if 0.0 <= now - time < PUSH_SHOWN:
            way = PUSH_LENGTH * np.array(impulse)
            end = np.array([x, y, PUSH_HEIGHT])
            start = end - [*way, 0.0]
            _arrow(scene, start, end, 3.0 * THICK, PUSHED)


def _ring(center: Array, radius: float) -> Array:
    angle = np.linspace(0.0, 2.0 * np.pi, 61)
    ring: Array = center + radius * np.column_stack(
        [np.cos(angle), np.sin(angle)]
    )
    return ring


def _lines(
    scene: mujoco.MjvScene, points: Array, height: float, colour: str
) -> None:
    raised = np.column_stack([points, np.full(len(points), height)])
    for a, b in zip(raised[:-1], raised[1:], strict=True):
        _line(scene, a, b, THICK, colour)


def _line(
    scene: mujoco.MjvScene, a: Array, b: Array, width: float, colour: str
) -> None:
    """Add a square bar, of far fewer corners than a round one."""
    x, y, z = (b - a).tolist()
    long = hypot(x, y, z)
    if scene.ngeom >= scene.maxgeom or long < 1e-9:
        return
    mujoco.mjv_initGeom(
        scene.geoms[scene.ngeom],
        mujoco.mjtGeom.mjGEOM_BOX,
        np.array([width, 0.3 * width, 0.5 * long]),
        0.5 * (a + b),
        turn_along(x / long, y / long, z / long),
        _rgba(colour),
    )
    scene.ngeom += 1


def turn_along(x: float, y: float, z: float) -> Array:
    """Rotation of a bar whose third axis lies along a unit vector.

    Its first axis lies flat on the floor, whichever way the bar lies there;
    in plain numbers, since a film has hundreds of bars in each picture.

    Returns:
        Rows of the matrix, one after another. Shape (9,).
    """
    if abs(z) < 0.9:
        flat = hypot(x, y)
        right, up, over = -y / flat, x / flat, 0.0
    else:
        steep = hypot(y, z)
        right, up, over = 0.0, -z / steep, y / steep
    rows = (
        *(right, y * over - z * up, x),
        *(up, z * right - x * over, y),
        *(over, x * up - y * right, z),
    )
    return np.array(rows)


def _arrow(
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


def _print(
    scene: mujoco.MjvScene, x: float, y: float, heading: float, colour: str
) -> None:
    if scene.ngeom >= scene.maxgeom:
        return
    c, s = np.cos(heading), np.sin(heading)
    turn = np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]])
    mujoco.mjv_initGeom(
        scene.geoms[scene.ngeom],
        mujoco.mjtGeom.mjGEOM_BOX,
        np.array([*PRINT, 0.0015]),
        np.array([x + 0.02 * c, y + 0.02 * s, 0.0015]),
        turn.ravel(),
        _rgba(colour, 0.55),
    )
    scene.ngeom += 1


@cache
def _rgba(colour: str, opacity: float = 1.0) -> Array:
    parts = [part / 255.0 for part in bytes.fromhex(colour[1:])]
    return np.array([*parts, opacity], dtype=np.float32)
