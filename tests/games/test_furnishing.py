"""Test that the world of a duel has exactly its objects."""

from dataclasses import replace

import mujoco
import pytest

from stepaside.arena import Disc, Room
from stepaside.games import DuelSettings
from stepaside.games.settings_as_game import complete, scenery_of

ALONE = DuelSettings()
INSIDE = replace(
    ALONE, room=replace(ALONE.room, plan=Room(3.0, 3.0, (Disc(0, 0, 0.2),)))
)
PERSON = DuelSettings(pursuer="person")


@pytest.mark.parametrize(
    ("settings", "wanted"),
    [
        (ALONE, set()),
        (INSIDE, {"disc 1", "wall 1"}),
        (PERSON, {"pursuer/trunk", "pursuer/left leg"}),
    ],
)
def test_a_world_has_the_objects_of_its_duel(
    settings: DuelSettings, wanted: set[str]
) -> None:
    spec = mujoco.MjSpec()

    scenery_of(complete(settings)).furnish(spec)
    bodies = {body.name for body in spec.bodies} - {"world"}
    assert wanted <= bodies and bool(wanted) == bool(bodies)
    kinds = {name.partition("/")[0].rstrip(" 1234") for name in bodies}
    assert kinds <= {name.partition("/")[0].rstrip(" 12") for name in wanted}
