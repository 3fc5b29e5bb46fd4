"""Marker of a template: a disc with a mast and a heading arrow."""

from math import cos, sin

import mujoco

from ..core.player_colours import Colour
from ..core.poses import Pose
from .floor import add_geom

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
