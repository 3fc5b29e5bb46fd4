"""How far a torso leans over the foot that stands, so that hips bear it.

On one leg its hip holds up the rest of the body, whose weight hangs half a
hip's width aside: whatever the steps are, for the CoM is over the foot. Where
that is too much for the motor, a torso that leans over the foot brings its
weight nearer to the hip, and the hips under it farther out.
"""

from collections.abc import Mapping
from dataclasses import replace

from ..planning import GaitSettings
from ..robots.description import RobotDescription
from .rehearsal import BEARABLE, Borne, torques_borne

LEANS = (0.06, 0.12, 0.18, 0.24)  # that are tried, in [rad]
HELPS = 0.97  # of a torque, if the torso is to lean farther for it


def least_lean(
    description: RobotDescription,
    gait: GaitSettings,
    torques: Mapping[str, float],
) -> tuple[float, Borne]:
    """Least lean at which a step leaves something of each torque.

    To be asked for a robot whose joints bear too much without.

    Args:
        description: The robot, whose torso stays level.
        gait: How it walks.
        torques: Greatest torque of each joint, in [N m].

    Returns:
        The lean, in [rad], and what is borne then; where none of those
        tried is enough, the least that none betters by much.
    """
    best: tuple[float, Borne] | None = None
    for lean in LEANS:
        leaning = replace(description, lean=lean)
        found = torques_borne(leaning, gait, torques)
        if best is None or found.most < HELPS * best[1].most:
            best = lean, found
        if found.most <= BEARABLE:
            break
    assert best is not None
    return best
