"""Test the stored plan of a predictive evader."""

from math import pi

import numpy as np
import pytest

from stepaside.arena import Disc, ObstacleSet
from stepaside.core.poses import Pose
from stepaside.strategies import (
    Knowledge,
    Limits,
    LookAhead,
    OptimalEvasion,
    OptimalPursuit,
)

NAO = Limits(0.1, 0.2, 0.04, 0.4)
MIND = LookAhead(pieces=(2, 3), turns=3, tail=6, tight=0.0)


def seen(distance: float, *solids: Disc, time: float = 0.0) -> Knowledge:
    return Knowledge(
        time, 0.3, distance, NAO, obstacles_in_map=ObstacleSet(solids)
    )


@pytest.mark.parametrize("distance", [0.4, 0.6])
def test_the_stored_plan_excludes_the_steps_of_the_law(
    distance: float,
) -> None:
    solid = Disc(0.0, 3.0, 0.2)
    _, memory = MIND.decide(seen(distance, solid), MIND.begin())
    assert len(memory.plan) == 2 + 3 and memory.spot == 0
    turns = set(np.round(memory.plan, 9).tolist())
    assert turns <= set(np.round([0.0, -0.08 * pi, 0.08 * pi], 9).tolist())


def test_it_keeps_the_turns_on_the_spot_as_well() -> None:
    """With its back at something it cannot walk."""
    wary = LookAhead(pieces=(2, 3), turns=3, tail=6, tight=9.0)
    solids = [Disc(-0.45, y, 0.2) for y in (-0.4, 0.0, 0.4)]
    _, memory = wary.decide(seen(0.7, *solids), wary.begin())
    assert memory.spot > 0 and len(memory.plan) == memory.spot + 2 + 3


def test_the_rest_of_a_plan_excludes_executed_steps() -> None:
    solid = Disc(-0.5, 0.0, 0.2)
    _, memory = MIND.decide(seen(0.5, solid, time=2.0), MIND.begin())
    assert memory.spot == 2
    for made, spot in enumerate((2, 1, 0, 0, 0, 0, 0, 0, 0)):
        rest = memory.rest(2.0 + 0.4 * made + 0.1, 0.4)
        assert rest == (memory.plan[made:], spot)


def test_knowledge_defaults_to_unknown() -> None:
    """A body that says no more stands, alone on an open floor."""
    known = Knowledge(1.0, 0.3, 2.0, NAO)
    assert known.pose_in_map == Pose(0.0, 0.0, 0.0) and not known.moving
    assert not known.obstacles_in_map and known.step_start_in_map is None
    assert (known.bearing_rate, known.closing_speed) == (None, None)
    assert known.velocity is None
    assert known.age == known.spread == 0.0


def test_players_with_tables_have_equally_fine_ones() -> None:
    """So no game of two of them is decided by the finer grid."""
    cells = {
        kind().cells for kind in (LookAhead, OptimalEvasion, OptimalPursuit)
    }
    assert cells == {64}
