"""What ``play`` and ``serve`` hand on to robots, cameras and switches.

Values are stored in ``tests/data/commands.json``.
"""

import json
import re
import tomllib
from dataclasses import is_dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from click.testing import CliRunner

from flows.calls import EXAMPLES
from stepaside import load_run
from stepaside.cli.main import main
from stepaside.core.errors import ConfigurationError
from stored_values import DATA, PATH, compare_stored, summed

ROBOTS = f"""
import json, signal, sys
sys.path.append({str(EXAMPLES / "adapters")!r})
import numpy as np
import stepaside as sa
from mujoco_robot import MujocoRobot

class Point(sa.VelocityRobot):
    paced, calls, head = False, [], sa.HeadLimits(1.0, 0.3, 0.8)
    limits = sa.VelocityLimits(0.5, 0.4, 1.0, lateral=0.3)
    time, pose, velocity = 10.0, sa.Pose(0.0, 0.0, 0.0), (0.0, 0.0, 0.0)
    def prepare(self):
        self.calls.append("prepare")
    def listen(self):
        self.time += 0.1
        assert self.time < 20.0, "it ends before"
        step = sa.Pose(*(0.1 * each for each in self.velocity))
        self.pose = self.pose.compose(step)
        place = self.pose.inverse().compose(sa.Pose(1.0, 0.4, 0.0))
        seen = sa.Sighting.of_position(self.time, place.x, place.y)
        return sa.RobotState(self.time, pose=self.pose, sighting=seen)
    def command(self, *velocity):
        self.velocity = velocity
        self.calls.append(velocity)
    def stop(self):
        self.command(0.0, 0.0, 0.0)
    def look(self, yaw, pitch):
        self.calls.append("look")
    def close(self):
        with open("calls.json", "w") as file:
            json.dump(self.calls, file)

class Failing(Point):
    def listen(self):
        if self.time > 11.0:
            raise OSError("the cable broke")
        return super().listen()

class Seeing(Failing):
    def image(self):
        pixels = np.zeros((12, 16, 3), np.uint8)
        mount = sa.CameraMount(0.0, 0.0, 0.4)
        return sa.CameraImage(self.time, pixels, 10.0, 10.0, mount)

class Joints(MujocoRobot):
    calls = []
    def listen(self):
        report = super().listen()
        assert report.time < 12.0, "it ends before"
        lost = 1.5 < report.time < 2.2
        return report._replace(sighting=None) if lost else report
    def command(self, targets):
        super().command(targets)
        self.calls.append([*targets.angles[:12]])
    close = Point.close

class Interrupted:
    direction, saturated = sa.Direction.FORWARD, False
    def begin(self):
        return None
    def decide(self, knowledge, memory):
        if knowledge.time > 10.9:
            signal.raise_signal(signal.SIGINT)
        return sa.Intent(0.3), None
"""
COMMANDS = tomllib.loads((DATA / "commands.toml").read_text("utf-8"))
PLAYED, ASKED = COMMANDS["played"], COMMANDS["asked"]


@pytest.fixture(autouse=True)
def file(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """File of the robots, beside which the commands run."""
    monkeypatch.chdir(tmp_path)
    made = tmp_path / "robots.py"
    made.write_text(ROBOTS)
    return made


def play(words: str) -> Any:
    """Play a robot of the file, or one at an address."""
    first, *rest = words.split()
    if first == "serve":
        return CliRunner().invoke(main, [first, *rest])
    address = first if ":" in first else f"robots.py:{first}"
    return CliRunner().invoke(main, ["play", address, *rest])


@pytest.mark.parametrize("words", PLAYED)
def test_a_robot_is_commanded_as_is_stored(words: str) -> None:
    pytest.importorskip("cv2")
    done = play(words)
    lines = re.sub(PATH, "", done.stderr).splitlines()
    found: list[Any] = [str(done.exit_code), lines[-1]]
    if "cameras" not in words:  # whose images come from a thread
        found += lines[:-1]
    if Path("calls.json").exists():
        calls = json.loads(Path("calls.json").read_text())
        found += dict.fromkeys(x for x in calls if isinstance(x, str))
        moves = np.array([x for x in calls if not isinstance(x, str)])
        found += summed([moves, [*map(float, moves.shape)]])
    if Path("run").exists():
        run = load_run("run")
        planned = run.summary.planning
        if planned is not None and planned.median_us is not None:
            assert planned.median_us > 5.0  # on the fastest machine
            planned = replace(planned, median_us=None)
        summary = replace(run.summary, planning=planned)
        found += summed([run.outcome.value, run.message, summary])
        for each in (run.settings, *run.arrays().items()):
            found += summed(each)
    compare_stored("commands.json", f"play {words}", found)


@pytest.mark.parametrize("words", ASKED)
def test_what_others_are_asked_for_is_what_is_stored(
    words: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    pytest.importorskip("cyclonedds")
    asked: list[Any] = []

    def note(*values: Any, **named: Any) -> None:
        for each in (*values, *named.items()):
            plain = isinstance(each, str | int | float | tuple | dict | None)
            asked.append(each if plain or is_dataclass(each) else "object")
        raise ConfigurationError("asked")

    monkeypatch.setattr(f"stepaside.{ASKED[words]}", note)
    done = play(words)
    assert done.stderr.endswith("stepaside: asked\n"), done.output
    found = [*summed(asked), re.sub(PATH, "", done.stderr)]
    compare_stored("commands.json", f"play asks {words}", found)
