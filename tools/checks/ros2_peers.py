"""Check our ROS 2 topics against real ROS 2 nodes, in both directions.

    make ros2-peers

creates an environment for each distribution (``.venv-ros2-jazzy``,
``.venv-ros2-kilted``: Python 3.12 and the wheels of ``rclpy``, Fast DDS and
the standard messages), or

    python tools/checks/ros2_peers.py jazzy=/path/to/python

uses a Python that has them. For Humble, which has no wheels,

    python tools/checks/ros2_peers.py humble=dds:/path/to/python

runs the same nodes on CycloneDDS 0.10, its middleware (``cyclone_node.py``).
All nodes are in a separate domain on the
loopback interface (``ROS_AUTOMATIC_DISCOVERY_RANGE=LOCALHOST``). The result is
written to ``docs/results/ros2-peers.json``; the exit status is 1 if a message
was not received.
"""

import argparse
import json
import os
import signal
import subprocess
import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from math import atan2, hypot
from pathlib import Path
from queue import Empty, SimpleQueue
from tempfile import TemporaryFile
from threading import Thread
from time import monotonic, sleep
from typing import Any

import numpy as np
import ros2_peer as peer

from stepaside.core.poses import Pose
from stepaside.drivers.robot_loader import RobotRequest
from stepaside.drivers.ros2 import make_robot
from stepaside.drivers.ros2_dds import DdsParticipant, take_messages
from stepaside.drivers.ros2_server import Ros2Server, WorldClock
from stepaside.perception.camera_model import CameraModel
from stepaside.perception.images import ColourImage
from stepaside.perception.measurement import RobotState, Sighting
from stepaside.strategies.velocity_set import BodyVelocity
from stepaside.studies.results_version import RESULTS, library_versions

RESULT = Path("docs/results/ros2-peers.json")
DOMAIN = 60 + os.getpid() % 40  # separate ROS 2 domain
LONGEST = 60.0  # timeout for messages, in [s]
WALKED = 2.0  # duration of a walk of play, or of a served duel, in [s]
TICK = 0.012
WITHOUT_ROS = "dds:"  # before a Python that has CycloneDDS and no rclpy
KINDS = ("Twist", "TwistStamped")
REST = BodyVelocity(0.0, 0.0, 0.0)
ASKED = BodyVelocity(peer.ASKED[0], 0.0, peer.ASKED[1])
TYPES = {
    "odom": "nav_msgs/Odometry",
    "joint_states": "sensor_msgs/JointState",
    "ideal_sight": "geometry_msgs/PointStamped",
    "other": "geometry_msgs/PointStamped",
    "camera/image_raw": "sensor_msgs/Image",
    "camera/image_raw/compressed": "sensor_msgs/CompressedImage",
    "camera/camera_info": "sensor_msgs/CameraInfo",
    "robot_description": "std_msgs/String",
    "/clock": "rosgraph_msgs/Clock",
}


class Peer:
    """ROS 2 node in a process of its own."""

    def __init__(self, python: str, part: str, *words: str) -> None:
        """Start it."""
        if python.startswith(WITHOUT_ROS):
            python = python.removeprefix(WITHOUT_ROS)
            words = (*words, "--without-ros")
        self._process = subprocess.Popen(
            [python, str(Path(peer.__file__)), part, *words],
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            text=True,
        )
        self._lines: SimpleQueue[str] = SimpleQueue()
        self._reads = Thread(target=self._read, daemon=True)
        self._reads.start()
        self.told: dict[str, Any] = {"complete": False, "heard": {}}

    def _read(self) -> None:
        for line in self._process.stdout or ():
            self._lines.put(line)

    @property
    def complete(self) -> bool:
        """Return whether the node has received all expected messages."""
        try:
            while True:
                self.told = json.loads(self._lines.get_nowait())
        except Empty:
            return bool(self.told["complete"])

    def end(self) -> dict[str, Any]:
        """End the node; return what it received."""
        assert self._process.stdin is not None
        try:
            self._process.stdin.close()
            self._process.wait(LONGEST)
        except (OSError, subprocess.TimeoutExpired):
            self._process.kill()
            self._process.wait()
        self._reads.join(LONGEST)
        assert self.complete in (True, False)
        return self.told


