"""Test the guardian of a robot driven by its joints."""

import os
import signal
import socket
from functools import partial

import numpy as np
import pytest

from stepaside.drivers.joint.stiffness_guardian import StiffnessGuardian
from stepaside.drivers.lola.lola_connection import ramp_stiffness_down
from stepaside.drivers.lola.lola_frames import ActuatorFrame
from stepaside.drivers.lola.lola_server import ActuatorFrameReader

TARGETS = np.linspace(-0.2, 0.2, 25)
STIFF = np.full(25, 0.8)


def answers_until_limp(robot: socket.socket) -> list[ActuatorFrame]:
    """Collect commands until the robot is limp or the link ends."""
    robot.settimeout(30.0)
    reader, answers = ActuatorFrameReader(), []
    while True:
        data = robot.recv(4096)
        answers += reader.feed(data) if data else []
        if not data or (
            answers
            and answers[-1].stiffness is not None
            and answers[-1].stiffness.max() == 0.0
        ):
            return answers


def control_that(ends: str) -> tuple[int, socket.socket]:
    """A process with a guardian, that commands once and then ends badly."""
    near, far = socket.socketpair()
    pid = os.fork()
    if pid == 0:
        far.close()
        guardian = StiffnessGuardian(partial(ramp_stiffness_down, near))
        guardian.update(TARGETS, STIFF)
        if ends == "limp":
            guardian.update(TARGETS, np.zeros(25))
            os._exit(0)
        if ends == "well":
            guardian.dismiss()
            os._exit(0)
        os.kill(os.getpid(), signal.SIGKILL if ends == "killed" else 19)
        os._exit(1)
    near.close()
    return pid, far


@pytest.mark.parametrize("ends", ["killed", "frozen"])
def test_a_control_that_is_killed_or_freezes_is_replaced_by_falling_stiffness(
    ends: str,
) -> None:
    pid, robot = control_that(ends)
    answers = answers_until_limp(robot)
    shares = [float(a.stiffness.max()) for a in answers]  # type: ignore[union-attr]
    assert len(shares) == 42 and shares[0] < 0.8 and shares[-1] == 0.0
    steps = np.diff(shares)
    np.testing.assert_allclose(steps, -0.8 / 42, atol=1e-6)
    for answer in answers:
        assert answer.position is not None
        np.testing.assert_allclose(answer.position, TARGETS, atol=1e-7)
    _, status = os.waitpid(pid, 0)  # it does not come back to life
    assert os.WIFSIGNALED(status) and os.WTERMSIG(status) == signal.SIGKILL
    robot.close()


@pytest.mark.parametrize("ends", ["well", "limp"])
def test_a_control_that_leaves_a_limp_robot_is_left_in_peace(
    ends: str,
) -> None:
    pid, robot = control_that(ends)
    assert answers_until_limp(robot) == []
    _, status = os.waitpid(pid, 0)
    assert os.WEXITSTATUS(status) == 0
    robot.close()
