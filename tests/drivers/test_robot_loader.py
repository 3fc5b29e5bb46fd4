"""Test that a user's robot is loaded, and an invalid one refused."""

import sys
from math import nan
from pathlib import Path
from typing import Any

import pytest

from joint_fakes import FakeRobot
from stepaside.core.errors import ConfigurationError
from stepaside.drivers.robot import HeadLimits, VelocityLimits, VelocityRobot
from stepaside.drivers.robot_loader import check_robot_class, load_robot_class
from stored_values import rows_of

VALID = """
import stepaside as sa

class Robot(sa.VelocityRobot):
    limits = sa.VelocityLimits(forward=0.5, backward=0.4, turn=1.0)

    def listen(self):
        return None

    def command(self, forward, lateral, turn):
        self.last = forward, lateral, turn
"""
LIMITS = "sa.VelocityLimits(forward=0.5, backward=0.4, turn=1.0)"


def robot_file(folder: Path, text: str) -> str:
    file = folder / "robot.py"
    file.write_text(text, encoding="utf-8")
    return f"{file}:Robot"


def test_a_robot_of_a_file_is_loaded(tmp_path: Path) -> None:
    kind = load_robot_class(robot_file(tmp_path, VALID))
    assert issubclass(kind, VelocityRobot) and kind.keeps_walking
    assert kind.limits == VelocityLimits(0.5, 0.4, 1.0)


def test_to_stop_is_to_command_zero_where_the_sdk_has_no_other_way(
    tmp_path: Path,
) -> None:
    robot = load_robot_class(robot_file(tmp_path, VALID))()
    assert isinstance(robot, VelocityRobot)
    robot.stop()
    assert vars(robot)["last"] == (0.0, 0.0, 0.0)


def test_a_file_that_fails_later_leaves_what_it_was_before(
    tmp_path: Path,
) -> None:
    kind = load_robot_class(robot_file(tmp_path, VALID))
    with pytest.raises(ConfigurationError, match="fails to run: ZeroDiv"):
        load_robot_class(robot_file(tmp_path, "1 / 0"))
    assert vars(sys.modules[kind.__module__])["Robot"] is kind


@pytest.mark.parametrize(
    ("before", "after", "said"),
    rows_of("test_an_invalid_class_is_refused_by_the_name_of_what_is_wrong"),
)
def test_an_invalid_class_is_refused_by_the_name_of_what_is_wrong(
    before: str, after: str, said: str, tmp_path: Path
) -> None:
    assert before in VALID
    text = VALID.replace(before, after, 1)
    with pytest.raises(ConfigurationError, match=said):
        load_robot_class(robot_file(tmp_path, text))


@pytest.mark.parametrize(
    ("changes", "said"),
    [
        ({"tick": 5.0}, r"tick must be in \[0.001, 0.1\] s, got 5.0"),
        ({"joints": "hip"}, "joints must be the names of the joints"),
        ({"paced": 1}, "paced must be True or False"),
        ({"gains": {"hip": (1.0,)}}, "gains of hip must be a stiffness"),
        ({"gains": {"hip": (nan, 1.0)}}, "gains of hip"),
    ],
)
def test_an_invalid_class_of_joints_is_refused(
    changes: dict[str, Any], said: str
) -> None:
    kind = type("Changed", (FakeRobot,), changes)
    with pytest.raises(ConfigurationError, match=f"robot r.py:R: {said}"):
        check_robot_class(kind, "robot r.py:R")


@pytest.mark.parametrize(
    ("changes", "said"),
    [
        ({"head": HeadLimits(90.0, 0.3, 0.3)}, "head must be HeadLimits"),
        ({"head": HeadLimits(1.0, nan, 0.3)}, "head must be HeadLimits"),
        ({"head": 1.0}, "head must be HeadLimits"),
        ({"head": HeadLimits(1.0, 0.3, 0.3)}, r"head needs the method look"),
    ],
)
def test_an_invalid_camera_is_refused(
    changes: dict[str, Any], said: str, tmp_path: Path
) -> None:
    kind = load_robot_class(robot_file(tmp_path, VALID))
    changed = type("Changed", (kind,), changes)
    with pytest.raises(ConfigurationError, match=said):
        check_robot_class(changed, "robot r.py:R")
