"""Kinds of tables, by the name that a document asks for.

Each is a function of one or more results that gives Markdown.
"""

from collections.abc import Callable

from . import benchmark, duels, index, persons, seeing, viewer, walking

TABLES: dict[str, Callable[..., str]] = {
    "benchmark": benchmark.all_rows,
    "each": persons.each,
    "figures": duels.figures,
    "floors": duels.floors,
    "headlines": benchmark.headlines,
    "index": index.index,
    "long-walks": walking.long_walks,
    "pace": walking.pace,
    "printed": duels.printed,
    "ranges": persons.ranges,
    "rms": walking.rms,
    "seeing": seeing.figures,
    "viewer": viewer.figures,
    "worst": duels.worst,
}

__all__ = ["TABLES"]
