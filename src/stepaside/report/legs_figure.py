"""Figure of the response of learned legs."""

from ..core.errors import AnyPath
from ..locomotion.policy.velocity_response import AXES, VelocityResponse
from .figure_style import THEORY, new_figure, save

COLOURS = ("#1f5fbf", "#0b6a5d", "#8f4f14")
LABELS = ("forward [m/s]", "lateral [m/s]", "turn [rad/s]")


def draw_response(response: VelocityResponse, file: AnyPath) -> None:
    """Draw delivered velocities over commands, one panel for each axis.

    Args:
        response: Response of the legs.
        file: Figure to write.
    """
    figure = new_figure(9.5, 3.4)
    panels = figure.subplots(1, len(AXES))
    for i, (panel, axis) in enumerate(zip(panels, response.axes, strict=True)):
        ends = axis.commands[0], axis.commands[-1]
        panel.plot(ends, ends, color=THEORY, linestyle="--", linewidth=0.8)
        for k, label in enumerate(LABELS):
            panel.plot(
                axis.commands,
                [row[k] for row in axis.delivered],
                color=COLOURS[k],
                linewidth=1.4 if k == i else 0.8,
                marker="o" if k == i else None,
                markersize=3,
                label=label,
            )
        panel.set_title(f"{AXES[i]}, lag {axis.lag:.2f} s")
        panel.set_xlabel(f"command {LABELS[i]}")
    panels[0].set_ylabel("delivered")
    handles, labels = panels[0].get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside lower center", ncols=3)
    save(figure, file)
