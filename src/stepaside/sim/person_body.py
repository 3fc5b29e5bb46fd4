"""Bodies that physics does not move: people and templates."""

from math import cos, hypot, pi, sin

import mujoco

from ..core.player_identity import Colour
from ..core.poses import Pose
from ..core.rotations import quaternion_of
from .floor import FLOOR_BIT
from .ground_truth import FloorTruth
from .solid_geoms import add_geom
from .world import COLOURS, CONTACT_BITS, World

SKIN = (0.85, 0.68, 0.56, 1.0)
SHIRT = (0.80, 0.16, 0.14, 1.0)
TROUSERS = (0.25, 0.27, 0.32, 1.0)
HIP = 0.9  # height of the hips, in [m]
STEP = 0.25  # length of a step, in [m]
SWING = 0.14  # amplitude of the leg angle that gives it, in [rad]
PARTS = ("trunk", "left leg", "right leg", "left arm", "right arm")
SHOULDER = 1.42  # height of an adult's shoulders, in [m]
TRUNK = 0.15  # half depth of an adult's trunk, in [m]
# The only contact type that the contact masks of robots lack. With no type at
# all the compiler would discard the geoms as visual ones.
UNTOUCHABLE_BIT = ~CONTACT_BITS
REACH = 0.4  # of an adult around the trunk with arms hanging, in [m]


def add_person(
    spec: mujoco.MjSpec,
    name: str,
    *,
    shirt: Colour = SHIRT,
    solid: bool = True,
) -> None:
    """Add the bodies of a person; robots and obstacles touch a solid one."""

    def capsule(
        body: mujoco.MjsBody,
        start: tuple[float, float, float],
        end: tuple[float, float, float],
        radius: float,
        colour: Colour,
    ) -> None:
        add_geom(
            body,
            "CAPSULE",
            (radius,),
            colour,
            bit=FLOOR_BIT if solid else UNTOUCHABLE_BIT,
            fromto=[*start, *end],
            group=2,
        )

    trunk = spec.worldbody.add_body(name=f"{name}/trunk", mocap=True)
    capsule(trunk, (0, 0, 1.0), (0, 0, 1.35), TRUNK, shirt)
    capsule(trunk, (0, -0.16, SHOULDER), (0, 0.16, SHOULDER), 0.07, shirt)
    capsule(trunk, (0, -0.08, HIP), (0, 0.08, HIP), 0.1, TROUSERS)
    capsule(trunk, (0.01, 0, 1.58), (0.01, 0, 1.65), 0.09, SKIN)
    for side, y in (("left", 1.0), ("right", -1.0)):
        leg = spec.worldbody.add_body(name=f"{name}/{side} leg", mocap=True)
        capsule(leg, (0, 0, 0), (0, 0, -0.80), 0.065, TROUSERS)
        capsule(leg, (-0.04, 0, -0.85), (0.14, 0, -0.85), 0.045, TROUSERS)
        arm = spec.worldbody.add_body(name=f"{name}/{side} arm", mocap=True)
        capsule(arm, (0, 0.04 * y, 0), (0.03, 0.05 * y, -0.55), 0.045, shirt)


def mocap_indices(model: mujoco.MjModel, name: str) -> dict[str, int]:
    """Return the mocap indices of the bodies of a person, by part."""
    return {
        part: int(model.body(f"{name}/{part}").mocapid[0]) for part in PARTS
    }


def set_person_pose(
    data: mujoco.MjData,
    parts: dict[str, int],
    frame: Pose,
    way: float,
) -> None:
    """Set the bodies of a person; the way [m] is the phase of a step."""
    swing = SWING * sin(pi * way / STEP)
    positions = {
        "trunk": (0.0, 0.0, 0.0, 0.0),
        "left leg": (0.0, 0.09, HIP, swing),
        "right leg": (0.0, -0.09, HIP, -swing),
        "left arm": (0.0, 0.2, SHOULDER, -0.7 * swing),
        "right arm": (0.0, -0.2, SHOULDER, 0.7 * swing),
    }
    for part, (x, y, z, pitch) in positions.items():
        index = parts[part]
        place = frame.compose(Pose(x, y, 0.0))
        data.mocap_pos[index] = place.x, place.y, z
        data.mocap_quat[index] = quaternion_of(0.0, pitch, frame.theta)


DISC_RADIUS = 0.07  # in [m]
DISC_HALF_HEIGHT = 0.006  # in [m]
MAST_RADIUS = 0.012  # in [m]
MAST_HEIGHT = 0.5  # in [m]
ARROW = 0.12  # length, in [m]
OTHER_COLOUR = (0.35, 0.35, 0.38, 1.0)


def add_template(
    spec: mujoco.MjSpec, name: str, colour: Colour | None = None
) -> None:
    """Add the marker of a template to a world, without contacts."""
    colour = colour or COLOURS.get(name, OTHER_COLOUR)
    body = spec.worldbody.add_body(name=f"{name}/trunk", mocap=True)
    disc, mast = (DISC_RADIUS, DISC_HALF_HEIGHT), 0.5 * MAST_HEIGHT
    arrow = 0.5 * ARROW, 0.2 * DISC_RADIUS, DISC_HALF_HEIGHT
    arm = 0.25 * ARROW, MAST_RADIUS, MAST_RADIUS
    for kind, size, at in (
        ("CYLINDER", disc, (0.0, 0.0, DISC_HALF_HEIGHT)),
        ("BOX", arrow, (0.5 * ARROW, 0.0, DISC_HALF_HEIGHT)),
        ("CYLINDER", (MAST_RADIUS, mast), (0.0, 0.0, mast)),
        ("BOX", arm, (0.25 * ARROW, 0.0, MAST_HEIGHT)),
    ):
        add_geom(body, kind, size, colour, at=at, bit=0, group=2)


def pose_template(
    model: mujoco.MjModel, data: mujoco.MjData, name: str, pose: Pose
) -> None:
    """Set the pose of a template in the world."""
    at = int(model.body(f"{name}/trunk").mocapid[0])
    data.mocap_pos[at] = pose.x, pose.y, 0.0
    half = 0.5 * pose.theta
    data.mocap_quat[at] = cos(half), 0.0, 0.0, sin(half)


class MarkerBody:
    """Marker of a template, without contacts."""

    # Of a marker, which touches nothing, and that stands for its CoM, in [m].
    reach, height = 0.1, 0.27

    def __init__(self, world: World, name: str, pose: Pose) -> None:
        self.name, self.world = name, world
        self.truth = FloorTruth(pose, reach=self.reach, height=self.height)
        self.move(pose)

    def move(self, pose: Pose) -> None:
        """Move to a pose in the world."""
        self.truth.pose = pose
        pose_template(self.world.model, self.world.data, self.name, pose)


class PersonBody(MarkerBody):
    """Body of a person, whose legs swing with the distance walked."""

    reach, height = REACH, 1.0

    def __init__(self, world: World, name: str, pose: Pose) -> None:
        self._parts, self._walked = mocap_indices(world.model, name), 0.0
        super().__init__(world, name, pose)

    def move(self, pose: Pose) -> None:
        """Move to a pose in the world."""
        before, self.truth.pose = self.truth.pose, pose
        self._walked += hypot(pose.x - before.x, pose.y - before.y)
        set_person_pose(self.world.data, self._parts, pose, self._walked)