@contextmanager
def started(python: str, part: str, *words: str) -> Iterator[Peer]:
    """Run a node within a context."""
    node = Peer(python, part, *words)
    try:
        yield node
    finally:
        node.end()


def until(done: Callable[[], bool], longest: float = LONGEST) -> bool:
    """Repeat until a condition holds; return whether it did."""
    end = monotonic() + longest
    while not done():
        if monotonic() > end:
            return False
        sleep(0.002)
    return True


def row(
    what: str, kind: str, way: str, heard: int | None, right: bool
) -> dict[str, Any]:
    """Return one row of the result.

    Args:
        what: Topic or action.
        kind: Message type.
        way: Sender and receiver.
        heard: Number of messages; None if none is expected.
        right: Whether all messages are as sent.
    """
    enough = heard is None or heard >= peer.enough(what)
    return {
        "topic": what,
        "type": kind,
        "way": way,
        "heard": heard,
        "passed": enough and right,
    }


def ros_type(topic: str) -> str:
    """Return the type of a topic, as ROS 2 names it."""
    return TYPES[topic].replace("/", "/msg/")


class Sensors:
    """Subscriptions to a ROS 2 robot beyond those of a body."""

    def __init__(self, dds: DdsParticipant) -> None:
        """Take part in its topics."""
        kinds = {
            "odom": self.odometry,
            "joint_states": self.joints,
            "camera/image_raw": self.image,
            "camera/image_raw/compressed": self.squeezed,
        }
        self._readers = {
            name: (dds.reader(f"/theirs/{name}", ros_type(name)), right)
            for name, right in kinds.items()
        }
        self.heard = peer.Heard(*kinds, "other")

    def look(self) -> None:
        """Read all new messages."""
        for name, (reader, right) in self._readers.items():
            for message in take_messages(reader):
                self.heard.note(name, right(message))

    def close(self) -> None:
        """Leave the topics."""
        self._readers.clear()

    @staticmethod
    def odometry(message: Any) -> bool:
        """Return whether odometry is as sent."""
        return (
            message.child_frame_id == peer.FRAME
            and peer.exact(message.pose.covariance, peer.COVARIANCE)
            and peer.exact(message.twist.covariance, peer.COVARIANCE[::-1])
        )

    @staticmethod
    def joints(message: Any) -> bool:
        """Return whether joint states are as sent."""
        return (
            peer.exact(message.name, peer.NAMES)
            and peer.exact(message.position, peer.ANGLES)
            and peer.exact(message.velocity, peer.RATES)
            and peer.exact(message.effort, peer.EFFORTS)
        )

    @staticmethod
    def image(message: Any) -> bool:
        """Return whether an image is as sent."""
        return bytes(message.data) == peer.PIXELS

    @staticmethod
    def squeezed(message: Any) -> bool:
        """Return whether a compressed image is as sent."""
        return bytes(message.data) == peer.PIXELS[:1000]


