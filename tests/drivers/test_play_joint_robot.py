"""Test ``play`` with a joint-driven robot in Python, and its guardian."""

import os
import signal
import subprocess
import sys
from pathlib import Path
from time import monotonic, sleep

import numpy as np
import pytest

from velocity_fakes import read_log

ROBOT = '''
import os
from math import cos, sin
from time import monotonic, sleep
import numpy as np
import simulated_walker as scene
import stepaside as sa

class Echo(sa.JointRobot):
    """NAO whose joints are where they are told to be."""

    tick = 0.012
    joints = sa.load_tree(sa.load_robot("nao")).joints
    gains = dict.fromkeys(joints, (100.0, 5.0))

    def open(self):
        self.angles = np.zeros(len(self.joints))

    def clock(self):
        return monotonic()

    def listen(self):
        sleep(0.004)
        now = self.clock()
        force = (0.0, 0.0, 9.8 + 0.01 * (now % 0.1))
        sees = sa.Sighting.of_position(now, 0.6, 0.1)
        return sa.RobotState(
            now, self.angles, (0.0, 0.0, 0.0), force, [6.5] * 8, sees,
            joint_velocities=0.0 * self.angles, tilt=(0.0, 0.0),
        )

    def command(self, targets):
        self.note("command")
        self.angles = targets.angles

    def release(self):
        self.note(f"release {os.getpid()}")

    def note(self, word):
        with open(os.environ["ECHO_LOG"], "a") as log:
            print(word, file=log)

class Seeing(Echo):
    """The same with a camera, which shows an opponent 1 m ahead.

    Its clock waits for each image: a busy computer makes none late.
    """

    paced = False
    now = next_image = 0.0
    renders = False

    def clock(self):
        return self.now

    def listen(self):
        while self.renders:
            sleep(0.001)
        self.now += self.tick
        return super().listen()._replace(sighting=None)

    def image(self):
        if self.now < self.next_image:
            return None
        self.renders, self.next_image = True, self.now + 0.06
        image = self.render()
        self.renders = False
        return image

    def render(self):
        camera = scene.SimulatedWalker(0, 1.0)
        camera.socket.close()
        scene.CAMERA = 0.46
        camera.person = [1.0, 0.0]
        yaw, pitch = (
            self.angles[self.joints.index(name)]
            for name in ("HeadYaw", "HeadPitch")
        )
        camera.head = [yaw, pitch + 0.021]
        pixels = camera.image().partition(b"\\n")[2]
        pixels = np.frombuffer(pixels, np.uint8).reshape(120, 160, 3)
        return sa.CameraImage(self.now, pixels, scene.FOCAL, scene.FOCAL)
'''
ADAPTERS = Path(__file__).parents[2] / "examples" / "adapters"
PLAY = "from stepaside.cli.main import main; main()"
LONGEST = 60.0  # for what takes seconds on an idle machine, in [s]


def started(folder: Path, kind: str, *options: str) -> "subprocess.Popen[str]":
    """A play of a robot, which logs its calls."""
    file = folder / "echo.py"
    file.write_text(ROBOT, encoding="utf-8")
    words = [sys.executable, "-c", PLAY, "play", f"{file}:{kind}"]
    path = [str(ADAPTERS), os.environ.get("PYTHONPATH", "")]
    return subprocess.Popen(
        [*words, *options],
        env=os.environ
        | {
            "ECHO_LOG": str(folder / "log"),
            "PYTHONPATH": os.pathsep.join(filter(None, path)),
        },
        stderr=subprocess.PIPE,
        text=True,
    )


def calls(folder: Path) -> list[str]:
    """The calls so far."""
    log = folder / "log"
    return log.read_text(encoding="utf-8").split("\n") if log.exists() else []


def until_commanded(folder: Path) -> None:
    deadline = monotonic() + LONGEST
    while calls(folder).count("command") < 20:
        assert monotonic() < deadline
        sleep(0.02)


def test_an_interrupt_rests_and_releases_the_joints(tmp_path: Path) -> None:
    play = started(tmp_path, "Echo")
    until_commanded(tmp_path)
    play.send_signal(signal.SIGINT)
    said = play.communicate(timeout=LONGEST)[1]
    assert "resting" in said
    assert calls(tmp_path)[-2] == f"release {play.pid}"


def test_a_joint_robot_finds_its_opponent_by_its_camera(
    tmp_path: Path,
) -> None:
    pytest.importorskip("cv2")
    run = tmp_path / "run"
    play = started(
        tmp_path,
        "Seeing",
        *("--sensing", "cameras", "--duration", "3", "--record", str(run)),
    )
    said = play.communicate(timeout=LONGEST)[1]
    assert "walking" in said, said
    seen = read_log(run)["sighting"]
    seen = seen[np.isfinite(seen[:, 0])]
    _, bearing, distance = np.median(seen[-20:], axis=0)
    assert bearing == pytest.approx(0.0, abs=0.1)
    assert distance == pytest.approx(1.0, abs=0.15)
