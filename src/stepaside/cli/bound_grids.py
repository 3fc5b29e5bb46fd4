"""Tables of a value over finer and finer grids, with their progress."""

from functools import partial
from typing import TYPE_CHECKING, Any

from ..core.progress import show_progress

if TYPE_CHECKING:
    from collections.abc import Callable

    from ..theory.value import ValueTable


def solve_grids(
    settings: Any,
    axes: int,
    solve: "Callable[..., ValueTable]",
    *,
    quiet: bool,
) -> "dict[int, ValueTable]":
    """Return tables by cells, each with twice as many as that before.

    Args:
        settings: Settings of the bound.
        axes: Number of axes of the grids.
        solve: Function of the number of cells along each axis, and of
            ``progress``, which takes the fraction done since its last call.
        quiet: Whether to print lines instead of a bar.
    """
    counts = [settings.grid // 2**n for n in range(settings.refine, -1, -1)]
    work, found = sum(count**axes for count in counts), {}
    look = "{l_bar}{bar}| {elapsed}<{remaining}"
    with show_progress("bound", 1.0, bar_format=look, quiet=quiet) as bar:
        for count in counts:
            share = count**axes / work
            found[count] = solve(count, progress=partial(_add, bar, share))
    return found


def _add(bar: Any, share: float, part: float) -> None:
    """Add a part of one table, which is a share of the work."""
    bar.update(share * part)
