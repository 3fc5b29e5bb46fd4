"""Test merging of nested configuration entries."""

import pytest

from stepaside.games.configuration_file import over

BELOW = {"a": 1, "b": {"c": 2, "d": {"e": 3, "f": 4}}, "g": 5, "h": {"i": 6}}


def test_upper_entries_take_precedence_and_others_stay() -> None:
    above = {"a": 10, "b": {"d": {"e": 30}, "j": 7}, "k": {"l": 8}}
    assert over(BELOW, above) == {
        "a": 10,
        "b": {"c": 2, "d": {"e": 30, "f": 4}, "j": 7},
        "g": 5,
        "h": {"i": 6},
        "k": {"l": 8},
    }
    assert BELOW["b"] == {"c": 2, "d": {"e": 3, "f": 4}}


@pytest.mark.parametrize("value", [None, 0, "text", [1, 2]])
def test_a_section_and_a_value_replace_each_other(value: object) -> None:
    """The upper entry replaces the lower one completely."""
    section = {"c": 2}
    assert over({"b": section}, {"b": value}) == {"b": value}
    assert over({"b": value}, {"b": section}) == {"b": section}
    assert over({}, BELOW) == over(BELOW, {}) == BELOW
