"""A floor with robots on it, in MuJoCo."""

from collections.abc import Callable, Mapping, Sequence
from math import cos, sin

import mujoco
import numpy as np

from ..poses import Pose
from ..robots.description import RobotDescription
from .settings import PhysicsSettings

FLOOR_BIT = 1
COLOURS = {
    "pursuer": (0.80, 0.16, 0.14, 1.0),
    "evader": (0.10, 0.36, 0.75, 1.0),
}


def build_model(
    robots: Mapping[str, RobotDescription],
    physics: PhysicsSettings,
    furnish: Callable[[mujoco.MjSpec], None] | None = None,
) -> mujoco.MjModel:
    """Compile a floor and robots that collide with it and each other.

    Args:
        robots: Robots by name; the names become prefixes, as in
            ``pursuer/torso``.
        physics: Time step and friction.
        furnish: Puts more into the world, once the robots are in it.
    """
    spec = mujoco.MjSpec()
    spec.option.timestep = physics.time_step
    spec.option.integrator = mujoco.mjtIntegrator.mjINT_IMPLICITFAST
    spec.option.solver = mujoco.mjtSolver.mjSOL_NEWTON
    spec.option.cone = mujoco.mjtCone.mjCONE_PYRAMIDAL
    spec.visual.global_.offwidth = 1920
    spec.visual.global_.offheight = 1080
    spec.stat.extent = 1.0
    _add_floor(spec, physics.friction)
    for index, (name, description) in enumerate(robots.items(), start=1):
        part = description.spec()
        own = FLOOR_BIT << index
        for geom in part.geoms:
            if geom.contype or geom.conaffinity:
                geom.contype = own
                # Floor and the robots after this one, not itself.
                geom.conaffinity = FLOOR_BIT | (~(own | (own - 1)) & 0xFF)
                geom.friction[0] = physics.friction
        accent = part.material(description.accent)
        if accent is not None and name in COLOURS:
            accent.rgba = COLOURS[name]
        frame = spec.worldbody.add_frame()
        spec.attach(part, prefix=f"{name}/", frame=frame)
    if furnish is not None:
        furnish(spec)
    return spec.compile()


def _add_floor(spec: mujoco.MjSpec, friction: float) -> None:
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
    spec.worldbody.add_geom(
        name="floor",
        type=mujoco.mjtGeom.mjGEOM_PLANE,
        size=[20, 20, 0.1],
        material="floor",
        friction=[friction, 0.005, 0.0001],
        contype=FLOOR_BIT,
        conaffinity=0,
    )
    spec.worldbody.add_light(
        pos=[0, 0, 4],
        dir=[0.2, 0.3, -1],
        type=mujoco.mjtLightType.mjLIGHT_DIRECTIONAL,
        castshadow=True,
    )


class World:
    """Physics of a model whose robots advance it together.

    Time passes when every robot has asked for it, so that each can be
    driven through its own interface.

    Attributes:
        model: Compiled model.
        data: Its state.
        physics: Time step and control period.
        ticks: Control ticks that have passed.
    """

    def __init__(
        self,
        robots: Mapping[str, RobotDescription],
        physics: PhysicsSettings,
        furnish: Callable[[mujoco.MjSpec], None] | None = None,
    ) -> None:
        """Compile a world in which every robot still has to be placed."""
        self.physics = physics
        self.model = build_model(robots, physics, furnish)
        self.data = mujoco.MjData(self.model)
        self.ticks = 0
        self._waiting = self._robots = len(robots)
        roots = [
            self.model.body(f"{name}/{robot.torso}").id
            for name, robot in robots.items()
        ]
        # Floor and walls are nobody's; other things are strangers.
        owner = np.full(self.model.nbody, self._robots + 1)
        owner[0] = 0
        for number, root in enumerate(roots, start=1):
            owner[self.model.body_rootid == self.model.body_rootid[root]] = (
                number
            )
        self._owner_of_geom = owner[self.model.geom_bodyid]

    @property
    def time(self) -> float:
        """Simulated time: a count of ticks, so that sums are exact. [s]."""
        return self.ticks * self.physics.tick

    def advance(self) -> None:
        """Note that one robot is done; step when all of them are."""
        self._waiting -= 1
        if self._waiting == 0:
            mujoco.mj_step(
                self.model, self.data, nstep=self.physics.steps_per_tick
            )
            self.ticks += 1
            self._waiting = self._robots

    def robots_touch(self) -> bool:
        """Whether two robots, or one and a thing, are in contact."""
        if self.data.ncon == 0:
            return False
        owners = self._owner_of_geom[self.data.contact.geom]
        touching = (owners[:, 0] != owners[:, 1]) & (owners.min(axis=1) > 0)
        return bool(touching.any())


def place_free_body(qpos: Sequence[float], pose: Pose) -> list[float]:
    """Move the free joint of a robot to where its odometry begins.

    Args:
        qpos: Position and quaternion in odometry. Shape (7,).
        pose: Pose of odometry in the world.

    Returns:
        Position and quaternion in the world. Shape (7,).
    """
    x, y, z, w, a, b, c = qpos
    place = pose.compose(Pose(x, y, 0.0))
    cw, sw = cos(0.5 * pose.theta), sin(0.5 * pose.theta)
    return [
        place.x,
        place.y,
        z,
        cw * w - sw * c,
        cw * a - sw * b,
        cw * b + sw * a,
        cw * c + sw * w,
    ]
