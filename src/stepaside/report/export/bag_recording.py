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
from scipy.spatial.transform import Rotation

from ...core.poses import Array
from ...games.run import Run
from ...locomotion.locomotion import Phase
from ...perception.images import ColourImage
from ...robots.head import depth_camera_name
from ...robots.urdf_writer import IMU, OPTICAL
from ..overlays import overlays_of, soles
from .bag_messages import MessageFactory, nanoseconds
from .recording import Recording, RobotModel
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
POINTS = ("com", "com_reference", "zmp", "zmp_reference", "dcm")


class TopicMessage(NamedTuple):
    """Message on a topic."""

    time: float  # [s]
    topic: str
    message: Any
    stays: bool = False  # late subscribers get it, too (transient local)


class MovingFrame(NamedTuple):
    """Frame that moves in another one."""

    parent: str
    child: str
    positions: Array  # [m], shape (n, 3)
    quaternions: Array  # (w, x, y, z), shape (n, 4)


def write_bag(
    folder: Path,
    recording: Recording,
    report: Callable[[int, int], None],
) -> None:
    """Write a ROS 2 bag in MCAP, with URDF files, into an existing folder.

    ``report`` is called with the samples done and their number.
    """
    from rosbags.rosbag2 import CompressionMode, StoragePlugin, Writer
    from rosbags.rosbag2.enums import CompressionFormat

    factory = MessageFactory()
    bag = folder / recording.run.name
    writer = Writer(bag, version=9, storage_plugin=StoragePlugin.MCAP)
    writer.set_compression(CompressionMode.STORAGE, CompressionFormat.ZSTD)
    connections: dict[str, Any] = {}
    with writer:
        for time, topic, message, stays in messages_of(
            recording, factory, report
        ):
            kind = message.__msgtype__
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
    from rosbags import interfaces as of

    forever = of.QosTime(2147483647, 4294967295)
    durability = of.QosDurability
    return of.Qos(
        of.QosHistory.KEEP_LAST,
        1 if stays else 10,
        of.QosReliability.RELIABLE,
        durability.TRANSIENT_LOCAL if stays else durability.VOLATILE,
        forever,
        forever,
        of.QosLiveliness.AUTOMATIC,
        forever,
        False,
    )


def messages_of(
    recording: Recording,
    factory: MessageFactory,
    report: Callable[[int, int], None],
) -> Iterator[TopicMessage]:
    """Yield all messages of a recording, in the order of their times.

    ``report`` is called with the samples done and their number.
    """
    run, first = recording.run, float(recording.run.times[0])
    players = [PlayerTopics(recording, name, factory) for name in run.players]
    room = RoomModel(run)
    seen_at = {index: row for row, index in enumerate(room.samples.tolist())}

    def tf(time: float, frames: Any) -> Any:
        stamped = [
            factory.transform(factory.header(time, parent), *own)
            for parent, *own in frames
        ]
        return factory.make("tf2_msgs/TFMessage", stamped)

    def room_frames(row: int, *, moving: bool) -> list[tuple[Any, ...]]:
        placed = zip(
            room.frames,
            room.positions[row],
            room.quaternions[row],
            room.moves,
            strict=True,
        )
        return [(MAP, *own) for *own, moves in placed if moves == moving]

    static = [f for player in players for f in player.static]
    static += room_frames(0, moving=False)
    yield TopicMessage(first, "/tf_static", tf(first, static), stays=True)
    events = [m for player in players for m in player.events()]
    events += overlay_messages(run, factory)
    if room.urdf:
        text, topic = factory.text(room.urdf), "/room/robot_description"
        events.append(TopicMessage(first, topic, text, stays=True))
    events.sort(key=lambda event: event.time)
    events.reverse()
    for index, time in enumerate(run.times.tolist()):
        while events and events[-1].time <= time:
            event = events.pop()
            yield event._replace(time=max(event.time, first))
        moved = [
            (f.parent, f.child, f.positions[index], f.quaternions[index])
            for player in players
            for f in player.moving
        ]
        if index in seen_at:
            moved += room_frames(seen_at[index], moving=True)
        yield TopicMessage(time, "/tf", tf(time, moved))
        for player in players:
            yield from player.sample(index, time)
        if run.pair is not None:
            number = factory.number(run.distance[index])
            yield TopicMessage(time, "/distance_m", number)
        if run.has_orientation:
            number = factory.number(np.radians(run.orientation[index]))
            yield TopicMessage(time, "/angle_rad", number)
        if index % 50 == 0:
            report(index, len(run.times))


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
            yield TopicMessage(time, topic, cloud, stays=True)


