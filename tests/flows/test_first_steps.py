"""What a new user tries first, in processes of their own."""

import pytest

from flows.calls import stepaside


def test_version_is_printed() -> None:
    assert stepaside("--version", anew=True).out.split()[-1].count(".") == 2


def test_a_duel_is_played() -> None:
    said = stepaside("duel", "--duration", 1, "--json", anew=True)
    assert said.json["duration_s"] == pytest.approx(1.0)
    assert said.json["outcome"] == "completed"
