"""Figure of one maneuver: footsteps from above, ZMP and CoM over time."""

import numpy as np

from ..core.errors import AnyPath
from ..planning import ManeuverPlan
from .figure_style import COLOURS, MEAN, THEORY, legend_above, panels, save
from .overlays import soles
from .plan_view import draw_lines


def draw_plan(plan: ManeuverPlan, role: str, path: AnyPath) -> None:
    """Write the figure of a maneuver.

    Args:
        plan: Plan of the maneuver.
        role: "pursuer" or "evader", for the colour.
        path: File to write; its suffix gives the format.
    """
    colour = COLOURS[role]
    sole = plan.schedule.settings.sole
    samples = plan.sample(np.arange(0.0, plan.schedule.duration, 0.01))
    _, axes = panels(["px", "py"], 9.5, [1.6, 1.6])
    above = axes["p"]
    sides = plan.first_foot.value * (-1.0) ** np.arange(len(plan.placements))
    outlines = soles(np.column_stack([sides, plan.placements]), sole)
    draw_lines(above, outlines[:8], THEORY, ls=":")  # of both feet at first
    draw_lines(above, outlines[8:], colour, alpha=0.7)
    above.plot(*samples.zmp.T, color=THEORY, lw=0.8, label="ZMP")
    above.plot(*samples.com.T, color=colour, lw=2.0, label="CoM")
    above.set(xlabel="x in the plan frame [m]", ylabel="y [m]")
    above.set_aspect("equal", adjustable="datalim")
    title = f"{role}: desired heading {np.degrees(plan.bearing):.1f}°"
    legend_above(above, title, 2)
    lines = (
        ("ZMP", samples.zmp, {"color": THEORY, "lw": 0.9}),
        ("DCM", samples.dcm, {"color": MEAN, "lw": 0.9, "ls": "--"}),
        ("CoM", samples.com, {"color": colour, "lw": 1.8}),
    )
    for index, name in enumerate("xy"):
        for label, points, look in lines:
            axes[name].plot(
                samples.times, points[:, index], label=label, **look
            )
        axes[name].set(xlabel="time [s]", ylabel=f"{name} [m]")
    legend_above(axes["x"], "", 3)
    save(above.figure, path)
