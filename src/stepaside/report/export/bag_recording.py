"""Recordings as ROS 2 bags in MCAP, for Foxglove, Rerun, PlotJuggler, rosbag2.

Each player has a namespace. Geometry is in types that Foxglove, Rerun and RViz
draw: transforms, URDF, poses and clouds of points. Frames follow REP 105 and
REP 120: ``map``, then ``NAME/odom``, ``NAME/base_footprint``,
``NAME/base_link`` and the links.
"""

from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any, NamedTuple
from xml.etree import ElementTree

import numpy as np

from ...core.poses import Array, Pose
from ...games.replayed_signals import RobotSignals
from ...games.run import Run
from ...perception.images import ColourImage
from ...robots.head import depth_camera_name
from ...robots.urdf_writer import IMU, OPTICAL
from ..overlays import overlays_of, soles
from .bag_messages import MessageFactory, nanoseconds
from .recorded_transforms import (
    base_poses,
    joint_poses,
    quaternion_of,
)
from .recording import Recording, RobotModel, foot_wrenches
from .room_model import RoomModel

MAP = "map"
DOTS = 12  # points of a segment
LANDED = 40  # soles that are shown at once
# Layers that are clouds of points, with their topics.
TOPICS = {
    "footsteps": "footsteps/landed",
    "pushes": "pushes",
    "safety radius": "safety_radius",
    "theoretical circle": "theoretical_circle",
}
POINTS = ("com", "com_reference", "zmp", "zmp_reference")


class TopicMessage(NamedTuple):
    """Message on a topic.

    Attributes:
        time: Time, in [s].
        topic: Name of the topic.
        kind: Type, like ``std_msgs/msg/String``.
        message: The message.
        stays: Whether late subscribers get it, too (transient local).
    """

    time: float
    topic: str
    kind: str
    message: Any
    stays: bool = False


def write_bag(
    folder: Path,
    recording: Recording,
    report: Callable[[int, int], None],
) -> None:
    """Write a ROS 2 bag in MCAP with URDF files.

    Args:
        folder: Existing folder; gets ``NAME.mcap`` and ``metadata.yaml``, so
            that it is a bag itself.
        recording: The recording.
        report: Called with the samples done and their number.
    """
    from rosbags.rosbag2 import CompressionMode, StoragePlugin, Writer
    from rosbags.rosbag2.enums import CompressionFormat

    factory = MessageFactory()
    bag = folder / recording.run.name
    writer = Writer(bag, version=9, storage_plugin=StoragePlugin.MCAP)
    writer.set_compression(CompressionMode.STORAGE, CompressionFormat.ZSTD)
    connections: dict[str, Any] = {}
    with writer:
        for time, topic, kind, message, stays in messages_of(
            recording, factory, report
        ):
            if topic not in connections:
                connections[topic] = writer.add_connection(
                    topic,
                    kind,
                    typestore=factory.store,
                    offered_qos_profiles=[_quality(stays=stays)],
                )
            data = factory.store.serialize_cdr(message, kind)
            writer.write(connections[topic], nanoseconds(time), data)
    for file in bag.iterdir():
        file.rename(folder / file.name)
    bag.rmdir()
    recording.write_urdf(folder)


def _quality(*, stays: bool) -> Any:
    """Return the quality of service with which a topic is played back."""
    from rosbags.interfaces import (
        Qos,
        QosDurability,
        QosHistory,
        QosLiveliness,
        QosReliability,
        QosTime,
    )

    forever = QosTime(2147483647, 4294967295)
    return Qos(
        QosHistory.KEEP_LAST,
        1 if stays else 10,
        QosReliability.RELIABLE,
        QosDurability.TRANSIENT_LOCAL if stays else QosDurability.VOLATILE,
        forever,
        forever,
        QosLiveliness.AUTOMATIC,
        forever,
        False,
    )


