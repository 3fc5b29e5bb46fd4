"""Generated tables, by the name used in documents.

Each is a function of one or more results that returns Markdown.
"""

from collections.abc import Callable

from . import (
    benchmark,
    bounds,
    duels,
    games_of_many,
    humanoids,
    learning,
    legs_encounters,
    many_duels,
    people,
    person_approaches,
    policies,
    pushes,
    room_evaders,
    rooms,
    settings,
    unicycles,
    walking,
)

TABLES: dict[str, Callable[..., str]] = {
    "benchmark": benchmark.all_rows,
    "bound-evaders": bounds.evaders,
    "certified": many_duels.certified,
    "certified-starts": unicycles.certified_starts,
    "chauffeur": bounds.chauffeur,
    "shield-duels": bounds.shield_duels,
    "evading-opponents": room_evaders.opponents,
    "opponent-ladder": room_evaders.ladder,
    "doors": games_of_many.doors,
    "environments": learning.environments,
    "fast-walks": walking.fast_walks,
    "humanoids": humanoids.reached,
    "legs-people": legs_encounters.people,
    "outcomes": many_duels.outcomes,
    "people": people.people,
    "people-reactions": people.reactions,
    "people-seen": people.seen,
    "policy-tracking": policies.tracking,
    "printed": duels.printed,
    "push-methods": pushes.methods,
    "ranges": person_approaches.ranges,
    "rating-scores": learning.scores,
    "teams": games_of_many.teams,
    "crowds": games_of_many.crowds,
    "rooms": rooms.outcomes,
    "settings": settings.settings,
    "settings-of-commands": settings.settings_of_commands,
    "spreads": many_duels.spreads,
}

__all__ = ["TABLES"]