def dotted(segments: Array) -> Array:
    """Return points along segments (n, 2, 2) on the floor. Shape (m, 3)."""
    share = np.linspace(0.0, 1.0, DOTS, endpoint=False)[:, None]
    along = segments[:, None, 0] * (1.0 - share) + segments[:, None, 1] * share
    flat = along.reshape(-1, 2)
    return np.column_stack([flat, np.zeros(len(flat))])


class PlayerTopics:
    """Messages of one player.

    Attributes:
        static: Frames that do not move: parent, child, position in [m] and
            quaternion (w, x, y, z).
        moving: Frames that move.
    """

    def __init__(
        self, recording: Recording, name: str, factory: MessageFactory
    ) -> None:
        """Prepare the arrays of a player."""
        run = recording.run
        self._name, self._factory = name, factory
        self._times, self._track = run.times, run.tracks[name]
        self._model = recording.models.get(name)
        places = self._track.unicycle
        upright = Rotation.from_euler("z", places[:, 2:])
        quaternions = upright.as_quat(scalar_first=True)
        on_floor = places * [1.0, 1.0, 0.0]
        self._points: dict[str, Array | None] = {
            name: getattr(self._track, name) for name in POINTS
        }
        self._place = on_floor, quaternions
        odometry, foot = f"{name}/odom", f"{name}/base_footprint"
        self.static: list[tuple[Any, ...]] = [
            (MAP, odometry, on_floor[0], quaternions[0])
        ]
        begun = upright[0].inv()
        way = begun.apply(on_floor - on_floor[0])
        turned = (begun * upright).as_quat(scalar_first=True)
        self.moving = [MovingFrame(odometry, foot, way, turned)]
        qpos = self._track.qpos
        if self._model is None or qpos is None:
            return
        self._sole = run.settings.player(name).gait.sole
        torso = upright.inv() * Rotation.from_quat(
            qpos[:, 3:7], scalar_first=True
        )
        offset = upright.inv().apply(qpos[:, :3] - on_floor)
        base = offset, torso.as_quat(scalar_first=True)
        self.moving.append(MovingFrame(foot, f"{name}/base_link", *base))
        self._add_joints(self._model, qpos)

    def _add_joints(self, model: RobotModel, qpos: Array) -> None:
        """Add the frames of links."""
        column = {name: 7 + i for i, name in enumerate(model.joints)}
        for joint in ElementTree.fromstring(model.urdf).iter("joint"):
            parts: dict[str, Any] = {part.tag: part.attrib for part in joint}
            above = f"{self._name}/{parts['parent']['link']}"
            below = f"{self._name}/{parts['child']['link']}"
            place = np.array(parts["origin"]["xyz"].split(), dtype=np.float64)
            angles = np.array(parts["origin"]["rpy"].split(), np.float64)
            turn = Rotation.from_euler("xyz", angles)
            if "axis" not in parts:
                fixed = turn.as_quat(scalar_first=True)
                self.static.append((above, below, place, fixed))
                continue
            axis = np.array(parts["axis"]["xyz"].split(), dtype=np.float64)
            values = qpos[:, column[joint.attrib["name"]]].astype(np.float64)
            places = np.tile(place, (len(values), 1))
            if joint.attrib["type"] == "prismatic":
                places = places + np.outer(values, turn.apply(axis))
                values = np.zeros(len(values))
            turns = turn * Rotation.from_rotvec(np.outer(values, axis))
            quaternions = turns.as_quat(scalar_first=True)
            self.moving.append(MovingFrame(above, below, places, quaternions))

    def _message(self, time: float, name: str, message: Any) -> TopicMessage:
        return TopicMessage(time, f"/{self._name}/{name}", message)

    def sample(self, index: int, time: float) -> Iterator[TopicMessage]:
        """Yield the messages of a sample, other than transforms."""
        make = self._factory
        header = make.header(time, MAP)
        place = [rows[index].tolist() for rows in self._place]
        yield self._message(time, "pose", make.pose(header, *place))
        for name, rows in self._points.items():
            if rows is not None and np.isfinite(rows[index]).all():
                point = rows[index].tolist()
                yield self._message(time, name, make.pose(header, point))
        for name, values in self._track.strategy.items():
            if np.isfinite(values[index]):
                number = make.number(values[index])
                yield self._message(time, f"strategy/{name}", number)
        if self._model is not None:
            yield from self._robot_sample(self._model, index, time)

    def _robot_sample(
        self, model: RobotModel, index: int, time: float
    ) -> Iterator[TopicMessage]:
        make, track = self._factory, self._track
        assert track.qpos is not None
        rates, efforts = (
            None if rows is None else rows[index]
            for rows in (track.joint_velocity, track.joint_effort)
        )
        joints = make.joint_state(
            make.header(time, ""),
            model.joints,
            track.qpos[index, 7:],
            rates,
            efforts,
        )
        yield self._message(time, "joint_states", joints)
        if track.gyro is not None and track.accelerometer is not None:
            header = make.header(time, f"{self._name}/{IMU}")
            measured = track.gyro[index], track.accelerometer[index]
            yield self._message(time, "imu", make.imu(header, *measured))
        if track.foot_forces is not None:
            forces = track.foot_forces[index]
            for side, frame in enumerate(("l_sole", "r_sole")):
                corners = slice(4 * side, 4 * side + 4)
                x, y, _ = model.foot_sites[corners].T
                own = forces[corners]
                torque = np.array([y @ own, -x @ own])
                header = make.header(time, f"{self._name}/{frame}")
                wrench = make.wrench(header, float(own.sum()), torque)
                yield self._message(time, f"{frame}/wrench", wrench)

    def events(self) -> Iterator[TopicMessage]:
        """Yield the messages that are not at samples."""
        make, track, name = self._factory, self._track, self._name
        if self._model is not None:
            text = make.text(_with_prefix(self._model.urdf, name))
            own = self._message(
                float(self._times[0]), "robot_description", text
            )
            yield own._replace(stays=True)
            yield from self._plans()
        yield from self._phases()
        for image in track.images:
            camera, topic = "camera", "image_raw/compressed"
            if not isinstance(image, ColourImage):
                camera, topic = depth_camera_name(image.number), "image_raw"
            header = make.header(image.time, f"{name}/{camera}{OPTICAL}")
            message = (
                make.jpeg(header, image.pixels)
                if isinstance(image, ColourImage)
                else make.depth_image(header, image.depths)
            )
            yield self._message(image.time, f"{camera}/{topic}", message)
            info = make.camera_info(header, image.camera)
            yield self._message(image.time, f"{camera}/camera_info", info)

    def _plans(self) -> Iterator[TopicMessage]:
        """Yield each plan as the outlines of its soles."""
        make, plans = self._factory, self._track.plans
        if plans is None:
            return
        for time in np.unique(plans[:, 0]).tolist():
            steps = plans[plans[:, 0] == time, 2:]
            outlines = dotted(soles(steps, self._sole))
            cloud = make.points(make.header(time, MAP), outlines)
            yield self._message(time, "footsteps/planned", cloud)

    def _phases(self) -> Iterator[TopicMessage]:
        """Yield the changes of the phase of motion."""
        phase, phases = self._track.phase, list(Phase)
        if phase is None:
            return
        for index in np.flatnonzero(np.diff(phase[:, 0], prepend=-1.0)):
            text = self._factory.text(phases[int(phase[index, 0])].value)
            own = self._message(float(self._times[index]), "phase", text)
            yield own._replace(stays=True)


def _with_prefix(urdf: str, name: str) -> str:
    """Return a URDF whose links are named like the frames of a player."""
    robot = ElementTree.fromstring(urdf)
    robot.set("name", name)
    for link in robot.iter("link"):
        link.set("name", f"{name}/{link.get('name')}")
    for end in (*robot.iter("parent"), *robot.iter("child")):
        end.set("link", f"{name}/{end.get('link')}")
    return ElementTree.tostring(robot, encoding="unicode")
