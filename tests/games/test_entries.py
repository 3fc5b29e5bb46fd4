"""Test merging, removing and renaming nested configuration entries."""

import pytest

from stepaside.games.configuration_file import over, renamed, without

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


def test_an_entry_deep_below_is_taken_out_or_renamed() -> None:
    assert without(BELOW, "b.d.e") == over(
        without(BELOW, "b"), {"b": {"c": 2, "d": {"f": 4}}}
    )
    moved = renamed(BELOW, "b.d.e", "b.d.z")
    assert moved["b"]["d"] == {"z": 3, "f": 4}
    for nowhere in ("x", "x.y", "a.y", "b.d.e.y"):
        assert without(BELOW, nowhere) == BELOW
        assert renamed(BELOW, nowhere, f"{nowhere}y") == BELOW
    with pytest.raises(KeyError):
        renamed(BELOW, "b.d.e", "b.d.f")
