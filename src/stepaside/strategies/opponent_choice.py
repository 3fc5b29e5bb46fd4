"""Choice of one opponent among several players."""

from collections.abc import Mapping

from ..core.player_identity import PlayerIdentity

NEARER = 0.9  # relative distance from which another opponent is taken


def choose_opponent(
    own: PlayerIdentity,
    distances: Mapping[PlayerIdentity, float],
    *,
    target: str = "",
    present: str = "",
) -> str:
    """Return the name of the player that a player plays against.

    It is the assigned target. Without a target it is the nearest opponent,
    and another one than at present only when that is nearer by a tenth; in a
    game without opponents, the nearest player. The name is empty if no
    player has been seen.
    """
    if target:
        return target
    candidates = {
        other.name: distance
        for other, distance in distances.items()
        if own.opposes(other)
    } or {other.name: distance for other, distance in distances.items()}
    if not candidates:
        return ""
    nearest = min(candidates, key=lambda name: candidates[name])
    now = candidates.get(present)
    if now is not None and candidates[nearest] > NEARER * now:
        return present
    return nearest
