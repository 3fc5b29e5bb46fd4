"""Campaign of encounters with people: one record per encounter."""

from collections.abc import Sequence

from .duel_campaign import TOGETHER
from .person_encounters import (
    Encounter,
    play_encounter,
    play_encounters,
)
from .study import Study


def people_study(encounters: Sequence[Encounter]) -> Study[Encounter]:
    """Return the study of some encounters."""
    legs = all(encounter.base.legs.walks for encounter in encounters)
    return Study(
        "people",
        encounters,
        play_encounter,
        lambda encounter: encounter.key,
        play_encounters if legs else None,
        TOGETHER if legs else 1,
    )
