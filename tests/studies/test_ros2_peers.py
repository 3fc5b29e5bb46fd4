"""Test topics against real ROS 2 nodes, where ``make ros2-peers`` put them.

Nothing is installed here: without an environment a test is skipped.
"""

import subprocess
import sys
from pathlib import Path

import pytest
from result_files import read_result

ROOT = Path(__file__).parents[2]


@pytest.mark.parametrize("name", ["jazzy", "kilted"])
def test_ros_and_we_hear_each_other(name: str, tmp_path: Path) -> None:
    pytest.importorskip("cyclonedds")
    python = ROOT / f".venv-ros2-{name}" / "bin" / "python"
    if not (python.parents[1] / ".installed").exists():
        pytest.skip("no ROS 2 there; make ros2-peers installs it")
    file = tmp_path / "peers.json"
    check = ROOT / "tools" / "checks" / "ros2_peers.py"
    words = [str(check), f"{name}={python}", "--output", str(file)]
    done = subprocess.run(
        [sys.executable, *words], capture_output=True, text=True
    )
    assert done.returncode == 0, done.stdout + done.stderr
    (found,) = read_result(file)["distributions"]
    assert {row["way"] for row in found["rows"]} == {
        "ROS 2 to us",
        "us to ROS 2",
    }
