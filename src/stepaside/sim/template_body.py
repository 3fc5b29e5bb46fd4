"""The body of a template: a disc with a mast that shows where it heads."""

from math import cos, sin

import mujoco

from ..core.poses import Pose

DISC, FLAT = 0.07, 0.006  # radius and half height, in [m]
MAST, TOP = 0.012, 0.5  # radius and height, in [m]
ARM = 0.12  # of the arrow ahead, in [m]
COLOURS = {
    "pursuer": (0.73, 0.17, 0.10, 1.0),
    "evader": (0.12, 0.37, 0.75, 1.0),
}
OTHERS = (0.35, 0.35, 0.38, 1.0)


def add_template(spec: mujoco.MjSpec, name: str) -> None:
    """Put a template into a world, as a body that is moved and touches none.

    Args:
        spec: World.
        name: Of the player; prefix of its body.
    """
    colour = COLOURS.get(name, OTHERS)
    body = spec.worldbody.add_body(name=f"{name}/trunk", mocap=True)
    kinds = mujoco.mjtGeom
    _part(body, kinds.mjGEOM_CYLINDER, (0, 0, FLAT), (DISC, FLAT, 0), colour)
    arrow = (0.5 * ARM, 0.2 * DISC, FLAT)
    _part(body, kinds.mjGEOM_BOX, (0.5 * ARM, 0, FLAT), arrow, colour)
    mast = (MAST, 0.5 * TOP, 0.0)
    _part(body, kinds.mjGEOM_CYLINDER, (0, 0, 0.5 * TOP), mast, colour)
    arm = (0.25 * ARM, MAST, MAST)
    _part(body, kinds.mjGEOM_BOX, (0.25 * ARM, 0, TOP), arm, colour)


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
    """Put a template somewhere.

    Args:
        model: Of the world.
        data: Its state.
        name: Of the player.
        pose: Where it is and heads.
    """
    at = int(model.body(f"{name}/trunk").mocapid[0])
    data.mocap_pos[at] = pose.x, pose.y, 0.0
    half = 0.5 * pose.theta
    data.mocap_quat[at] = cos(half), 0.0, 0.0, sin(half)
