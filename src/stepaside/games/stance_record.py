"""How a walker stands, as a record that is looked at closely has it."""

from collections.abc import Sequence

import numpy as np

from ..planning import Foot
from ..poses import Array, Pose
from .player import Snapshot

UNKNOWN = (np.nan,) * 8


def near_rows(seen: Snapshot) -> dict[str, Sequence[float]]:
    """Rows of one snapshot, in odometry where they are asked or believed.

    Args:
        seen: Of a robot; of anybody else there are none.
    """
    if seen.walk is None or seen.stance is None:
        return {}
    walk, stance = seen.walk, seen.stance
    step = walk.step(seen.time)
    foot = step.swing.other
    single = float(step.walking and step.remaining > 0.0)
    state = walk.estimate
    left = foot is Foot.LEFT
    return {
        "velocity": stance.velocity,
        "tilt": stance.tilt,
        "sole": stance.left_sole if left else stance.right_sole,
        "support": (foot.value, single, *step.support),
        "heading_reference": (walk.torso_heading,),
        "estimate": UNKNOWN
        if state is None
        else (*state.com, *state.velocity, *state.zmp, *state.tilt),
    }


def place_near(arrays: dict[str, Array], frame: Pose) -> None:
    """Put what is in odometry where that is in the world.

    Args:
        arrays: By name; those of :func:`near_rows` are changed, and an
            estimate that nobody made is left out.
        frame: Pose of the odometry in the world.
    """
    if "support" not in arrays:
        return
    support, turn = arrays["support"], Pose(0.0, 0.0, frame.theta)
    support[:, 2:4] = frame.transform_points(support[:, 2:4])
    support[:, 4] += frame.theta
    arrays["heading_reference"] += frame.theta
    estimate = arrays["estimate"]
    if np.isnan(estimate).all():
        del arrays["estimate"]
        return
    estimate[:, 0:2] = frame.transform_points(estimate[:, 0:2])
    estimate[:, 2:4] = turn.transform_points(estimate[:, 2:4])
    estimate[:, 4:6] = frame.transform_points(estimate[:, 4:6])
