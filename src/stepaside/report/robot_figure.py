"""Figure of a standing robot: links, soles, CoM and frames."""

from pathlib import Path
from typing import Any

import mujoco
import numpy as np
from matplotlib.patches import Polygon
from scipy.spatial import ConvexHull, QhullError

from ..core.poses import Array
from ..games.player_settings import settings_from_description
from ..locomotion.zmp.reference_table import initial_stance
from ..planning import Foot
from ..planning.plan import sole_corners
from ..robots.description import RobotDescription
from ..robots.geom_points import geom_points_in_world
from ..robots.leg_kinematics import LegKinematics
from .figure_style import LIGHT, legend_above, panels, save

VIEWS = (("from the front", 1, "y [m]"), ("from the left", 0, "x [m]"))
LINK, SOLE, COM = "#9aa4b2", "#d9862b", LIGHT.pushed
AXES = (LIGHT.pursuer, LIGHT.support, LIGHT.evader)  # of x, y and z
TICK = 0.004  # of the leg kinematics, in [s]


def draw_robot(description: RobotDescription, file: Path) -> None:
    """Draw a robot in the initial stance of its gait.

    Raises:
        StepAsideError: If the stance is out of reach.
        OutputError: If the figure cannot be written.
    """
    gait = settings_from_description(description).gait
    legs = LegKinematics(description, tick=TICK)
    legs.stand(initial_stance(gait))
    model = description.compile()
    data = mujoco.MjData(model)
    at = int(model.body(description.torso).jntadr[0])
    first = int(model.jnt_qposadr[at])
    data.qpos[first : first + legs.posture.size] = legs.posture
    mujoco.mj_kinematics(model, data)
    mujoco.mj_comPos(model, data)
    size = 0.15 * gait.com_height
    figure, shown = panels(
        ["ab"],
        9.0,
        [4.8],
        title=f"{description.name}: CoM at {gait.com_height:.3f} m, soles "
        "bold, frames of torso and feet (x red, y green, z blue)",
        sharey=True,
    )
    for axes, (title, across, label) in zip(
        shown.values(), VIEWS, strict=True
    ):
        _draw_links(axes, model, data, across)
        for foot, name in (
            (Foot.LEFT, description.left_foot),
            (Foot.RIGHT, description.right_foot),
        ):
            site = data.site(name)
            frame = site.xmat.reshape(3, 3)
            corners = sole_corners(np.zeros(3), foot, gait.sole)
            edge = site.xpos + corners[[0, 1, 2, 3, 0]] @ frame[:, :2].T
            axes.plot(edge[:, across], edge[:, 2], color=SOLE, lw=3)
            _draw_frame(axes, site.xpos, frame, across, size)
        torso = data.body(description.torso)
        _draw_frame(axes, torso.xpos, torso.xmat.reshape(3, 3), across, size)
        com = data.subtree_com[torso.id]
        axes.plot(com[across], com[2], "o", color=COM, ms=7, label="CoM")
        axes.axhline(0.0, color="#606060", lw=0.8)
        axes.set(title=title, xlabel=label, aspect="equal")
    shown["a"].set_ylabel("z [m]")
    legend_above(shown["a"], VIEWS[0][0], 1)
    save(figure, file)


def _draw_links(
    axes: Any, model: mujoco.MjModel, data: mujoco.MjData, across: int
) -> None:
    """Draw the outlines of all geoms, and lines from joint to joint."""
    for geom in range(model.ngeom):
        points = geom_points_in_world(model, data, geom)[:, [across, 2]]
        if len(points) < 3:
            continue
        try:
            outline = points[ConvexHull(points).vertices]
        except QhullError:  # flat in this view
            continue
        axes.add_patch(
            Polygon(outline, closed=True, fc=LINK, ec="#606a78", alpha=0.25)
        )
    for body in range(2, model.nbody):
        if model.body_weldid[body] != body:
            continue  # without a joint, as the frame of a sensor
        above = model.body_weldid[model.body_parentid[body]]
        ends = data.xpos[[body, above]]
        axes.plot(ends[:, across], ends[:, 2], color="#404854", lw=1.0)


def _draw_frame(
    axes: Any, place: Array, frame: Array, across: int, size: float
) -> None:
    for axis, colour in zip(frame.T, AXES, strict=True):
        tip = place + size * axis
        axes.plot(
            [place[across], tip[across]],
            [place[2], tip[2]],
            color=colour,
            lw=1.6,
        )