def messages_of(
    recording: Recording,
    factory: MessageFactory,
    report: Callable[[int, int], None],
) -> Iterator[TopicMessage]:
    """Yield all messages of a recording, in the order of their times.

    Args:
        recording: The recording.
        factory: Maker of messages.
        report: Called with the samples done and their number.
    """
    run = recording.run
    players = [PlayerTopics(recording, name, factory) for name in run.players]
    times = run.times
    room = RoomTopics(RoomModel(run), factory)
    static = [t for player in players for t in player.static_transforms()]
    static += room.transforms(None, float(times[0]))
    first = float(times[0])
    yield TopicMessage(
        first, "/tf_static", TF, factory.make(TF, static), stays=True
    )
    events = [m for player in players for m in player.events()]
    events += room.description(first)
    events += overlay_messages(run, factory)
    events.sort(key=lambda event: event.time)
    pending = iter(events)
    event = next(pending, None)
    for index, time in enumerate(times.tolist()):
        while event is not None and event.time <= time:
            yield event._replace(time=max(event.time, first))
            event = next(pending, None)
        moved = [t for p in players for t in p.transforms(index, time)]
        moved += room.transforms(index, time)
        yield TopicMessage(time, "/tf", TF, factory.make(TF, moved))
        for player in players:
            yield from player.sample(index, time)
        yield from _pair_numbers(run, factory, index, time)
        if index % 50 == 0:
            report(index, len(times))


TF = "tf2_msgs/msg/TFMessage"
POSE = "geometry_msgs/msg/PoseStamped"
CLOUD = "sensor_msgs/msg/PointCloud2"
NUMBER = "std_msgs/msg/Float64"


def overlay_messages(
    run: Run, factory: MessageFactory
) -> Iterator[TopicMessage]:
    """Yield what lies over the scene as clouds of points.

    Paths and lines of sight are left out, which programs draw from frames.
    """
    first = float(run.times[0])
    for overlay in overlays_of(run):
        name = TOPICS.get(overlay.layer)
        if name is None:
            continue
        topic = "/".join(["", overlay.owner, name]).replace("//", "/")
        frame = "".join(f"{own}/base_footprint" for own in overlay.follows)
        times = [first]
        if overlay.times is not None:
            times = sorted({*overlay.times.tolist()})
        for number, time in enumerate(times, 1):
            shown = overlay.segments
            if overlay.times is not None:
                oldest = times[max(0, number - LANDED)]
                at = overlay.times
                shown = shown[(at >= oldest) & (at <= time)]
            header = factory.header(time, frame or MAP)
            cloud = factory.points(header, dotted(shown))
            yield TopicMessage(time, topic, CLOUD, cloud, stays=True)


def dotted(segments: Array) -> Array:
    """Return points along segments on the floor. Shape (m, 3).

    Args:
        segments: Start and end (x, y), in [m]. Shape (n, 2, 2).
    """
    share = np.linspace(0.0, 1.0, DOTS, endpoint=False)[:, None]
    along = segments[:, None, 0] * (1.0 - share) + segments[:, None, 1] * share
    flat = along.reshape(-1, 2)
    return np.column_stack([flat, np.zeros(len(flat))])


class RoomTopics:
    """Messages of what is no robot: a URDF, and where its links are."""

    def __init__(self, room: RoomModel, factory: MessageFactory) -> None:
        """Find which shapes move."""
        self._room, self._factory = room, factory
        self._moves = dict(room.moved())
        first = self._moves.pop(0, [])
        later = self._moves.values()
        moving = {shape.frame for shapes in later for shape in shapes}
        self._static = [s for s in first if s.frame not in moving]
        self._moves[0] = [s for s in first if s.frame in moving]

    def transforms(self, index: int | None, time: float) -> list[Any]:
        """Return the transforms that change at a sample; None for static."""
        make = self._factory
        shapes = self._static if index is None else self._moves.get(index, ())
        return [
            make.transform(
                make.header(time, MAP),
                shape.frame,
                shape.position.tolist(),
                make.rotation(shape.quaternion.tolist()),
            )
            for shape in shapes
        ]

    def description(self, time: float) -> list[TopicMessage]:
        """Return the URDF, if there is a shape."""
        if not self._room.shapes:
            return []
        text, topic = self._room.urdf, "/room/robot_description"
        message = self._factory.text(text)
        return [TopicMessage(time, topic, TEXT, message, stays=True)]


