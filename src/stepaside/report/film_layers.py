"""Lines that are drawn into a film."""

import mujoco
import numpy as np

from ..games.run import Run
from ..games.settings import PLAYERS
from ..poses import Array
from .style import COLOURS, EVADER, THEORY

THICK = 0.005  # of a line, in [m]
PRINT = (0.045, 0.025)  # half sizes of a footprint, in [m]


def decorate(
    scene: mujoco.MjvScene, *, run: Run, index: int, trail: float
) -> None:
    """Add traces, footprints, line of sight, safety area and circle.

    Args:
        scene: Scene to add to.
        run: The run.
        index: Sample that is drawn.
        trail: How long traces are, in [s].
    """
    now = float(run.times[index])
    first = int(np.searchsorted(run.times, now - trail))
    every = max(1, (index - first) // 120)
    for name in PLAYERS:
        com = run.tracks[name].com[first : index + 1 : every, :2]
        _lines(scene, com, 0.004, COLOURS[name])
        landings = run.tracks[name].landings
        if landings is None:
            continue
        shown = landings[
            (landings[:, 0] <= now + 0.5) & (landings[:, 0] > now - trail)
        ]
        for _, _, x, y, heading in shown.tolist():
            _print(scene, x, y, heading, COLOURS[name])
    places = [run.tracks[n].torso[index, :2] for n in PLAYERS]
    sight = np.array([[*places[0], 0.25], [*places[1], 0.25]])
    _line(scene, sight[0], sight[1], 0.5 * THICK, THEORY)
    radius = run.settings.strategy.safety_radius
    _lines(scene, _ring(places[1], radius), 0.003, EVADER)
    if run.circle is not None:
        x, y, size = run.circle
        _lines(scene, _ring(np.array([x, y]), size), 0.002, THEORY)


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
    if scene.ngeom >= scene.maxgeom:
        return
    geom = scene.geoms[scene.ngeom]
    kind = mujoco.mjtGeom.mjGEOM_CAPSULE
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


def _rgba(colour: str, opacity: float = 1.0) -> Array:
    parts = [part / 255.0 for part in bytes.fromhex(colour[1:])]
    return np.array([*parts, opacity], dtype=np.float32)
