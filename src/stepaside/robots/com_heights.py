"""Heights of the CoM that legs reach."""

from typing import TYPE_CHECKING

import numpy as np

from .joint_tree import place_frames
from .newton_step import BodyReference

if TYPE_CHECKING:
    from .leg_kinematics import LegKinematics

# Search of CoM heights: relative step before bisection, resolution of the ends
# [m], and least height that is tried, relative to the standing angles.
HEIGHT_STEP, RESOLUTION, LEAST_HEIGHT = 0.05, 2e-4, 0.1


def com_heights(
    legs: "LegKinematics", reference: BodyReference
) -> tuple[float, float]:
    """Return least and greatest CoM height [m] over the feet, or zeros."""
    x, y, _ = reference.com

    def reaches(height: float) -> bool:
        asked = reference._replace(com=(x, y, height))
        return legs.posture_of(asked)[0] is not None

    # Height of the CoM over the soles at the standing angles.
    com, soles, axes = np.empty(3), np.empty((2, 3)), np.empty((2, 3, 3))
    place_frames(legs.links, legs.standing, com, soles, axes)
    natural = float(com[2] - soles[:, 2].max())
    begin = natural
    while not reaches(begin):
        begin *= 1.0 - HEIGHT_STEP
        if begin < LEAST_HEIGHT * natural:
            return 0.0, 0.0
    ends = []
    for factor in (1.0 - HEIGHT_STEP, 1.0 + HEIGHT_STEP):
        inside, outside = begin, factor * begin
        while reaches(outside) and outside > LEAST_HEIGHT * natural:
            inside, outside = outside, factor * outside
        while abs(outside - inside) > RESOLUTION:
            middle = 0.5 * (inside + outside)
            if reaches(middle):
                inside = middle
            else:
                outside = middle
        ends.append(inside)
    return ends[0], ends[1]
