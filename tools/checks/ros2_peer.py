"""Node of real ROS 2: a robot, or a commander of one.

``tools/checks/ros2_peers.py`` starts it with a Python that has ``rclpy``, and
ends it by closing its standard input. It prints the messages received as lines
of JSON, the last of which counts; ``"complete": true`` means that all expected
messages have arrived.
"""

import argparse
import json
import sys
from importlib.metadata import distributions
from math import cos, hypot, sin
from threading import Thread
from typing import Any

NAMES = ["LKneePitch", "RKneePitch"]
ANGLES, RATES, EFFORTS = [0.1, -0.2], [1.5, -2.5], [0.25, 0.75]
HEIGHT, WIDTH = 120, 160
PIXELS = bytes(i % 251 for i in range(3 * HEIGHT * WIDTH))
COVARIANCE = [0.25 * i for i in range(36)]
START = (1.25, -0.5)  # position of the robot, in [m]
OTHER = (2.0, 0.5)  # position of the opponent in the robot's frame, in [m]
ASKED = (0.05, -0.25)  # velocity, in [m/s] and [rad/s]
PERIOD = 0.05  # between two messages, in [s]
ENOUGH = 5  # messages of each kind
ONCE = ("robot_description",)  # what is published once, before readers come
URDF = '<robot name="ours"/>'
FOCAL = 100.0  # of the camera, in [px]
FRAME = "theirs/base_link"


def exact(found: Any, wanted: Any) -> bool:
    """Return whether numbers are equal to the last bit."""
    return list(found) == list(wanted)


def enough(name: str) -> int:
    """Return how many messages of a topic are expected."""
    return 1 if name in ONCE else ENOUGH


class Heard:
    """Received messages: their number, and whether all were correct."""

    def __init__(self, *names: str) -> None:
        """Begin with nothing."""
        self.count = dict.fromkeys(names, 0)
        self.right = dict.fromkeys(names, True)

    def note(self, name: str, right: bool = True) -> None:
        """Count a message."""
        self.count[name] += 1
        self.right[name] &= right

    @property
    def complete(self) -> bool:
        """Return whether enough messages of each kind have arrived."""
        return all(n >= enough(name) for name, n in self.count.items())


def say(heard: Heard, **more: Any) -> None:
    """Print the received messages."""
    told = {"complete": heard.complete, "heard": heard.count}
    print(json.dumps({**told, "right": heard.right, **more}), flush=True)


