"""Test simulated robots on ROS 2 topics."""

import os
from collections.abc import Iterator
from math import inf, nan
from typing import Any

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

pytest.importorskip("cyclonedds")

from stepaside.core.poses import Pose  # noqa: E402
from stepaside.core.rotations import rotation  # noqa: E402
from stepaside.drivers.robot import REST  # noqa: E402
from stepaside.drivers.ros2_dds import (  # noqa: E402
    DdsParticipant,
    header,
    make,
    seconds,
    take_messages,
    vector,
)
from stepaside.drivers.ros2_server import (  # noqa: E402
    REPORTS,
    Ros2Server,
    WorldClock,
    rotation_message,
)
from stepaside.strategies.velocity_set import BodyVelocity  # noqa: E402

from velocity_fakes import SimulatedUnicycle, until  # isort: skip  # noqa: E402

DOMAIN = 20 + os.getpid() % 200
TICK = 0.012
TWIST, STAMPED = "geometry_msgs/msg/Twist", "geometry_msgs/msg/TwistStamped"


def twist(forward: float, lateral: float = 0.0, turn: float = 0.0) -> Any:
    return make(
        "geometry_msgs/Twist", vector(forward, lateral), vector(z=turn)
    )


class Scene:
    """Served robot, and a participant of others."""

    def __init__(self, **more: Any) -> None:
        self.dds, self.other = DdsParticipant(DOMAIN), DdsParticipant(DOMAIN)
        self.walker = SimulatedUnicycle()
        self.server = Ros2Server(
            self.dds,
            "/nao",
            self.walker,
            ["LKneePitch", "RKneePitch"],
            WorldClock(self.dds),
            tick=TICK,
            **more,
        )
        self.commands: list[Any] = []

    def round(self) -> BodyVelocity:
        """One tick of the world."""
        self.server.speak()
        self.server.hear()
        self.server.act()
        self.walker.move(self.walker.commanded, TICK)
        return self.walker.commanded

    def obeys(self, message: Any, kind: str = TWIST) -> BodyVelocity:
        """Command until the robot does something else than rest."""
        if not self.commands:
            self.commands.append(self.other.writer("/nao/cmd_vel", kind))

        def moved() -> Any:
            self.commands[-1].write(message)
            return self.round() != REST and self.walker.commanded

        found: BodyVelocity = until(moved)
        return found

    def read(self, topic: str, kind: str) -> Any:
        """Return the next message of a topic."""
        readers = [self.other.reader(topic, kind)]
        found = until(lambda: (self.round(), take_messages(readers[0]))[1])
        readers.clear()
        return found[-1]


@pytest.fixture
def scene() -> Iterator[Scene]:
    made = Scene()
    yield made
    made.server.close()
    made.dds.close()
    made.other.close()


def test_a_served_robot_follows_stamped_commands_sideways_too(
    scene: Scene,
) -> None:
    message = make(
        "geometry_msgs/TwistStamped",
        *(header(3.0, "base_link"), twist(0.05, -0.02, 0.1)),
    )
    assert scene.obeys(message, STAMPED) == BodyVelocity(0.05, -0.02, 0.1)
    assert scene.server.connected and not scene.server.refused
    odometry = scene.read("/nao/odom", "nav_msgs/msg/Odometry")
    linear, angular = odometry.twist.twist.linear, odometry.twist.twist.angular
    assert odometry.header.frame_id == "nao/odom"
    variances = odometry.pose.covariance[::7]
    assert min(variances) > 0.0 and max(variances[2:5]) < min(variances[:2])
    assert (linear.x, linear.y, angular.z) == (0.05, -0.02, 0.1)
    scene.commands.clear()
    until(lambda: scene.round() == REST and not scene.server.connected)


def test_time_frames_and_joints_are_published(scene: Scene) -> None:
    scene.walker.pose = Pose(1.0, -2.0, 2.5)
    torso = (0.02, 0.1, 0.3), (0.1, -0.2, 0.0)
    scene.walker.torso = lambda: torso  # type: ignore[assignment]
    tf = scene.read("/tf", "tf2_msgs/msg/TFMessage")
    transform, base = tf.transforms
    assert transform.header.frame_id == "nao/odom"
    assert transform.child_frame_id == "nao/base_footprint"
    assert base.header.frame_id == "nao/base_footprint"
    place, tilt = base.transform.translation, base.transform.rotation
    assert (place.x, place.y, place.z) == torso[0]
    assert (tilt.x > 0.0, tilt.y < 0.0) == (True, True)
    move, turn = transform.transform.translation, transform.transform.rotation
    assert (move.x, move.y) == (1.0, -2.0)
    assert 2.0 * np.arctan2(turn.z, turn.w) == pytest.approx(2.5)
    joints = scene.read("/nao/joint_states", "sensor_msgs/msg/JointState")
    assert list(joints.position) == [0.1, 0.2]
    assert list(joints.name) == ["LKneePitch", "RKneePitch"]
    clock = scene.read("/clock", "rosgraph_msgs/msg/Clock")
    assert seconds(clock.clock) % REPORTS == pytest.approx(0, abs=1e-9)


