"""Test that control runs without a simulator."""

import json
import subprocess
import sys
from pathlib import Path

import pytest

from stepaside.planning import GaitSettings

CODE = """
import sys
for missing in ("mujoco", "scipy", "matplotlib"):
    sys.modules[missing] = None
from onboard_session import main
main()
"""


def test_control_plays_without_a_simulator() -> None:
    """Import all of it, stand, walk some steps and halt, in two ways."""
    pytest.importorskip("cv2", reason="the colour detector is an extra")
    played = subprocess.run(
        [sys.executable, "-c", CODE],
        cwd=Path(__file__).parents[1],
        capture_output=True,
        text=True,
        check=False,
    )
    assert played.returncode == 0, played.stderr
    found = json.loads(played.stdout)
    assert found["modules"] > 50
    for way in ("without", "with"):
        phases = ["standing", "walking", "halting", "standing"]
        assert found[way]["phases"] == phases
        assert 0.1 < found[way]["walked"] < 0.4
        spacing = GaitSettings().foot_spacing
        assert found[way]["apart"] == pytest.approx(spacing, abs=1e-4)
