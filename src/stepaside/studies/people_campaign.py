"""Campaign of encounters with people: one record per encounter."""

from collections.abc import Sequence

from .campaign import Study, code_stamp
from .code_version import LIBRARIES
from .duel_campaign import TOGETHER
from .person_encounters import (
    FIELDS,
    Encounter,
    play_encounter,
    play_encounters,
)

MODULES = ("studies/person_encounters",)  # which plays an encounter


def people_study(encounters: Sequence[Encounter]) -> Study[Encounter]:
    """Return the study of some encounters."""
    legs = all(encounter.base.legs.walks for encounter in encounters)
    return Study(
        "people",
        encounters,
        play_encounter,
        lambda encounter: encounter.key,
        lambda encounter: code_stamp(MODULES, LIBRARIES),
        FIELDS,
        (),
        play_encounters if legs else None,
        TOGETHER if legs else 1,
    )
