"""Test the validation of control settings."""

from typing import Any

import pytest

from stepaside.core.errors import ConfigurationError
from stepaside.games import walk
from stepaside.locomotion.control_settings import (
    OPEN_LOOP,
    STABILISED,
    ControlSettings,
)


@pytest.mark.parametrize(
    ("kind", "values", "words"),
    [
        (ControlSettings, {"method": "guess"}, "closed-form, measured"),
        (ControlSettings, {"feedback": 1}, "true or false, got 1"),
    ],
)
def test_values_out_of_range_are_refused(
    kind: Any, values: dict[str, Any], words: str
) -> None:
    with pytest.raises(ConfigurationError, match=words):
        kind(**values)


def test_the_paper_walks_without_feedback() -> None:
    assert OPEN_LOOP == ControlSettings("closed-form", False)
    assert STABILISED == ControlSettings("measured", True)


@pytest.mark.parametrize("method", ["measured", "mpc"])
def test_a_measured_state_needs_feedback(method: str) -> None:
    with pytest.raises(ConfigurationError, match="needs feedback = true"):
        walk(control=ControlSettings(method, False)).resolved()  # type: ignore[arg-type]
    settings = walk(control=ControlSettings(method, True))  # type: ignore[arg-type]
    assert settings.players[0].control.method == method
