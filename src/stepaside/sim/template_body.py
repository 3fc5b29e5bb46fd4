"""Marker of a template: a disc with a mast and a heading arrow."""

from math import cos, sin

import mujoco

from ..core.player_colours import Colour
from ..core.poses import Pose

DISC_RADIUS = 0.07  # in [m]
DISC_HALF_HEIGHT = 0.006  # in [m]
MAST_RADIUS = 0.012  # in [m]
MAST_HEIGHT = 0.5  # in [m]
ARROW = 0.12  # length, in [m]
COLOURS = {
    "pursuer": (0.73, 0.17, 0.10, 1.0),
    "evader": (0.12, 0.37, 0.75, 1.0),
}
OTHER_COLOUR = (0.35, 0.35, 0.38, 1.0)


def add_template(
    spec: mujoco.MjSpec, name: str, colour: Colour | None = None
) -> None:
    """Add the marker of a template to a world, without contacts.

    Args:
        spec: Specification of the world.
        name: Name of the player, which is the prefix of the body.
        colour: Red to opacity; by default that of the role by this name.
    """
    colour = colour or COLOURS.get(name, OTHER_COLOUR)
    body = spec.worldbody.add_body(name=f"{name}/trunk", mocap=True)
    kinds = mujoco.mjtGeom
    _part(
        body,
        kinds.mjGEOM_CYLINDER,
        (0, 0, DISC_HALF_HEIGHT),
        (DISC_RADIUS, DISC_HALF_HEIGHT, 0),
        colour,
    )
    arrow = (0.5 * ARROW, 0.2 * DISC_RADIUS, DISC_HALF_HEIGHT)
    _part(
        body,
        kinds.mjGEOM_BOX,
        (0.5 * ARROW, 0, DISC_HALF_HEIGHT),
        arrow,
        colour,
    )
    mast = (MAST_RADIUS, 0.5 * MAST_HEIGHT, 0.0)
    _part(body, kinds.mjGEOM_CYLINDER, (0, 0, 0.5 * MAST_HEIGHT), mast, colour)
    arm = (0.25 * ARROW, MAST_RADIUS, MAST_RADIUS)
    _part(body, kinds.mjGEOM_BOX, (0.25 * ARROW, 0, MAST_HEIGHT), arm, colour)


def _part(
    body: mujoco.MjsBody,
    kind: mujoco.mjtGeom,
    place: tuple[float, float, float],
    size: tuple[float, float, float],
    colour: tuple[float, float, float, float],
) -> None:
    body.add_geom(
        type=kind,
        pos=list(place),
        size=list(size),
        rgba=list(colour),
        group=2,
        contype=0,
        conaffinity=0,
    )


def pose_template(
    model: mujoco.MjModel, data: mujoco.MjData, name: str, pose: Pose
) -> None:
    """Set the pose of a template.

    Args:
        model: Model of the world.
        data: Its state.
        name: Name of the player.
        pose: Pose of the template in the world.
    """
    at = int(model.body(f"{name}/trunk").mocapid[0])
    data.mocap_pos[at] = pose.x, pose.y, 0.0
    half = 0.5 * pose.theta
    data.mocap_quat[at] = cos(half), 0.0, 0.0, sin(half)
