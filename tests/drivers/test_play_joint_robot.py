"""Test ``play`` with a joint-driven robot that has a camera."""

import os
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from velocity_fakes import read_log

ROBOT = '''
from time import sleep
import numpy as np
import simulated_walker as scene
import stepaside as sa

class Seeing(sa.JointRobot):
    """NAO whose joints are where they are told to be, with a camera.

    It shows an opponent 1 m ahead. Its clock waits for each image: a busy
    computer makes none late.
    """

    tick, paced = 0.012, False
    joints = sa.load_tree(sa.load_robot("nao")).joints
    gains = dict.fromkeys(joints, (100.0, 5.0))
    angles = np.zeros(len(joints))
    now = next_image = 0.0
    renders = False

    def listen(self):
        sleep(0.004)
        while self.renders:
            sleep(0.001)
        self.now += self.tick
        force = (0.0, 0.0, 9.8 + 0.01 * (self.now % 0.1))
        return sa.RobotState(
            self.now, self.angles, (0.0, 0.0, 0.0), force, [6.5] * 8,
            joint_velocities=0.0 * self.angles, tilt=(0.0, 0.0),
        )

    def command(self, targets):
        self.angles = targets.angles

    def release(self):
        pass

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


def test_a_joint_robot_finds_its_opponent_by_its_camera(
    tmp_path: Path,
) -> None:
    pytest.importorskip("cv2")
    file, run = tmp_path / "seeing.py", tmp_path / "run"
    file.write_text(ROBOT, encoding="utf-8")
    words = [sys.executable, "-c", PLAY, "play", f"{file}:Seeing"]
    words += ["--sensing", "cameras", "--duration", "3", "--record", str(run)]
    path = [str(ADAPTERS), os.environ.get("PYTHONPATH", "")]
    said = subprocess.run(
        words,
        env=os.environ | {"PYTHONPATH": os.pathsep.join(filter(None, path))},
        stderr=subprocess.PIPE,
        text=True,
        timeout=LONGEST,
        check=True,
    ).stderr
    assert "walking" in said, said
    seen = read_log(run)["sighting"]
    seen = seen[np.isfinite(seen[:, 0])]
    _, bearing, distance = np.median(seen[-20:], axis=0)
    assert bearing == pytest.approx(0.0, abs=0.1)
    assert distance == pytest.approx(1.0, abs=0.15)


def test_the_example_in_a_loop_of_its_own_walks() -> None:
    robot = f"{ADAPTERS / 'mujoco_robot.py'}:MujocoRobot"
    words = [sys.executable, "-c", PLAY, "play", robot, "--duration", "2"]
    said = subprocess.run(
        [*words, "--set", "delay_ticks=0"],
        stderr=subprocess.PIPE,
        text=True,
        timeout=LONGEST,
        check=True,
    ).stderr
    assert "walking" in said, said