def their_robot(python: str, kind: str) -> Iterator[dict[str, Any]]:
    """Check our body at a ROS 2 robot that takes one type of command."""
    dds = DdsParticipant(DOMAIN)
    sensors = Sensors(dds)
    robot = make_robot(RobotRequest("/theirs", domain=DOMAIN))()
    robot.open()
    robot.prepare()
    with started(python, "robot", "--command", kind) as node:

        def done() -> bool:
            sensors.look()
            report = robot.listen()
            if report is not None:
                robot.command(*(REST if report.hindrance else ASKED))
                if report.sighting is not None:
                    seen = report.sighting
                    x, y = peer.OTHER
                    right = seen.bearing == atan2(y, x)
                    right &= seen.distance == hypot(x, y)
                    sensors.heard.note("other", right)
            return sensors.heard.complete and node.complete

        until(done)
        sensors.close()
        robot.close()
        told = node.end()
    if kind == KINDS[0]:
        for name, count in sensors.heard.count.items():
            right = sensors.heard.right[name]
            yield row(name, TYPES[name], "ROS 2 to us", count, right)
    count, right = told["heard"].get(kind, 0), told.get("right", {})
    right = right.get(kind, False)
    yield row("cmd_vel", f"geometry_msgs/{kind}", "us to ROS 2", count, right)


class Walker:
    """Robot to be served: it stands, and its camera shows a pattern."""

    ready = True

    def __init__(self) -> None:
        """Begin at a time and a place."""
        self.time, self.velocity = 3.0, REST

    def command(self, velocity: BodyVelocity) -> None:
        """Take a command."""
        self.velocity = velocity

    def look(self, angles: Any) -> None:
        """Nothing to turn."""

    def torso(self) -> None:
        """Do not know where the torso is."""

    def state(self) -> RobotState:
        """Return the state of the robot."""
        shape = peer.HEIGHT, peer.WIDTH, 3
        pixels = np.frombuffer(peer.PIXELS, np.uint8).reshape(shape)
        x, y = peer.OTHER
        model = CameraModel(peer.WIDTH, peer.HEIGHT, peer.FOCAL, peer.FOCAL)
        return RobotState(
            self.time,
            np.array(peer.ANGLES),
            sighting=Sighting(self.time, atan2(y, x), hypot(x, y)),
            percepts=(ColourImage(self.time, model, pixels),),
            pose=Pose(*peer.START, 0.0),
        )


def our_robot(python: str, kind: str) -> Iterator[dict[str, Any]]:
    """Check a ROS 2 commander at our server."""
    dds = DdsParticipant(DOMAIN)
    walker: Any = Walker()
    server = Ros2Server(
        *(dds, "/ours", walker, peer.NAMES, WorldClock(dds)),
        tick=TICK,
        urdf=peer.URDF,
    )
    obeyed = 0
    words = ("--namespace", "/ours", "--command", kind)
    with started(python, "commander", *words) as node:

        def done() -> bool:
            nonlocal obeyed
            server.speak()
            walker.time += TICK
            server.act()
            obeyed += walker.velocity == ASKED
            sleep(TICK)
            return node.complete and obeyed >= peer.ENOUGH

        until(done)
        told = node.end()
    server.close()
    dds.close()
    if kind == KINDS[0]:
        for name, count in told["heard"].items():
            right = told["right"][name]
            yield row(name, TYPES[name], "us to ROS 2", count, right)
    right = not server.refused
    yield row("cmd_vel", f"geometry_msgs/{kind}", "ROS 2 to us", obeyed, right)


def command(name: str, *words: str, **streams: Any) -> "subprocess.Popen[str]":
    """Start a command of this package."""
    code = "from stepaside.cli.main import main; main()"
    domain = ("--domain", str(DOMAIN))
    return subprocess.Popen(
        [sys.executable, "-c", code, name, *words, *domain],
        text=True,
        **streams,
    )


