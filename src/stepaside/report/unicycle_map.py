"""Figure of a map over starts."""

import numpy as np

from ..unicycle.maps import StartMap
from .style import plt


def draw_map(found: StartMap, path: str, *, body: float) -> None:
    """Write closest approach and settling time over the two bearings.

    Args:
        found: The map; four of its distances at most are drawn.
        path: File, of a format that its suffix tells.
        body: Distance that counts as capture, in [m], drawn as a line.
    """
    count = len(found.distances)
    picks = np.unique(np.linspace(0, count - 1, min(4, count)).astype(int))
    closest = found.grid("closest_distance")
    settled = found.grid("settled_time").copy()
    settled[~np.isfinite(settled)] = np.nan
    aims = np.rad2deg(found.pursuer_errors)
    bearings = np.rad2deg(found.bearings)
    figure, axes = plt.subplots(
        2,
        len(picks),
        figsize=(2.7 * len(picks) + 1.2, 5.8),
        sharex=True,
        sharey=True,
        squeeze=False,
    )
    rows = (
        (closest, "closest approach [m]", "viridis"),
        (settled, "time until it circles [s]", "cividis"),
    )
    for row, (values, label, colours) in zip(axes, rows, strict=True):
        high = float(np.nanmax(values)) if np.isfinite(values).any() else 1.0
        for ax, i in zip(row, picks, strict=True):
            image = ax.pcolormesh(
                bearings, aims, values[i], vmin=0.0, vmax=high, cmap=colours
            )
            ax.set_facecolor("0.8")  # captured or not settled
            ax.grid(visible=False)
            if closest[i].min() <= body < closest[i].max():
                ax.contour(
                    bearings, aims, closest[i], [1.001 * body], colors="w"
                )
        figure.colorbar(image, ax=list(row), label=label)
    for ax, i in zip(axes[0], picks, strict=True):
        ax.set_title(f"start {found.distances[i]:.2f} m apart")
    for ax in axes[-1]:
        ax.set_xlabel("bearing of the pursuer\nseen by the evader [deg]")
    for ax in axes[:, 0]:
        ax.set_ylabel("bearing of the evader\nseen by the pursuer [deg]")
    figure.savefig(path)
    plt.close(figure)
