"""MuJoCo world with a floor and robots."""

from collections.abc import Callable, Iterator, Mapping, Sequence
from itertools import combinations
from math import cos, sin
from typing import TYPE_CHECKING

import mujoco
import numpy as np
from numpy.typing import NDArray

from ..core.errors import ConfigurationError
from ..core.player_identity import Colour
from ..core.poses import Pose
from ..core.random_streams import named_generator
from ..robots.description import RobotDescription
from ..robots.tree_cache import load_tree
from .body_settings import BodySettings
from .floor import add_floor, tilt_gravity
from .physics_settings import PhysicsSettings

if TYPE_CHECKING:
    from .servos import Servos

NO_SENSORS = int(mujoco.mjtDisableBit.mjDSBL_SENSOR)
SENSORS = mujoco.mj_sensorPos, mujoco.mj_sensorVel, mujoco.mj_sensorAcc
CONTACT_BITS = 0x7FFFFFFF  # of MuJoCo's contact masks, without the sign
COLOURS: Mapping[str, Colour] = {
    "pursuer": (0.80, 0.16, 0.14, 1.0),
    "evader": (0.10, 0.36, 0.75, 1.0),
}

DENSE_UP_TO = 4  # robots; MuJoCo itself changes at 60 degrees of freedom


def build_model(
    robots: Mapping[str, RobotDescription],
    physics: PhysicsSettings,
    body: BodySettings | None = None,
    seed: int = 0,
    furnish: Callable[[mujoco.MjSpec], None] | None = None,
    *,
    rendered: bool = True,
    colours: Mapping[str, Colour] | None = None,
) -> mujoco.MjModel:
    """Compile a floor and robots that collide with it and each other.

    Names of robots become prefixes, as in ``pursuer/torso``. What only serves
    images is included if rendered; the furnisher adds after the robots.
    """
    colours = COLOURS if colours is None else colours
    spec = mujoco.MjSpec()
    spec.compiler.discardvisual = not rendered
    spec.option.timestep = physics.time_step
    spec.option.integrator = getattr(
        mujoco.mjtIntegrator, f"mjINT_{physics.integrator.upper()}"
    )
    spec.option.solver = mujoco.mjtSolver.mjSOL_NEWTON
    if len(robots) <= DENSE_UP_TO:
        spec.option.jacobian = mujoco.mjtJacobian.mjJAC_DENSE
    spec.option.cone = mujoco.mjtCone.mjCONE_PYRAMIDAL
    spec.visual.global_.offwidth = 1920
    spec.visual.global_.offheight = 1080
    spec.stat.extent = 1.0
    tilt_gravity(spec, physics)
    add_floor(spec, physics, named_generator(seed, "floor"))
    for (name, description), own in zip(
        robots.items(), _contact_types(), strict=False
    ):
        part = description.spec(colours.get(name))
        for geom in part.geoms:
            if geom.contype or geom.conaffinity:
                geom.contype = own
                # Collides with the floor and all other robots.
                geom.conaffinity = CONTACT_BITS & ~own
                geom.friction[0] = physics.friction
        if body is not None and body.mass_error + body.com_error > 0.0:
            from .body_errors import perturb_masses

            generator = named_generator(seed, f"masses/{name}")
            perturb_masses(
                *(part.bodies, body, description.torso, generator),
                length_unit=description.game.length_unit,
            )
        # Otherwise MuJoCo warns that the options differ.
        part.option = spec.option
        frame = spec.worldbody.add_frame()
        spec.attach(part, prefix=f"{name}/", frame=frame)
    if furnish is not None:
        furnish(spec)
    return spec.compile()


