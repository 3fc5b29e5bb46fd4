"""Generated tables, by the name used in documents.

Each is a function of one or more results that returns Markdown.
"""

from collections.abc import Callable

from . import (
    benchmark,
    bounds,
    doors,
    humanoids,
    learning,
    many_duels,
    policies,
    room_evaders,
    settings,
    studies,
    unicycles,
)

TABLES: dict[str, Callable[..., str]] = studies.TABLES | {
    "benchmark": benchmark.all_rows,
    "bound-evaders": bounds.evaders,
    "certified-starts": unicycles.certified_starts,
    "chauffeur": bounds.chauffeur,
    "doors": doors.doors,
    "environments": learning.environments,
    "fast-walks": many_duels.fast_walks,
    "humanoids": humanoids.reached,
    "policy-hardware": policies.on_hardware,
    "policy-tracking": policies.tracking,
    "printed": many_duels.printed,
    "settings": settings.settings,
    "settings-of-commands": settings.settings_of_commands,
    "shield-duels": bounds.shield_duels,
    "spreads": many_duels.spreads,
    "survivals": room_evaders.survivals,
}

__all__ = ["TABLES"]
