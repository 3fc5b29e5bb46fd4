"""Test what exports should say and hold."""

import json
from dataclasses import replace
from pathlib import Path

from click.testing import CliRunner

import stepaside as sa
from stepaside.cli.main import main


def test_no_signal_is_missing_in_a_model(tmp_path: Path) -> None:
    """A URDF has none; it lacks models only, here that of a person."""
    settings = replace(
        sa.DuelSettings(duration=0.5),
        pursuer="person",
        start=sa.StartSettings(distance=2.0),
    )
    folder = tmp_path / "run"
    sa.write_run(folder, sa.run_duel(settings))
    words = ["export", str(folder), "--to", "urdf", "--json"]
    done = CliRunner().invoke(main, words, catch_exceptions=False)
    assert json.loads(done.stdout)["absent"] == [
        "pursuer: no joints, as it is no robot"
    ]
