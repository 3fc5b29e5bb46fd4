"""Check of the steps of a gait against the reach of a robot's legs."""

import numpy as np

from ..core.errors import ReachError
from ..core.poses import Pose
from ..planning import GaitSettings
from ..robots.leg_kinematics import LegKinematics
from .zmp.reference_table import standing_reference

SHORT = 0.4  # step by the CoM height that is not checked: legs reach it
MISSED = 0.1  # distance from its place, by the CoM height, of a lost foot
RESOLUTION = 1e-3  # of the greatest value that a message names, in [m]


def check_steps(legs: LegKinematics, gait: GaitSettings) -> None:
    """Refuse strides and step heights that are out of reach.

    Legs that miss a foot's place by less lean and sink: they may walk.

    Raises:
        ReachError: If one is; names the greatest that is reached.
    """
    for name in ("stride", "step_height"):
        given = getattr(gait, name)
        if _reaches(legs, gait, name, given):
            continue
        low, high = 0.0, given
        while high - low > RESOLUTION:
            middle = 0.5 * (low + high)
            if _reaches(legs, gait, name, middle):
                low = middle
            else:
                high = middle
        raise ReachError(
            f"gait.{name} must be at most {low:.2f} [m], which the legs of "
            f"{legs.description.name} reach, got {given:g}"
        )


def _reaches(
    legs: LegKinematics, gait: GaitSettings, name: str, value: float
) -> bool:
    """Return whether legs reach one step with a stride, or with a height."""
    ahead, height = 0.5 * value, 0.0
    if name == "step_height":
        ahead, height = 0.0, value
    half = 0.5 * gait.foot_spacing
    body = standing_reference(
        Pose(ahead, half, 0.0), Pose(-ahead, -half, 0.0), gait
    )
    x, y, _, theta = body.left_foot
    raised = body._replace(left_foot=(x, y, height, theta))
    _, errors = legs.posture_of(raised)
    return float(np.abs(errors).max()) < MISSED * gait.com_height
