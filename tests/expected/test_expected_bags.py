"""Test what exports should say and hold."""

from pathlib import Path

import stepaside as sa
from expected.asking import answer


def test_no_signal_is_missing_in_a_model(tmp_path: Path) -> None:
    """A URDF has none; it lacks models only, here that of a person."""
    settings = sa.duel(duration=0.5).changed(
        pursuer={"body": "person"}, start=sa.StartSettings(distance=2.0)
    )
    folder = tmp_path / "run"
    sa.write_run(folder, sa.run_game(settings))
    output = f"{folder}.urdf"
    exported = answer("show", folder, "-o", output)["files"][output]
    assert exported["absent"] == ["pursuer: no joints, as it is no robot"]
