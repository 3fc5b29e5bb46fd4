"""Figure of the reversed circle over the ratios of speeds and gains."""

from typing import Any

import numpy as np

from ..theory.unicycle.ratio_map import RatioMap, map_ratios
from ..theory.unicycle.unicycle_game import Game, TurningLaw
from .figure_sizes import sheet
from .figure_style import EVADER, add_common_legend, new_figure, save

_COUNT = 121  # along each ratio
_SPEEDS = (0.8, 4.0)  # pursuer's over evader's
_GAINS = (0.25, 16.0)  # evader's over pursuer's


def draw_ratios(game: Game, path: str) -> RatioMap:
    """Draw the ratios at which a stable reversed circle exists.

    Args:
        game: Game with the evasion angle; its ratios are marked.
        path: File to write; its suffix gives the format.

    Returns:
        The map under the game's own law.
    """
    speeds = np.geomspace(*_SPEEDS, _COUNT)
    gains = np.geomspace(*_GAINS, _COUNT)
    maps = {
        law: map_ratios(game.angle, law, speeds, gains) for law in TurningLaw
    }
    stacked = [m.reversed_stable for m in maps.values()]
    finite = np.isfinite(stacked)
    high = float(np.max(stacked, where=finite, initial=1e-9))
    narrow = sheet().narrow
    figure = new_figure(4.8, 7.6) if narrow else new_figure(9.6, 4.9)
    places = (2, 1) if narrow else (1, 2)
    axes = figure.subplots(*places, sharex=True, sharey=True)
    for ax, (law, found) in zip(axes, maps.items(), strict=True):
        image = _draw(ax, found, high)
        ax.plot(
            game.pursuer.speed / game.evader.speed,
            game.evader.gain / game.pursuer.gain,
            "o",
            mfc="w",
            mec=EVADER,
            mew=2.0,
            ms=8,
            clip_on=False,
            label="this game",
            zorder=5,
        )
        ax.set_title(f"{law} law")
        ax.set_xlabel("pursuer's speed / evader's speed [1]")
    axes[0].set_ylabel("evader's gain / pursuer's gain [1]")
    figure.colorbar(
        image,
        ax=list(axes),
        label="distance between the players on that circle\n"
        "[evader's speed / pursuer's gain]",
    )
    add_common_legend(figure, axes, ncols=2 if narrow else 4)
    degrees = np.rad2deg(game.angle)
    figure.suptitle(
        "Coloured: a second stable circle, in the opposite direction; "
        f"evasion angle {degrees:.0f}°"
    )
    save(figure, path)
    return maps[game.law]


def _draw(ax: Any, found: RatioMap, high: float) -> Any:
    """Draw one law; both axes are logarithmic."""
    speeds, gains = found.speed_ratios, found.gain_ratios
    ax.set_xscale("log", base=2)
    ax.set_yscale("log", base=2)
    ax.grid(visible=False)
    image = ax.pcolormesh(
        speeds,
        gains,
        found.reversed_stable.T,
        vmin=0.0,
        vmax=high,
        cmap="viridis",
        shading="nearest",
        rasterized=True,
    )
    only_unstable = np.isfinite(found.reversed_unstable)
    only_unstable &= ~np.isfinite(found.reversed_stable)
    masks = (
        (only_unstable, "..", "second circle, unstable"),
        (~np.isfinite(found.main), "////", "no main circle"),
    )
    for mask, hatch, name in masks:
        if mask.any():
            ax.contourf(
                speeds,
                gains,
                mask.T.astype(float),
                [0.5, 1.5],
                colors="none",
                hatches=[hatch],
            )
            ax.fill([], [], fill=False, hatch=hatch, label=name)
    share = found.reversed_stable / found.main
    if np.nanmin(share, initial=1.0) < 0.5:
        lines = ax.contour(
            speeds, gains, share.T, [0.25, 0.5], colors="w", linewidths=1.3
        )
        ax.clabel(lines, fmt=lambda v: f"{v:g} of the main circle", fontsize=8)
    ticks = {"x": (1, 1.5, 2, 3, 4), "y": (0.25, 0.5, 1, 2, 4, 8, 16)}
    ax.set_xticks(ticks["x"], [f"{t:g}" for t in ticks["x"]])
    ax.set_yticks(ticks["y"], [f"{t:g}" for t in ticks["y"]])
    return image