def _contact_types() -> Iterator[int]:
    """Yield contact types of robots, none of which contains another.

    Each is a different half of the bits: it shares one with the complement
    of every other type, but not with its own.
    """
    bits = range(1, CONTACT_BITS.bit_length())  # bit 0 is the floor's
    for half in combinations(bits, len(bits) // 2):
        yield sum(1 << bit for bit in half)


class World:
    """Physics of a model that its robots advance together.

    Time advances when every robot has called :meth:`advance`.
    """

    def __init__(
        self,
        robots: Mapping[str, RobotDescription],
        physics: PhysicsSettings,
        body: BodySettings | None = None,
        seed: int = 0,
        furnish: Callable[[mujoco.MjSpec], None] | None = None,
        *,
        rendered: bool = False,
        colours: Mapping[str, Colour] | None = None,
    ) -> None:
        """Compile a world of robots to be placed; see :func:`build_model`."""
        for robot in robots.values():
            load_tree(robot)  # raises if model and description differ
        self.physics = physics
        ratio = physics.tick / physics.time_step
        self._steps = round(ratio)
        if self._steps < 1 or abs(self._steps - ratio) > 1e-9 * ratio:
            raise ConfigurationError(
                "tick must be a whole multiple of time_step, "
                f"{physics.time_step:g} [s], got {physics.tick:g}"
            )
        self.model = build_model(
            *(robots, physics, body, seed, furnish),
            rendered=rendered,
            colours=colours,
        )
        self.data = mujoco.MjData(self.model)
        self.before_step: list[Callable[[float], None]] = []
        self.measures = False  # whether sensors are read at every tick
        self.servos: Servos | None = None  # with errors, of the last robot
        # Velocities before the last physics step, whose sensors may lack.
        self._last_qvel, self._lacks_sensors = self.data.qvel.copy(), False
        self._qvel, self._option = self.data.qvel, self.model.opt  # views
        self._sensors: NDArray[np.float64] = self.data.sensordata  # likewise
        self.ticks, self.time = 0, 0.0  # simulated time [s]
        self._waiting = self._robots = len(robots)
        roots = [
            self.model.body(f"{name}/{robot.torso}").id
            for name, robot in robots.items()
        ]
        # Owner 0 is floor and walls; one further owner is all objects.
        owner = np.full(self.model.nbody, self._robots + 1)
        owner[0] = 0
        for number, root in enumerate(roots, start=1):
            owner[self.model.body_rootid == self.model.body_rootid[root]] = (
                number
            )
        self._owner_of_geom = owner[self.model.geom_bodyid]

    def advance(self) -> None:
        """Count a robot as done; step when all of them are."""
        self._waiting -= 1
        if self._waiting == 0:
            self._waiting = self._robots
            self.step()

    def step(self) -> None:
        """Advance by one control tick."""
        model, data, last = self.model, self.data, self._steps - 1
        calls = [*self.before_step]
        if self.servos is not None:
            calls.append(self.servos.before_step)
        self._option.disableflags = NO_SENSORS
        if last and not calls:
            mujoco.mj_step(model, data, nstep=last)
        for step in range(0 if calls else last, last + 1):
            for call in calls:
                call(self.time + step * self.physics.time_step)
            if step == last and self.measures:
                self._option.disableflags = 0
            elif step == last:
                self._last_qvel[:] = self._qvel
            mujoco.mj_step(model, data)
        self._option.disableflags, self._lacks_sensors = 0, not self.measures
        self.ticks += 1
        self.time = self.ticks * self.physics.tick

    @property
    def sensordata(self) -> NDArray[np.float64]:
        """Sensors of the last physics step, computed when first read.

        MuJoCo computes them within a step, from the velocities at its begin.
        """
        model, data = self.model, self.data
        if self._lacks_sensors:
            self._lacks_sensors, now = False, self._qvel.copy()
            self._qvel[:] = self._last_qvel
            for compute in SENSORS:
                compute(model, data)
            self._qvel[:] = now
        return self._sensors

    def robots_touch(self) -> bool:
        """Return whether robots touch each other or an object."""
        # Geom 0 is the floor, and most contacts are of feet with it.
        return any(self.data.contact.geom1.tolist()) and bool(
            self._touching().any()
        )

    def touching(self) -> tuple[str, ...]:
        """Return the sorted names of players and objects in contact."""
        pairs = self.data.contact.geom[self._touching()]
        bodies = self.model.geom_bodyid[pairs.ravel()]
        names = {self.model.body(body).name for body in bodies}
        return tuple(sorted({n.split("/")[0] or "a thing" for n in names}))

    def _touching(self) -> NDArray[np.bool_]:
        """Return the mask of contacts between owners. Shape (ncon,)."""
        geoms = self.data.contact.geom
        owners = self._owner_of_geom[geoms]
        apart = owners[:, 0] != owners[:, 1]
        touching: NDArray[np.bool_] = apart & (owners.min(axis=1) > 0)
        return touching


def transform_free_joint(qpos: Sequence[float], pose: Pose) -> list[float]:
    """Return position and quaternion of a frame with a pose in the world."""
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
