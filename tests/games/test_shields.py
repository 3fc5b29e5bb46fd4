"""Test what shields know of the bodies in a game."""

import pytest

from stepaside.games.game_settings import duel
from stepaside.games.recorded_game import RecordedGame, run_game
from stepaside.games.shields import reach_of
from stepaside.strategies import (
    STAND,
    ShieldedStrategy,
    ShieldSettings,
    load_strategy,
)

SHIELD = ShieldSettings(True, 0.06, 6.0)
PERSON = 0.32  # radius of an adult with its arms and feet, in [m]


def test_contact_is_what_both_bodies_reach() -> None:
    """NAO's arms reach farther than its shoulders, also while it walks."""
    found = {}
    for body in ("person", "robot"):
        settings = duel(pursuer={"body": body}, evader={"shield": SHIELD})
        own = settings.resolved().player("evader")
        assert reach_of(own) > 0.16
        found[body] = own.shield.contact
    given = settings.changed(evader={"shield": {"contact": 0.6}})
    assert given.resolved().player("evader").shield.contact == 0.6
    reach = reach_of(own)
    assert found == pytest.approx(
        {"person": reach + PERSON, "robot": 2.0 * reach}
    )


@pytest.mark.parametrize("level", ["physics", "steps"])
def test_shield_of_an_object_knows_the_bodies_as_that_of_settings(
    level: str,
) -> None:
    settings = duel(level=level, pursuer={"body": "person"})
    named = RecordedGame(settings.changed(evader={"shield": SHIELD}))
    strategy = load_strategy("evasion", settings.resolved().evader.evasion)
    strategy = ShieldedStrategy(strategy, SHIELD)
    given = RecordedGame(settings, strategies={"evader": strategy})
    assert named.strategies == given.strategies
    shield = given.strategies["evader"]
    assert isinstance(shield, ShieldedStrategy) and not shield.assumes


def test_run_says_that_departures_of_a_gait_are_assumed(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(
        ShieldedStrategy, "decide", lambda self, known, memory: (STAND, memory)
    )
    settings = duel(
        level="steps",
        duration=1.0,
        pursuer={"body": "person"},
        evader={"shield": SHIELD, "gait": {"speed": 0.09}},
    )
    (note,) = run_game(settings).summary.notes
    assert note.startswith("evader: the shield assumes")
    assert "0.2 m and 0.01 m per decision" in note
