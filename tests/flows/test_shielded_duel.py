"""A shield around a strategy that would be caught."""

from flows.calls import shielded_duel

CONTACT = 0.49  # between the outlines of NAO and a person, in [m]


def test_a_robot_that_would_stand_is_made_to_walk_away() -> None:
    shielded = shielded_duel(shield=True)
    alone = shielded_duel(shield=False)
    assert alone["triggered_at_s"] is None
    assert alone["min_distance_m"] < CONTACT
    assert shielded["outcome"] == "completed"
    assert shielded["min_distance_m"] > CONTACT
    # Not before it must: further away it stands, as its strategy does.
    began = shielded["triggered_at_distance_m"]
    assert CONTACT + 0.1 < began < 0.95
