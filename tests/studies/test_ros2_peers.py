"""Test topics against real ROS 2 nodes, where ``make ros2-peers`` put them.

Nothing is installed here: without an environment a test is skipped.
"""

import subprocess
import sys
from pathlib import Path

import pytest

from stepaside.studies.result_files import read_result
from tools.documents.tables.ros2_sessions import peers

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


def test_what_was_not_heard_is_in_the_table() -> None:
    rows = [
        {
            "topic": topic,
            "type": "nav_msgs/Odometry",
            "way": "us to ROS 2",
            "heard": 0,
            "passed": False,
        }
        for topic in ("odom", "serve's robot is walked")
    ]
    good = [{**row, "heard": 9, "passed": True} for row in rows]
    found = [
        {"name": "Jazzy", "middleware": "Fast DDS 2.14.5", "rows": good},
        {"name": "Kilted", "middleware": "Fast DDS 3.2.3", "rows": rows},
    ]
    lines = peers({"distributions": found}).splitlines()
    assert "Jazzy (Fast DDS 2.14.5) | Kilted (Fast DDS 3.2.3)" in lines[0]
    assert lines[2] == "| us | ROS 2 | `odom` | nav_msgs/Odometry | yes | no |"
    with pytest.raises(ValueError, match="rows of distributions differ"):
        peers({"distributions": [found[0], {**found[1], "rows": rows[::-1]}]})
