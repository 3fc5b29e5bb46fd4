"""Floor of the simulated world."""

from collections.abc import Sequence
from math import cos, sin

import mujoco
import numpy as np

from .physics_settings import PhysicsSettings

FLOOR_BIT = 1  # contact type of floor, walls and obstacles
TONES = (0.86, 0.86, 0.84), (0.80, 0.80, 0.78)


def tilt_gravity(spec: mujoco.MjSpec, physics: PhysicsSettings) -> None:
    """Tilt gravity instead of the floor, to simulate a slope."""
    s, c = sin(physics.slope), cos(physics.slope)
    g = float(np.linalg.norm(spec.option.gravity))
    down = physics.slope_direction
    spec.option.gravity = [g * s * cos(down), g * s * sin(down), -g * c]


def add_tiles(
    spec: mujoco.MjSpec,
    name: str,
    tones: Sequence[Sequence[float]],
    pixels: int,
    repeat: int,
    reflectance: float = 0.0,
) -> None:
    """Add a material of tiles of two tones."""
    spec.add_texture(
        name=name,
        type=mujoco.mjtTexture.mjTEXTURE_2D,
        builtin=mujoco.mjtBuiltin.mjBUILTIN_CHECKER,
        rgb1=list(tones[0]),
        rgb2=list(tones[1]),
        width=pixels,
        height=pixels,
    )
    material = spec.add_material(
        name=name,
        texrepeat=[repeat, repeat],
        texuniform=True,
        reflectance=reflectance,
    )
    material.textures[mujoco.mjtTextureRole.mjTEXROLE_RGB] = name


def add_floor(
    spec: mujoco.MjSpec,
    physics: PhysicsSettings,
    generator: np.random.Generator,
) -> None:
    """Add floor, sky and light; the generator is of an uneven floor."""
    add_tiles(spec, "floor", TONES, 256, 2, reflectance=0.05)
    spec.add_texture(
        name="sky",
        type=mujoco.mjtTexture.mjTEXTURE_SKYBOX,
        builtin=mujoco.mjtBuiltin.mjBUILTIN_GRADIENT,
        rgb1=[0.93, 0.95, 0.97],
        rgb2=[0.62, 0.72, 0.82],
        width=64,
        height=384,
    )
    uneven = physics.unevenness > 0.0
    if uneven:
        from .uneven_floor import add_heights

        add_heights(spec, physics.unevenness, generator)
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
        contype=FLOOR_BIT,
        conaffinity=0,
    )
    spec.worldbody.add_light(
        pos=[0, 0, 4],
        dir=[0.2, 0.3, -1],
        type=mujoco.mjtLightType.mjLIGHT_DIRECTIONAL,
        castshadow=True,
    )