def _pair_numbers(
    run: Run, factory: MessageFactory, index: int, time: float
) -> Iterator[TopicMessage]:
    """Yield distance and angle between the first two players."""
    if run.pair is not None:
        value = float(run.distance[index])
        message = factory.number(value)
        yield TopicMessage(time, "/distance_m", NUMBER, message)
    if run.has_orientation:
        value = float(np.radians(run.orientation[index]))
        message = factory.number(value)
        yield TopicMessage(time, "/angle_rad", NUMBER, message)


class PlayerTopics:
    """Messages of one player."""

    def __init__(
        self, recording: Recording, name: str, factory: MessageFactory
    ) -> None:
        """Prepare the arrays of a player.

        Args:
            recording: The recording.
            name: Name of the player.
            factory: Maker of messages.
        """
        run = recording.run
        self._name, self._factory = name, factory
        self._times, self._track = run.times, run.tracks[name]
        self._signals = recording.signals.get(name, RobotSignals())
        self._model: RobotModel | None = None
        self._footprints = self._track.unicycle
        self._odometry = Pose(*self._footprints[0].tolist())
        inverse = self._odometry.inverse()
        self._footprints_in_odometry = np.array(
            [
                inverse.compose(Pose(*pose))
                for pose in self._footprints.tolist()
            ]
        )
        qpos = self._track.qpos
        if qpos is not None and name in recording.models:
            self._model = recording.models[name]
            self._base = base_poses(qpos, self._footprints)
            self._joints = joint_poses(self._model, qpos)
            self._sole = run.settings.robot_of(name).gait.sole
        self._wrenches = (
            ()
            if self._signals.foot_forces is None or self._model is None
            else foot_wrenches(self._model, self._signals.foot_forces)
        )

    def _frame(self, name: str) -> str:
        return f"{self._name}/{name}"

    def _topic(self, name: str) -> str:
        return f"/{self._name}/{name}"

    def static_transforms(self) -> list[Any]:
        """Return the transforms that do not change."""
        make, first = self._factory, float(self._times[0])
        x, y, heading = self._odometry
        found = [
            make.transform(
                make.header(first, MAP),
                self._frame("odom"),
                (x, y, 0.0),
                make.upright(heading),
            )
        ]
        for joint in () if self._model is None else self._model.tree.joints:
            if joint.number is None:
                found.append(
                    make.transform(
                        make.header(first, self._frame(joint.parent)),
                        self._frame(joint.child),
                        joint.position.tolist(),
                        make.rotation(quaternion_of(joint.axes).tolist()),
                    )
                )
        return found

    def transforms(self, index: int, time: float) -> Iterator[Any]:
        """Yield the transforms of a sample."""
        make = self._factory
        x, y, heading = self._footprints_in_odometry[index].tolist()
        yield make.transform(
            make.header(time, self._frame("odom")),
            self._frame("base_footprint"),
            (x, y, 0.0),
            make.upright(heading),
        )
        if self._model is None:
            return
        yield make.transform(
            make.header(time, self._frame("base_footprint")),
            self._frame("base_link"),
            self._base[0][index].tolist(),
            make.rotation(self._base[1][index].tolist()),
        )
        for joint, positions, quaternions in self._joints:
            yield make.transform(
                make.header(time, self._frame(joint.parent)),
                self._frame(joint.child),
                positions[index].tolist(),
                make.rotation(quaternions[index].tolist()),
            )

    def sample(self, index: int, time: float) -> Iterator[TopicMessage]:
        """Yield the messages of a sample, other than transforms."""
        make = self._factory
        in_map = make.header(time, MAP)
        points: dict[str, Array | None] = {
            name: getattr(self._track, name) for name in POINTS
        }
        points["dcm"] = self._signals.dcm
        x, y, heading = self._footprints[index].tolist()
        poses = {"pose": make.pose((x, y, 0.0), make.upright(heading))}
        for name, rows in points.items():
            if rows is not None and np.isfinite(rows[index]).all():
                point = rows[index].tolist()
                poses[name] = make.pose(point, make.upright(0.0))
        for name, pose in poses.items():
            message = make.make(POSE, in_map, pose)
            yield TopicMessage(time, self._topic(name), POSE, message)
        for name, values in self._signals.strategy.items():
            if np.isfinite(values[index]):
                topic = self._topic(f"strategy/{name}")
                message = make.number(float(values[index]))
                yield TopicMessage(time, topic, NUMBER, message)
        if self._model is not None:
            yield from self._robot_sample(self._model, index, time)

    def _robot_sample(
        self, model: RobotModel, index: int, time: float
    ) -> Iterator[TopicMessage]:
        make, signals = self._factory, self._signals
        assert self._track.qpos is not None
        kind = "sensor_msgs/msg/JointState"
        message = make.joint_state(
            make.header(time, ""),
            model.joints,
            self._track.qpos[index, 7:],
            _row(signals.joint_velocity, index),
            _row(signals.joint_effort, index),
        )
        yield TopicMessage(time, self._topic("joint_states"), kind, message)
        gyro = _row(signals.gyro, index)
        accelerometer = _row(signals.accelerometer, index)
        if gyro is not None and accelerometer is not None:
            kind = "sensor_msgs/msg/Imu"
            header = make.header(time, self._frame(IMU))
            message = make.imu(header, gyro, accelerometer)
            yield TopicMessage(time, self._topic("imu"), kind, message)
        kind = "geometry_msgs/msg/WrenchStamped"
        for wrench in self._wrenches:
            header = make.header(time, self._frame(wrench.frame))
            force, torque = float(wrench.force[index]), wrench.torque[index]
            message = make.wrench(header, force, torque)
            topic = self._topic(f"{wrench.frame}/wrench")
            yield TopicMessage(time, topic, kind, message)

    def events(self) -> list[TopicMessage]:
        """Return the messages that are not at samples."""
        make, first = self._factory, float(self._times[0])
        found: list[TopicMessage] = []
        if self._model is not None:
            topic, kind = self._topic("robot_description"), TEXT
            message = make.text(_with_prefix(self._model.urdf, self._name))
            found.append(TopicMessage(first, topic, kind, message, stays=True))
            found += self._plans()
        for time, phase in self._signals.phases:
            topic, message = self._topic("phase"), make.text(phase)
            found.append(TopicMessage(time, topic, TEXT, message, stays=True))
        return found + list(self._images())

    def _plans(self) -> Iterator[TopicMessage]:
        """Yield the soles of each plan."""
        make, topic = self._factory, self._topic("footsteps/planned")
        for plan in self._signals.plans:
            outlines = soles(plan.footsteps, self._sole)
            cloud = make.points(make.header(plan.time, MAP), dotted(outlines))
            yield TopicMessage(plan.time, topic, CLOUD, cloud)

    def _images(self) -> Iterator[TopicMessage]:
        """Yield images with their calibration."""
        make = self._factory
        for image in self._signals.images:
            if isinstance(image, ColourImage):
                name = "camera"
                kind = "sensor_msgs/msg/CompressedImage"
                topic = self._topic(f"{name}/image_raw/compressed")
            else:
                name = depth_camera_name(image.number)
                kind = "sensor_msgs/msg/Image"
                topic = self._topic(f"{name}/image_raw")
            header = make.header(image.time, self._frame(name + OPTICAL))
            message = (
                make.jpeg(header, image.pixels)
                if isinstance(image, ColourImage)
                else make.depth_image(header, image.depths)
            )
            yield TopicMessage(image.time, topic, kind, message)
            yield TopicMessage(
                image.time,
                self._topic(f"{name}/camera_info"),
                "sensor_msgs/msg/CameraInfo",
                make.camera_info(header, image.camera),
            )


TEXT = "std_msgs/msg/String"


def _row(rows: Array | None, index: int) -> Array | None:
    return None if rows is None else rows[index]


def _with_prefix(urdf: str, name: str) -> str:
    """Return a URDF whose links are named like the frames of a player."""
    robot = ElementTree.fromstring(urdf)
    robot.set("name", name)
    for link in robot.iter("link"):
        link.set("name", f"{name}/{link.get('name')}")
    for end in (*robot.iter("parent"), *robot.iter("child")):
        end.set("link", f"{name}/{end.get('link')}")
    return ElementTree.tostring(robot, encoding="unicode")