def played(python: str, kind: str) -> dict[str, Any]:
    """Check ``stepaside play`` at a ROS 2 robot, and without one."""
    words = ("ros2:/theirs", "--role", "pursuer")
    with TemporaryFile("w+") as said:
        with started(python, "robot", "--command", kind) as node:
            process = command(
                "play", *words, "--duration", str(WALKED), stderr=said
            )

            def done() -> bool:
                said.seek(0)
                waits = "nothing subscribes to /theirs/cmd_vel" in said.read()
                return (waits and kind == "none") or process.poll() is not None

            ended = until(done) and kind != "none"
            if process.poll() is None:
                process.send_signal(signal.SIGINT)
            process.wait(LONGEST)
            told = node.end()
        said.seek(0)
        words_said = said.read()
    if kind == "none":
        right = "nothing subscribes to /theirs/cmd_vel" in words_said
        right &= "walking" not in words_said
        name = "play waits where nothing subscribes to cmd_vel"
        return row(name, "-", "us to ROS 2", None, right)
    right = ended and process.returncode == 0 and "walking" in words_said
    right &= told.get("way_m", 0.0) > 0.0
    count = told["heard"].get(kind, 0)
    name = "play walks a robot"
    return row(name, f"geometry_msgs/{kind}", "us to ROS 2", count, right)


def served(python: str, kind: str) -> dict[str, Any]:
    """Check ``stepaside serve`` with a robot that ROS 2 commands."""
    world = command(
        *("serve", "--ros2", "pursuer=/ours", "--json"),
        *("--duration", str(WALKED), "--wait", str(LONGEST)),
        stdout=subprocess.PIPE,
        stderr=subprocess.DEVNULL,
    )
    words = ("--namespace", "/ours", "--command", kind)
    with started(python, "commander", *words) as node:
        output, _ = world.communicate(timeout=3.0 * LONGEST)
        told = node.end()
    right = world.returncode == 0
    right = right and json.loads(output)["outcome"] == "completed"
    right &= told.get("way_m", 0.0) > 0.0
    count = told["heard"].get("odom", 0)
    name = "serve's robot is walked"
    return row(name, f"geometry_msgs/{kind}", "ROS 2 to us", count, right)


def checked(python: str) -> Iterator[dict[str, Any]]:
    """Run all checks with one distribution."""
    for kind in KINDS:
        yield from their_robot(python, kind)
        yield from our_robot(python, kind)
    for kind in KINDS:
        yield played(python, kind)
        yield served(python, kind)
    yield played(python, "none")


def main() -> int:
    """Check each distribution; return 1 if any check failed."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument(
        "pythons",
        nargs="+",
        metavar="NAME=PYTHON",
        help="a distribution and a Python that has its rclpy, or dds: and "
        "one that has CycloneDDS",
    )
    parser.add_argument("--output", type=Path, default=RESULT)
    arguments = parser.parse_args()
    os.environ["ROS_AUTOMATIC_DISCOVERY_RANGE"] = "LOCALHOST"
    os.environ["PYTHONPATH"] = str(Path("src").resolve())  # cyclone_node.py
    os.environ["ROS_DOMAIN_ID"] = str(DOMAIN)
    os.environ["RMW_IMPLEMENTATION"] = "rmw_fastrtps_cpp"
    found = []
    for entry in arguments.pythons:
        name, _, python = entry.partition("=")
        bare = python.removeprefix(WITHOUT_ROS)
        asks = [bare, str(Path(peer.__file__)), "versions"]
        own = json.loads(subprocess.check_output(asks, text=True))
        rows = []
        for each in checked(python):
            state = "passed" if each["passed"] else "FAILED"
            words = f"{each['way']}, {each['topic']}, {each['type']}"
            heard = "" if each["heard"] is None else f"{each['heard']} heard, "
            print(f"{name}: {words}: {heard}{state}", flush=True)
            rows.append(each)
        found.append({"name": name.capitalize(), **own, "rows": rows})
    settings = {"walked_s": WALKED, "enough": peer.ENOUGH}
    names = " ".join(entry.partition("=")[0] for entry in arguments.pythons)
    result = {
        "command": f"make ros2-peers ROS2='{names}'",
        "results": RESULTS,
        "libraries": library_versions(),
        "settings": settings,
        "distributions": found,
    }
    arguments.output.write_text(json.dumps(result, indent=1) + "\n", "utf-8")
    passed = all(r["passed"] for each in found for r in each["rows"])
    return 0 if passed else 1


if __name__ == "__main__":
    sys.exit(main())
