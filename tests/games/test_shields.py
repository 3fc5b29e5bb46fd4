"""Test the distance at which a shield counts two bodies as in contact."""

import pytest

from stepaside.games.game_settings import duel
from stepaside.games.shields import reach_of

PERSON = 0.32  # radius of an adult with its arms and feet, in [m]


def test_contact_is_what_both_bodies_reach() -> None:
    """NAO's arms reach farther than its shoulders, also while it walks."""
    shield = {"enabled": True, "speed": 0.06}
    found = {}
    for body in ("person", "robot"):
        settings = duel(pursuer={"body": body}, evader={"shield": shield})
        own = settings.resolved().player("evader")
        assert reach_of(own) > 0.16
        found[body] = own.shield.contact
    reach = reach_of(own)
    assert found == pytest.approx(
        {"person": reach + PERSON, "robot": 2.0 * reach}
    )
