"""A person: a figure of human size that walks by itself."""

from math import cos, hypot, pi, sin

import mujoco
import numpy as np

from ..poses import Array, Pose
from .person_motion import Motion
from .world import FLOOR_BIT, World

SHIRT = (0.80, 0.16, 0.14, 1.0)
TROUSERS = (0.25, 0.27, 0.32, 1.0)
SKIN = (0.85, 0.68, 0.56, 1.0)
STEP = 0.25  # way from one foot to the other, in [m]
PARTS = ("trunk", "left leg", "right leg", "left arm", "right arm")
HIP, SHOULDER = 0.9, 1.42  # heights, in [m]
SWING = 0.14  # of a leg to either side, in [rad]
TRUNK = 0.15  # half depth of the trunk, in [m]


def add_person(spec: mujoco.MjSpec, name: str) -> None:
    """Put a figure into a world, as bodies that are moved, not pushed.

    Args:
        spec: World.
        name: Prefix of its bodies.
    """
    trunk = spec.worldbody.add_body(name=f"{name}/trunk", mocap=True)
    _capsule(trunk, (0, 0, 1.0), (0, 0, 1.35), TRUNK, SHIRT)
    _capsule(trunk, (0, -0.16, SHOULDER), (0, 0.16, SHOULDER), 0.07, SHIRT)
    _capsule(trunk, (0, -0.08, HIP), (0, 0.08, HIP), 0.1, TROUSERS)
    _capsule(trunk, (0.01, 0, 1.58), (0.01, 0, 1.65), 0.09, SKIN)
    for side, y in (("left", 1.0), ("right", -1.0)):
        leg = spec.worldbody.add_body(name=f"{name}/{side} leg", mocap=True)
        _capsule(leg, (0, 0, 0), (0, 0, -0.80), 0.065, TROUSERS)
        _capsule(leg, (-0.04, 0, -0.85), (0.14, 0, -0.85), 0.045, TROUSERS)
        arm = spec.worldbody.add_body(name=f"{name}/{side} arm", mocap=True)
        _capsule(arm, (0, 0.04 * y, 0), (0.03, 0.05 * y, -0.55), 0.045, SHIRT)


def _capsule(
    body: mujoco.MjsBody,
    start: tuple[float, float, float],
    end: tuple[float, float, float],
    radius: float,
    colour: tuple[float, float, float, float],
) -> None:
    body.add_geom(
        type=mujoco.mjtGeom.mjGEOM_CAPSULE,
        fromto=[*start, *end],
        size=[radius, 0.0, 0.0],
        rgba=list(colour),
        group=2,
        contype=FLOOR_BIT,
        conaffinity=0,
    )


def parts_of(model: mujoco.MjModel, name: str) -> dict[str, int]:
    """Numbers of the moved bodies of a figure, by part."""
    return {
        part: int(model.body(f"{name}/{part}").mocapid[0]) for part in PARTS
    }


def pose_figure(
    data: mujoco.MjData, parts: dict[str, int], frame: Pose, way: float
) -> None:
    """Put a figure somewhere, in the middle of a step.

    Args:
        data: State of the world.
        parts: As of :func:`parts_of`.
        frame: Where the figure is and heads.
        way: How far it has walked, in [m].
    """
    swing = SWING * sin(pi * way / STEP)
    spots = {
        "trunk": (0.0, 0.0, 0.0, 0.0),
        "left leg": (0.0, 0.09, HIP, swing),
        "right leg": (0.0, -0.09, HIP, -swing),
        "left arm": (0.0, 0.2, SHOULDER, -0.7 * swing),
        "right arm": (0.0, -0.2, SHOULDER, 0.7 * swing),
    }
    for part, (x, y, z, pitch) in spots.items():
        at = parts[part]
        place = frame.compose(Pose(x, y, 0.0))
        data.mocap_pos[at] = place.x, place.y, z
        data.mocap_quat[at] = _turned(frame.theta, pitch)


REACH = 0.4  # arms of a person, who keeps them down, [m]


class PersonTruth:
    """True state of a person: the axis of the trunk."""

    def __init__(self, motion: Motion) -> None:
        """Watch a walk."""
        self._motion = motion
        self.reach = REACH

    @property
    def com(self) -> Array:
        """A point in the middle of the trunk, in [m]. Shape (3,)."""
        return np.array([*self._motion.pose[:2], 1.0])

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
        """Direction of the walk, in [rad]."""
        return self._motion.pose.theta

    @property
    def has_fallen(self) -> bool:
        """Return false: this person does not fall."""
        return False


class Person:
    """The figure of a person in a world, where a walk has it.

    Attributes:
        world: The world.
        name: Its name there.
        truth: Where it is.
    """

    def __init__(self, world: World, name: str, motion: Motion) -> None:
        """Stand a figure where its walk begins."""
        self.world, self.name = world, name
        self.truth = PersonTruth(motion)
        self._motion = motion
        self._way = 0.0
        self._parts = parts_of(world.model, name)
        self._place()

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
        pose_figure(data, self._parts, self._motion.pose, self._way)


def _turned(heading: float, pitch: float) -> tuple[float, ...]:
    """Quaternion of a heading, and a pitch after it."""
    ch, sh = cos(0.5 * heading), sin(0.5 * heading)
    cp, sp = cos(0.5 * pitch), sin(0.5 * pitch)
    return ch * cp, -sh * sp, ch * sp, sh * cp
