"""Floor of the simulated world: slope, friction and unevenness."""

from math import cos, sin

import mujoco
import numpy as np

from .physics_settings import PhysicsSettings

HALF_SIDE = 4.0  # of an uneven floor, in [m]
GRAIN = 0.1  # spacing of independent heights of an uneven floor, in [m]
CELLS = 2  # grid cells per grain


def tilt_gravity(spec: mujoco.MjSpec, physics: PhysicsSettings) -> None:
    """Tilt gravity instead of the floor, to simulate a slope."""
    s, c = sin(physics.slope), cos(physics.slope)
    g = float(np.linalg.norm(spec.option.gravity))
    down = physics.slope_direction
    spec.option.gravity = [g * s * cos(down), g * s * sin(down), -g * c]


def add_floor(
    spec: mujoco.MjSpec,
    physics: PhysicsSettings,
    generator: np.random.Generator,
    bit: int,
) -> None:
    """Add floor, sky and light.

    Args:
        spec: Specification of the world.
        physics: Friction and unevenness.
        generator: Random generator of the heights of an uneven floor.
        bit: Contact type of the floor.
    """
    spec.add_texture(
        name="floor",
        type=mujoco.mjtTexture.mjTEXTURE_2D,
        builtin=mujoco.mjtBuiltin.mjBUILTIN_CHECKER,
        rgb1=[0.86, 0.86, 0.84],
        rgb2=[0.80, 0.80, 0.78],
        width=256,
        height=256,
    )
    spec.add_texture(
        name="sky",
        type=mujoco.mjtTexture.mjTEXTURE_SKYBOX,
        builtin=mujoco.mjtBuiltin.mjBUILTIN_GRADIENT,
        rgb1=[0.93, 0.95, 0.97],
        rgb2=[0.62, 0.72, 0.82],
        width=64,
        height=384,
    )
    floor = spec.add_material(
        name="floor", texrepeat=[2, 2], texuniform=True, reflectance=0.05
    )
    floor.textures[mujoco.mjtTextureRole.mjTEXROLE_RGB] = "floor"
    uneven = physics.unevenness > 0.0
    if uneven:
        _add_heights(spec, physics.unevenness, generator)
    spec.worldbody.add_geom(
        name="floor",
        type=(
            mujoco.mjtGeom.mjGEOM_HFIELD
            if uneven
            else mujoco.mjtGeom.mjGEOM_PLANE
        ),
        size=[20, 20, 0.1],
        hfieldname="floor" if uneven else "",
        material="floor",
        friction=[physics.friction, 0.005, 0.0001],
        contype=bit,
        conaffinity=0,
    )
    spec.worldbody.add_light(
        pos=[0, 0, 4],
        dir=[0.2, 0.3, -1],
        type=mujoco.mjtLightType.mjLIGHT_DIRECTIONAL,
        castshadow=True,
    )


def _add_heights(
    spec: mujoco.MjSpec, unevenness: float, generator: np.random.Generator
) -> None:
    """Add a height field, random at every grain and linear in between."""
    from scipy.ndimage import zoom  # slow to import, rarely needed

    grains = round(2.0 * HALF_SIDE / GRAIN) + 1
    coarse = generator.uniform(0.0, 1.0, (grains, grains))
    heights = np.clip(zoom(coarse, CELLS, order=1), 0.0, 1.0)
    spec.add_hfield(
        name="floor",
        size=[HALF_SIDE, HALF_SIDE, unevenness, 0.1],
        nrow=heights.shape[0],
        ncol=heights.shape[1],
        userdata=heights.astype(np.float32).ravel().tolist(),
    )
