"""Footsteps of a run where the soles have landed."""

from math import atan2

import mujoco
import numpy as np

from ..core.poses import Array
from ..games.run import Run
from ..games.trajectory import Trajectory
from ..robots.description import RobotDescription, load_robot

LANDED = 0.02  # after its landing time a foot is on the floor, in [s]
NO_FOOTSTEPS = np.zeros((0, 5))


def footsteps_in(run: Run) -> dict[str, Array]:
    """Return where the soles of all players landed in the world.

    Recorded landings are those of the plans, in odometry: while a robot
    walks in open loop, its odometry drifts, by centimetres in two minutes.

    Args:
        run: The run.

    Returns:
        Rows (time [s], side, x [m], y [m], heading [rad]) by player; side is
        1 for left, -1 for right. Footsteps that land after the end of the
        run are left out. Each of shape (m, 5).
    """
    found = dict.fromkeys(run.tracks, NO_FOOTSTEPS)
    for name, track in run.tracks.items():
        if track.landings is not None and len(track.landings):
            description = load_robot(run.settings.robot_of(name).robot)
            found[name] = landed_footsteps(description, run.times, track)
    return found


def landed_footsteps(
    description: RobotDescription, times: Array, track: Trajectory
) -> Array:
    """Return where the soles of a robot landed; see :func:`footsteps_in`.

    Args:
        description: The robot.
        times: Times of the samples, in [s]. Shape (n,).
        track: Recorded motion; its planned landings are returned where no
            joint angles were recorded.
    """
    landings = NO_FOOTSTEPS if track.landings is None else track.landings
    if track.qpos is None or not len(landings):
        return landings
    model = description.compile()
    feet = description.left_foot, description.right_foot
    left, right = (model.site(foot).id for foot in feet)
    data = mujoco.MjData(model)
    rows = []
    for time, side, *_ in landings.tolist():
        index = int(np.searchsorted(times, time + LANDED))
        if index >= len(times):
            continue
        data.qpos[:] = track.qpos[index]
        mujoco.mj_kinematics(model, data)
        sole = left if side > 0.0 else right
        axes = data.site_xmat[sole]
        heading = atan2(axes[3], axes[0])
        rows.append((time, side, *data.site_xpos[sole, :2], heading))
    return np.array(rows, dtype=np.float64).reshape(-1, 5)
