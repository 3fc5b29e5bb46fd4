"""Lines over the scene of a film, as thin bars, and its lights."""

from collections.abc import Iterable, Mapping
from functools import cache

import mujoco
import numpy as np

from ..core.player_colours import from_hex
from ..core.poses import Array
from .overlays import SceneLines

HALF_WIDTH = 0.0025  # of a line, in [m]
TRAIL = 20.0  # time for which paths and footsteps remain, in [s]
LIGHT_DISTANCE = 4.0  # from a light to its target, in [m]
GEOMS = mujoco.mjtGeom


def add_layers(
    scene: mujoco.MjvScene,
    overlays: Iterable[SceneLines],
    now: float,
    places: Mapping[str, Array],
    colours: Mapping[str, str],
) -> None:
    """Add lines of a time, in [s], to a scene.

    Places are the positions of the players then, in [m], by name.
    """
    for overlay in overlays:
        rgba = _rgba(overlay.colour("light", colours))
        for start, end in overlay.shown(now, places, TRAIL):
            if scene.ngeom < scene.maxgeom:
                _add_bar(scene.geoms[scene.ngeom], start, end, rgba)
                scene.ngeom += 1


def _add_bar(
    geom: mujoco.MjvGeom, start: Array, end: Array, rgba: Array
) -> None:
    """Make a geom a bar, which has far fewer vertices than a cylinder."""
    none, upright = np.zeros(3), np.eye(3).ravel()
    mujoco.mjv_initGeom(geom, GEOMS.mjGEOM_CYLINDER, none, none, upright, rgba)
    mujoco.mjv_connector(geom, GEOMS.mjGEOM_CYLINDER, HALF_WIDTH, start, end)
    geom.type = GEOMS.mjGEOM_BOX


@cache
def _rgba(colour: str) -> Array:
    return np.array([*from_hex(colour), 1.0], dtype=np.float32)


def aim_light(scene: mujoco.MjvScene, target: Array) -> None:
    """Move the lights that cast shadows so that they shine on a target."""
    for light in scene.lights[: scene.nlight]:
        if light.castshadow:
            light.pos[:] = target - LIGHT_DISTANCE * np.asarray(light.dir)