class Robot:
    """Unicycle that takes velocity commands of one type, or of none."""

    def __init__(self, node: Any, kind: str) -> None:
        """Publish what a robot publishes in its namespace."""
        from geometry_msgs.msg import PointStamped, Twist, TwistStamped
        from nav_msgs.msg import Odometry
        from sensor_msgs.msg import CompressedImage, Image, JointState

        self.node, self.kind = node, kind
        self.heard = Heard(*([kind] if kind != "none" else []))
        self.x, self.y = START
        self.heading, self.forward, self.turn = 0.0, 0.0, 0.0
        self.way = 0.0
        self.stamps: set[tuple[int, int]] = set()

        def publisher(name: str, message: type[Any]) -> Any:
            return node.create_publisher(message, name, 10)

        self.odometry = publisher("odom", Odometry)
        self.joints = publisher("joint_states", JointState)
        self.other = publisher("other", PointStamped)
        self.image = publisher("camera/image_raw", Image)
        self.squeezed = publisher(
            "camera/image_raw/compressed", CompressedImage
        )
        kinds = {"Twist": Twist, "TwistStamped": TwistStamped}
        if kind in kinds:
            take = self.take if kind == "Twist" else self.take_stamped
            node.create_subscription(kinds[kind], "cmd_vel", take, 10)
        node.create_timer(PERIOD, self.tell)

    def take(self, twist: Any) -> None:
        """Apply a velocity command."""
        self.forward, self.turn = twist.linear.x, twist.angular.z
        asked = self.forward, self.turn
        if asked != (0.0, 0.0):
            self.heard.note(self.kind, exact(asked, ASKED))

    def take_stamped(self, message: Any) -> None:
        """Apply a stamped velocity command."""
        stamp = message.header.stamp.sec, message.header.stamp.nanosec
        if stamp in self.stamps and message.header.frame_id == FRAME:
            self.take(message.twist)

    def tell(self) -> None:
        """Move, and publish all topics."""
        from geometry_msgs.msg import PointStamped
        from nav_msgs.msg import Odometry
        from sensor_msgs.msg import CompressedImage, Image, JointState

        self.x += self.forward * PERIOD * cos(self.heading)
        self.y += self.forward * PERIOD * sin(self.heading)
        self.heading += self.turn * PERIOD
        self.way += abs(self.forward) * PERIOD
        stamp = self.node.get_clock().now().to_msg()
        self.stamps.add((stamp.sec, stamp.nanosec))
        odometry = Odometry(child_frame_id=FRAME)
        odometry.header.stamp, odometry.header.frame_id = stamp, "theirs/odom"
        place, turned = odometry.pose.pose.position, odometry.pose.pose
        place.x, place.y = self.x, self.y
        turned.orientation.z = sin(0.5 * self.heading)
        turned.orientation.w = cos(0.5 * self.heading)
        odometry.pose.covariance = COVARIANCE
        odometry.twist.covariance = COVARIANCE[::-1]
        joints = JointState(
            name=NAMES, position=ANGLES, velocity=RATES, effort=EFFORTS
        )
        image = Image(height=HEIGHT, width=WIDTH, encoding="rgb8")
        image.step, image.data = 3 * WIDTH, PIXELS
        squeezed = CompressedImage(format="jpeg", data=PIXELS[:1000])
        other = PointStamped()
        other.point.x, other.point.y = OTHER
        for message in (joints, image, squeezed, other):
            message.header.stamp, message.header.frame_id = stamp, FRAME
        self.joints.publish(joints)
        self.image.publish(image)
        self.squeezed.publish(squeezed)
        self.other.publish(other)
        self.odometry.publish(odometry)

    @property
    def more(self) -> dict[str, Any]:
        """Return the distance travelled, in [m]."""
        return {"way_m": self.way}


