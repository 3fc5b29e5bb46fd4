"""A person: a figure of human size that walks by itself."""

from math import cos, hypot, pi, sin

import mujoco
import numpy as np

from ..core.poses import Array, Pose
from .pedestrian_models import FIGURES, HIP, Colour, PedestrianModel
from .person_motion import PersonMotion
from .person_visits import RepeatedVisits
from .world import FLOOR_BIT, World

SKIN = (0.85, 0.68, 0.56, 1.0)
ADULT = FIGURES["adult"]
PARTS = ("trunk", "left leg", "right leg", "left arm", "right arm")
SHOULDER = 1.42  # height of an adult's, in [m]
TRUNK = 0.15  # half depth of the trunk, in [m]


def add_person(
    spec: mujoco.MjSpec, name: str, figure: PedestrianModel = ADULT
) -> None:
    """Put a figure into a world, as bodies that are moved, not pushed.

    Args:
        spec: World.
        name: Prefix of its bodies.
        figure: How it looks.
    """

    def capsule(
        body: mujoco.MjsBody,
        start: tuple[float, float, float],
        end: tuple[float, float, float],
        radius: float,
        colour: Colour,
    ) -> None:
        body.add_geom(
            type=mujoco.mjtGeom.mjGEOM_CAPSULE,
            fromto=[figure.size * value for value in (*start, *end)],
            size=[figure.size * radius, 0.0, 0.0],
            rgba=list(colour),
            group=2,
            contype=FLOOR_BIT,
            conaffinity=0,
        )

    shirt, trousers = figure.shirt, figure.trousers
    trunk = spec.worldbody.add_body(name=f"{name}/trunk", mocap=True)
    capsule(trunk, (0, 0, 1.0), (0, 0, 1.35), TRUNK, shirt)
    capsule(trunk, (0, -0.16, SHOULDER), (0, 0.16, SHOULDER), 0.07, shirt)
    capsule(trunk, (0, -0.08, HIP), (0, 0.08, HIP), 0.1, trousers)
    capsule(trunk, (0.01, 0, 1.58), (0.01, 0, 1.65), 0.09, SKIN)
    for side, y in (("left", 1.0), ("right", -1.0)):
        leg = spec.worldbody.add_body(name=f"{name}/{side} leg", mocap=True)
        capsule(leg, (0, 0, 0), (0, 0, -0.80), 0.065, trousers)
        capsule(leg, (-0.04, 0, -0.85), (0.14, 0, -0.85), 0.045, trousers)
        arm = spec.worldbody.add_body(name=f"{name}/{side} arm", mocap=True)
        capsule(arm, (0, 0.04 * y, 0), (0.03, 0.05 * y, -0.55), 0.045, shirt)


def parts_of(model: mujoco.MjModel, name: str) -> dict[str, int]:
    """Numbers of the moved bodies of a figure, by part."""
    return {
        part: int(model.body(f"{name}/{part}").mocapid[0]) for part in PARTS
    }


def pose_figure(
    data: mujoco.MjData,
    parts: dict[str, int],
    frame: Pose,
    way: float,
    figure: PedestrianModel = ADULT,
) -> None:
    """Put a figure somewhere, in the middle of a step.

    Args:
        data: State of the world.
        parts: As of :func:`parts_of`.
        frame: Where the figure is and heads.
        way: How far it has walked, in [m].
        figure: How it looks.
    """
    size = figure.size
    swing = figure.swing * sin(pi * way / figure.step)
    spots = {
        "trunk": (0.0, 0.0, 0.0, 0.0),
        "left leg": (0.0, 0.09, HIP, swing),
        "right leg": (0.0, -0.09, HIP, -swing),
        "left arm": (0.0, 0.2, SHOULDER, -0.7 * swing),
        "right arm": (0.0, -0.2, SHOULDER, 0.7 * swing),
    }
    for part, (x, y, z, pitch) in spots.items():
        at = parts[part]
        place = frame.compose(Pose(size * x, size * y, 0.0))
        data.mocap_pos[at] = place.x, place.y, size * z
        data.mocap_quat[at] = _turned(frame.theta, pitch)


REACH = 0.4  # arms of an adult, who keeps them down, [m]


class PersonTruth:
    """True state of a person: the axis of the trunk."""

    def __init__(
        self, motion: PersonMotion, figure: PedestrianModel = ADULT
    ) -> None:
        """Watch the walk of somebody."""
        self._motion, self._size = motion, figure.size
        self.reach = REACH * figure.size

    @property
    def com(self) -> Array:
        """A point in the middle of the trunk, in [m]. Shape (3,)."""
        return np.array([*self._motion.pose[:2], self._size])

    @property
    def position(self) -> tuple[float, float]:
        """Place of the trunk's axis, in [m]."""
        return self._motion.pose[:2]

    @property
    def place(self) -> tuple[float, float]:
        """Point that stands for the person: the trunk's axis, in [m]."""
        return self.position

    @property
    def heading(self) -> float:
        """Direction in which the person faces, in [rad]."""
        return self._motion.pose.theta

    @property
    def has_fallen(self) -> bool:
        """Return false: this person does not fall."""
        return False


class PersonBody:
    """The figure of a person in a world, where a walk has it.

    Attributes:
        world: The world.
        name: Its name there.
        truth: Where it is.
    """

    def __init__(
        self,
        world: World,
        name: str,
        motion: PersonMotion,
        figure: PedestrianModel = ADULT,
    ) -> None:
        """Stand a figure where its walk begins."""
        self.world, self.name = world, name
        self.truth = PersonTruth(motion, figure)
        self._figure = figure
        self._motion = motion
        self._way = 0.0
        self._parts = parts_of(world.model, name)
        self._place()

    @property
    def visits(self) -> RepeatedVisits:
        """Its visits, if it comes and goes."""
        return self._motion.visits

    def step(self, other: tuple[float, float]) -> None:
        """Walk for one tick.

        Args:
            other: Place of whom the person may walk to, in [m].
        """
        before = self._motion.pose
        tick = self.world.physics.tick
        self._motion.advance(self.world.time + tick, tick, other)
        x, y, _ = self._motion.pose
        self._way += hypot(x - before.x, y - before.y)
        self._place()

    def _place(self) -> None:
        """Put trunk, legs and arms where the walk has them."""
        data = self.world.data
        pose = self._motion.pose
        pose_figure(data, self._parts, pose, self._way, self._figure)


def _turned(heading: float, pitch: float) -> tuple[float, ...]:
    """Quaternion of a heading, and a pitch after it."""
    ch, sh = cos(0.5 * heading), sin(0.5 * heading)
    cp, sp = cos(0.5 * pitch), sin(0.5 * pitch)
    return ch * cp, -sh * sp, ch * sp, sh * cp
