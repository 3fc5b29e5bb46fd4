"""Figure of one maneuver: footsteps from above, ZMP and CoM over time."""

import numpy as np

from ..core.errors import AnyPath
from ..planning import ManeuverPlan
from .figure_sizes import sheet
from .figure_style import COLOURS, MEAN, THEORY, new_figure, save
from .sole_outlines import draw_soles


def draw_plan(plan: ManeuverPlan, role: str, path: AnyPath) -> None:
    """Write the figure of a maneuver.

    Args:
        plan: Plan of the maneuver.
        role: "pursuer" or "evader", for the colour.
        path: File to write; its suffix gives the format.
    """
    colour = COLOURS[role]
    gait = plan.schedule.settings
    samples = plan.sample(np.arange(0.0, plan.schedule.duration, 0.01))
    if sheet().narrow:
        figure = new_figure(4.2, 6.6)
        above, *over_time = figure.subplots(3, 1, height_ratios=[2, 1, 1])
    else:
        figure = new_figure(9.5, 4.8)
        grid = figure.add_gridspec(2, 2, width_ratios=[1.25, 1.0])
        above = figure.add_subplot(grid[:, 0])
        over_time = [figure.add_subplot(grid[i, 1]) for i in range(2)]
    side = plan.first_foot.value
    rows = [
        (0.0, side if i % 2 == 0 else -side, *pose)
        for i, pose in enumerate(plan.placements.tolist())
    ]
    draw_soles(above, np.array(rows[:2]), gait.sole, THEORY, ls=":")
    draw_soles(above, np.array(rows[2:]), gait.sole, colour, alpha=0.7)
    above.plot(*samples.zmp.T, color=THEORY, lw=0.8, label="ZMP")
    above.plot(*samples.com.T, color=colour, lw=2.0, label="CoM")
    above.set(
        xlabel="x in the plan frame [m]",
        ylabel="y [m]",
    )
    above.set_aspect("equal", adjustable="datalim")
    # Legends above the axes cover no data.
    above.set_title(
        f"{role}: desired heading {np.degrees(plan.bearing):.1f}°", pad=18
    )
    above.legend(loc="lower center", bbox_to_anchor=(0.5, 0.985), ncols=2)
    lines = (
        ("ZMP", samples.zmp, {"color": THEORY, "lw": 0.9}),
        ("DCM", samples.dcm, {"color": MEAN, "lw": 0.9, "ls": "--"}),
        ("CoM", samples.com, {"color": colour, "lw": 1.8}),
    )
    for index, axes in enumerate(over_time):
        for label, points, look in lines:
            axes.plot(samples.times, points[:, index], label=label, **look)
        axes.set_ylabel(f"{'xy'[index]} [m]")
    over_time[0].legend(
        ncols=3, loc="lower center", bbox_to_anchor=(0.5, 0.985)
    )
    over_time[-1].set_xlabel("time [s]")
    save(figure, path)