class Commander:
    """Commander of a robot that listens to all its topics."""

    def __init__(self, node: Any, kind: str) -> None:
        """Take part in the topics of a namespace."""
        from geometry_msgs.msg import PointStamped, Twist, TwistStamped
        from nav_msgs.msg import Odometry
        from rclpy.qos import DurabilityPolicy, QoSProfile
        from rosgraph_msgs.msg import Clock
        from sensor_msgs.msg import (
            CameraInfo,
            CompressedImage,
            Image,
            JointState,
        )
        from std_msgs.msg import String

        self.node, self.kind = node, kind
        kinds = {"Twist": Twist, "TwistStamped": TwistStamped}
        self.writer = node.create_publisher(kinds[kind], "cmd_vel", 10)
        self.message = kinds[kind]()
        self.places: list[tuple[float, float]] = []
        sensors = {
            "odom": (Odometry, self.odometry),
            "joint_states": (JointState, self.joints),
            "ideal_sight": (PointStamped, self.sight),
            "camera/image_raw": (Image, self.image),
            "camera/image_raw/compressed": (CompressedImage, self.squeezed),
            "camera/camera_info": (CameraInfo, self.calibration),
            "robot_description": (String, self.description),
            "/clock": (Clock, self.clock),
        }
        self.heard = Heard(*sensors)
        for name, (message, take) in sensors.items():
            quality: Any = 10
            if name in ONCE:
                latched = DurabilityPolicy.TRANSIENT_LOCAL
                quality = QoSProfile(depth=1, durability=latched)
            node.create_subscription(message, name, take, quality)
        node.create_timer(PERIOD, self.command)

    def command(self) -> None:
        """Publish a velocity command."""
        stamped = self.kind == "TwistStamped"
        twist = self.message.twist if stamped else self.message
        twist.linear.x, twist.angular.z = ASKED
        if stamped:
            self.message.header.stamp = self.node.get_clock().now().to_msg()
        self.writer.publish(self.message)

    def odometry(self, message: Any) -> None:
        """Check odometry: position on the floor, and velocity."""
        place = message.pose.pose.position
        self.places.append((place.x, place.y))
        twist = message.twist.twist
        moves = twist.linear.x, twist.angular.z
        frames = message.header.frame_id, message.child_frame_id
        ours = frames == ("ours/odom", "ours/base_footprint")
        ours = ours and (place.x, place.y) == START
        spread = message.pose.covariance, message.twist.covariance
        known = all(each[7 * i] > 0.0 for each in spread for i in range(6))
        right = ours and known and moves in ((0.0, 0.0), ASKED)
        self.heard.note("odom", right)

    def joints(self, message: Any) -> None:
        """Check joint states."""
        right = exact(message.name, NAMES) and exact(message.position, ANGLES)
        self.heard.note("joint_states", right)

    def sight(self, message: Any) -> None:
        """Check the position of the opponent."""
        away = hypot(message.point.x - OTHER[0], message.point.y - OTHER[1])
        self.heard.note("ideal_sight", away < 1e-12)

    def image(self, message: Any) -> None:
        """Check an image."""
        size = message.height, message.width, message.step, message.encoding
        right = size == (HEIGHT, WIDTH, 3 * WIDTH, "rgb8")
        self.heard.note(
            "camera/image_raw", right and bytes(message.data) == PIXELS
        )

    def squeezed(self, message: Any) -> None:
        """Check a JPEG image."""
        begins = bytes(message.data[:2]) == b"\xff\xd8"
        self.heard.note(
            "camera/image_raw/compressed", message.format == "jpeg" and begins
        )

    def calibration(self, message: Any) -> None:
        """Check the calibration of the camera."""
        k, frame = message.k, message.header.frame_id
        right = (message.width, message.height) == (WIDTH, HEIGHT)
        right = right and (k[0], k[4]) == (FOCAL, FOCAL)
        right = right and frame == "ours/camera_optical_frame"
        self.heard.note("camera/camera_info", right)

    def description(self, message: Any) -> None:
        """Check the URDF."""
        known = message.data == URDF or "base_link" in message.data
        self.heard.note("robot_description", known)

    def clock(self, message: Any) -> None:
        """Check the simulation time."""
        self.heard.note("/clock", message.clock.sec < 1000)

    @property
    def more(self) -> dict[str, Any]:
        """Return the robot's distance from its first position, in [m]."""
        if not self.places:
            return {"way_m": 0.0}
        (x, y), (u, v) = self.places[0], self.places[-1]
        return {"way_m": hypot(u - x, v - y)}


def versions() -> dict[str, str]:
    """Return the versions of the middleware and of rclpy."""
    found = {each.metadata["Name"]: each.version for each in distributions()}
    fast = found.get("ros-fastdds") or found.get("ros-fastrtps", "none")
    if fast == "none":
        version = found.get("cyclonedds", "none")
        return {"middleware": f"CycloneDDS {version}, no rclpy"}
    rclpy = found.get("ros-rclpy", "none")
    return {"middleware": f"Fast DDS {fast}", "rclpy": rclpy}


def main() -> None:
    """Run the node until standard input is closed."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("part", choices=("robot", "commander", "versions"))
    parser.add_argument("--namespace", default="/theirs")
    kinds = ("Twist", "TwistStamped", "none")
    parser.add_argument("--command", choices=kinds, default="Twist")
    parser.add_argument("--without-ros", action="store_true")
    arguments = parser.parse_args()
    if arguments.part == "versions":
        print(json.dumps(versions()))
        return
    if arguments.without_ros:
        from cyclone_node import install

        install()
    import rclpy

    rclpy.init()
    node = rclpy.create_node("peer", namespace=arguments.namespace)
    make = Robot if arguments.part == "robot" else Commander
    peer = make(node, arguments.command)
    waits = Thread(target=sys.stdin.read, daemon=True)
    waits.start()
    told = False
    while waits.is_alive():
        rclpy.spin_once(node, timeout_sec=PERIOD)
        if peer.heard.complete and not told:
            told = True
            say(peer.heard, **peer.more)
    say(peer.heard, **peer.more)
    node.destroy_node()
    rclpy.shutdown()


if __name__ == "__main__":
    main()