def test_a_commanded_robot_is_silent_until_it_can_walk(scene: Scene) -> None:
    """Its pose stays while it calibrates, which a client takes for frozen."""
    readers = [scene.other.reader("/nao/odom", "nav_msgs/msg/Odometry")]
    until(lambda: (scene.round(), take_messages(readers[0]))[1])
    assert scene.obeys(twist(0.05))
    scene.walker.ready = False
    take_messages(readers[0])
    begun = scene.walker.time
    while scene.walker.time < begun + 5.0 * REPORTS:
        scene.round()
    assert not take_messages(readers[0])
    scene.walker.ready = True
    assert until(lambda: (scene.round(), take_messages(readers[0]))[1])
    readers.clear()


def test_a_late_reader_receives_the_description() -> None:
    scene = Scene(urdf="<robot/>")
    scene.round()
    readers = [
        scene.other.reader(
            "/nao/robot_description", "std_msgs/msg/String", latched=True
        )
    ]
    (message,) = until(lambda: take_messages(readers[0]))
    assert message.data == "<robot/>"
    readers.clear()
    scene.server.close()
    scene.dds.close()
    scene.other.close()


def test_a_commander_that_falls_silent_leaves_a_robot_at_rest(
    scene: Scene,
) -> None:
    assert scene.obeys(twist(0.05)).forward == 0.05
    moving = [scene.round() for _ in range(60)]
    assert moving[5].forward == 0.05 and moving[-1] == REST


@pytest.mark.parametrize("bad", [nan, inf])
def test_a_velocity_that_is_no_number_is_rest(
    scene: Scene, bad: float
) -> None:
    scene.obeys(twist(0.05))
    scene.commands[0].write(twist(0.05, bad))
    until(lambda: scene.round() == REST)
    assert scene.server.refused > 0


def test_a_second_commander_is_refused(scene: Scene) -> None:
    scene.obeys(twist(0.05))
    second = scene.other.writer("/nao/cmd_vel", TWIST)

    def refused() -> int:
        second.write(twist(-9.0))
        assert scene.round().forward in (0.05, 0.0)
        return scene.server.refused

    until(refused)


def test_one_of_the_other_type_waits_until_the_first_leaves(
    scene: Scene,
) -> None:
    scene.obeys(twist(0.05))
    second = scene.other.writer("/nao/cmd_vel", STAMPED)
    head = header(0.0, "")
    message = make("geometry_msgs/TwistStamped", head, twist(0.02))
    for _ in range(20):
        second.write(message)
        assert scene.round().forward in (0.05, 0.0)
    scene.commands.clear()
    until(lambda: (second.write(message), scene.round().forward)[1] == 0.02)


def test_in_lock_step_each_report_waits_for_its_answer() -> None:
    """One that is lost is repeated, as readers are best-effort."""
    scene = Scene(lock_step=True)
    scene.obeys(twist(0.01))
    reader = [scene.other.reader("/nao/odom", "nav_msgs/msg/Odometry")]
    until(reader[0].get_matched_publications)
    scene.server.begin()
    scene.server.speak()
    assert not scene.server.hear()
    first = until(lambda: take_messages(reader[0]))
    again = until(lambda: scene.server.hear() or take_messages(reader[0]))
    assert again[0].header.stamp == first[-1].header.stamp
    scene.commands[0].write(twist(0.02))
    until(scene.server.hear)
    scene.server.act()
    assert scene.walker.commanded.forward == 0.02
    for _ in range(round(REPORTS / TICK) - 1):
        scene.server.speak()
        assert scene.server.hear()
    reader.clear()
    scene.server.close()
    scene.dds.close()
    scene.other.close()


@pytest.mark.parametrize("roll", [-0.3, 0.0])
@pytest.mark.parametrize("pitch", [0.2, -1.0])
@pytest.mark.parametrize("heading", [0.0, 3.0])
def test_a_rotation_is_that_of_its_angles(
    roll: float, pitch: float, heading: float
) -> None:
    got = rotation_message(roll, pitch, heading)
    quaternion = np.array([got.x, got.y, got.z, got.w])
    assert np.linalg.norm(quaternion) == pytest.approx(1.0)
    np.testing.assert_allclose(
        Rotation.from_quat(quaternion).as_matrix(),
        rotation(roll, pitch, heading),
        atol=1e-12,
    )
