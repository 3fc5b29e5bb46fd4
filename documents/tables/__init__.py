"""Kinds of tables, by the name that a document asks for.

Each is a function of one or more results that gives Markdown.
"""

from collections.abc import Callable

from . import (
    benchmark,
    bounds,
    duels,
    index,
    instants,
    many_duels,
    mutation,
    persons,
    pushes,
    seeing,
    served,
    unicycles,
    viewer,
    walking,
)

TABLES: dict[str, Callable[..., str]] = {
    "benchmark": benchmark.all_rows,
    "barrier": bounds.barrier,
    "bound-evaders": bounds.evaders,
    "bound-refinement": bounds.refinement,
    "bound-speed": bounds.speed,
    "certified": many_duels.certified,
    "certified-starts": unicycles.certified_starts,
    "each": persons.each,
    "floors": duels.floors,
    "headlines": benchmark.headlines,
    "index": index.index,
    "instants": instants.instants,
    "long-walks": walking.long_walks,
    "outcomes": many_duels.outcomes,
    "pace": walking.pace,
    "printed": duels.printed,
    "push-methods": pushes.methods,
    "ranges": persons.ranges,
    "remedies": unicycles.remedies,
    "rms": walking.rms,
    "score": mutation.score,
    "seeing": seeing.figures,
    "served": served.duels,
    "served-lateness": served.lateness,
    "spreads": many_duels.spreads,
    "survivors": mutation.survivors,
    "viewer": viewer.figures,
    "worst-seeds": many_duels.worst_seeds,
}

__all__ = ["TABLES"]
