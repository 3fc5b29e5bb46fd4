"""Duels that the live page offers by name."""

from dataclasses import replace
from importlib.util import find_spec

from ...arena import RoomRecipe, generate_room
from ...games.duel_settings import DuelSettings
from ...planning import PRESETS as GAITS
from .live_session import LiveSettings

AS_STARTED = "as started"
ROOM_SEED = 3  # of the room that is offered
PERSON_DISTANCE, PERSON_SPEED = 2.5, 0.3  # in [m], [m/s]


def presets_of(started: LiveSettings) -> dict[str, LiveSettings]:
    """Return the games that a page offers, by name.

    Cameras are among them if the library that reads images is installed.

    Args:
        started: Settings with which the page was started, which come first.
    """
    if not isinstance(started, DuelSettings):
        return {AS_STARTED: started}
    duel = DuelSettings(seed=started.seed)
    room = generate_room(RoomRecipe(discs=3), ROOM_SEED)
    found: dict[str, LiveSettings] = {
        AS_STARTED: started,
        "duel": duel,
        "room": replace(
            duel,
            room=replace(duel.room, plan=room),
            evader_strategy="look-ahead",
        ),
        "person": replace(
            duel,
            pursuer="person",
            person=replace(duel.person, speed=PERSON_SPEED),
            start=replace(duel.start, distance=PERSON_DISTANCE),
            gait=GAITS["fast"],
        ),
    }
    if find_spec("cv2") is not None:
        found["cameras"] = replace(duel, sensing="cameras")
    return found
