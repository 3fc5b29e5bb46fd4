"""Test the validation of control settings."""

import pytest

from stepaside.core.errors import ConfigurationError
from stepaside.games import walk
from stepaside.locomotion.control_settings import ControlSettings


@pytest.mark.parametrize("method", ["measured", "mpc"])
def test_a_measured_state_needs_feedback(method: str) -> None:
    with pytest.raises(ConfigurationError, match="needs feedback = true"):
        walk(control=ControlSettings(method, False)).resolved()  # type: ignore[arg-type]
    settings = walk(control=ControlSettings(method, True))  # type: ignore[arg-type]
    assert settings.players[0].control.method == method
