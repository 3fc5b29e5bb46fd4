"""Figures of ``stepaside reproduce``."""

from collections.abc import Callable
from pathlib import Path


def draw_figures(folder: Path, seed: int | None) -> list[tuple[str, str]]:
    """Draw counterparts of Fig. 2 and Fig. 5, and a sweep over strategies.

    Args:
        folder: Folder of the figures.
        seed: Seed of the duel; None to leave it out.

    Returns:
        Caption and file name of each figure.
    """
    figures: list[tuple[str, str, Callable[[Path], None]]] = [
        (
            "fig2.png",
            "Unicycles under (1)-(4), in the manner of Fig. 2",
            _draw_game,
        ),
        (
            "sweep.png",
            "The circle over angle and ratios: theory as lines, simulation "
            "as marks",
            _draw_sweep,
        ),
    ]
    if seed is not None:
        figures.append(
            (
                f"duel-seed{seed}.png",
                "Two NAOs in physics, in the manner of Fig. 5",
                lambda file: _draw_duel(file, seed),
            )
        )
    for name, _, draw in figures:
        draw(folder / name)
    return [(caption, name) for name, caption, _ in figures]


def turns_shown() -> tuple[float, float]:
    """Return how far the pursuer has turned in the counterpart of Fig. 2.

    Returns:
        Number of turns, and the time of the last snapshot, in [s].
    """
    from math import tau

    from ..report.unicycle_figures import time_shown
    from ..studies.unicycle_claims import FIG_2, play

    run = play(FIG_2)
    end = time_shown(run)
    pursuer, _ = run.poses([0.0, end])
    return abs(float(pursuer[1, 2] - pursuer[0, 2])) / tau, end


def _draw_game(file: Path) -> None:
    from ..report.unicycle_figures import draw_game
    from ..studies.unicycle_claims import FIG_2, play

    draw_game(play(FIG_2), file)


def _draw_sweep(file: Path) -> None:
    from ..report.unicycle_figures import draw_sweep
    from ..studies.unicycle_claims import FIG_2

    draw_sweep(FIG_2, file)


def _draw_duel(file: Path, seed: int) -> None:
    from ..games.duel_settings import DuelSettings
    from ..games.outcome import Outcome
    from ..games.recorded_game import run_duel
    from ..report.run_figure import draw_run

    result = run_duel(DuelSettings(seed=seed, duration=120.0))
    if result.outcome is Outcome.INTERRUPTED:
        raise KeyboardInterrupt  # do not draw a partial duel
    draw_run(result, file)
