"""Recordings for the Rerun viewer, with a blueprint that arranges the views.

Entities follow the tree of links, so that each pose is in its parent. Shapes
are those of the MuJoCo model.
"""

from pathlib import Path
from typing import Any, TypeAlias

import mujoco
import numpy as np

from ...core.poses import Array
from ...perception.images import ColourImage
from ...planning.gait_settings import SoleRectangle
from ...robots.urdf_elements import BASE, OPTICAL, UrdfLink
from ..landed_footsteps import landed_footsteps
from ..palette import colours_in
from ..visual_geoms import MAX_VISIBLE_GROUP, colour_of
from .bag_messages import JPEG_QUALITY
from .recorded_transforms import joint_poses, quaternion_of
from .recording import Recording, RobotModel
from .room_markers import shapes_over_time
from .signal_series import all_series

APPLICATION = "stepaside"
TIMELINE = "time"
WORLD = "world"
LIFT = 0.002  # of lines and soles over the floor, in [m]
POINT_RADIUS = 0.015  # in [m]
POINTS = {"com": "#5b2a86", "zmp": "#e0a400", "com_reference": "#888888"}
DCM_COLOUR = "#1c7a42"
_GEOMS = mujoco.mjtGeom
Rgb: TypeAlias = tuple[int, int, int]


def rgb(colour: str) -> Rgb:
    """Return red, green and blue, 0 to 255, of ``#rrggbb``."""
    red, green, blue = bytes.fromhex(colour.removeprefix("#"))
    return red, green, blue


def write_rerun(file: Path, recording: Recording) -> None:
    """Write a recording with its blueprint to one file.

    Args:
        file: File to write, ``.rrd``.
        recording: The recording.
    """
    import rerun

    stream = rerun.RecordingStream(APPLICATION, recording_id=None)
    stream.save(file, default_blueprint=rerun_blueprint(recording))
    log_models(stream, recording)
    _log_paths(stream, recording)
    log_samples(stream, recording)
    log_room(stream, recording)
    stream.flush()
    stream.disconnect()


def log_models(stream: Any, recording: Recording) -> None:
    """Log what does not change: robots, looks of points and of lines.

    Args:
        stream: Rerun's recording stream.
        recording: The recording.
    """
    import rerun

    stream.send_recording_name(recording.run.title)
    stream.log(WORLD, rerun.ViewCoordinates.RIGHT_HAND_Z_UP, static=True)
    for name in recording.run.players:
        for key in (*POINTS, "dcm"):
            look = rerun.Points3D.from_fields(
                radii=[POINT_RADIUS],
                colors=[rgb(POINTS.get(key, DCM_COLOUR))],
            )
            stream.log(f"{WORLD}/{name}/{key}", look, static=True)
        if name in recording.models:
            _log_links(stream, name, recording.models[name])
    for series in all_series(recording):
        names = list(series.columns)
        if len(names) == 1:  # of a unit only
            names = [f"{series.name} [{names[0]}]"]
        lines = rerun.SeriesLines(names=names)
        stream.log(f"signals/{series.name}", lines, static=True)


def log_samples(stream: Any, recording: Recording) -> None:
    """Log the samples of a recording: poses, points, images and numbers.

    Args:
        stream: Rerun's recording stream.
        recording: The recording.
    """
    for name in recording.run.players:
        _log_player(stream, recording, name)
    _log_series(stream, recording)


def _log_paths(stream: Any, recording: Recording) -> None:
    """Log the whole path of each player."""
    import rerun

    run = recording.run
    for name, track in run.tracks.items():
        colour = rgb(colours_in("light", run.players)[name])
        path = np.column_stack(
            [track.unicycle[:, :2], np.full(len(run.times), LIFT)]
        )
        line = rerun.LineStrips3D([path], colors=[colour], radii=[LIFT])
        stream.log(f"{WORLD}/{name}/path", line, static=True)


def rerun_blueprint(recording: Recording) -> Any:
    """Return the arrangement of the views.

    Args:
        recording: The recording.
    """
    import rerun.blueprint as views

    columns: list[Any] = []
    for name in recording.signals:
        if _colour_images(recording, name):
            columns.append(
                views.Spatial2DView(
                    origin=_camera_entity(recording, name),
                    name=f"{name}'s camera",
                )
            )
    run = recording.run
    if run.pair is not None:
        columns.append(
            views.TimeSeriesView(
                origin="signals",
                contents=[
                    "signals/distance",
                    "signals/angle_between_headings",
                ],
                name="distance [m], angle between headings [rad]",
            )
        )
    for name in recording.models:
        if name in recording.signals:
            columns.append(
                views.TimeSeriesView(
                    origin=f"signals/{name}/foot_forces",
                    name=f"{name}: foot forces [N]",
                    plot_legend=views.PlotLegend(visible=False),
                )
            )
    scene = views.Spatial3DView(origin=WORLD, name=run.title)
    if not columns:
        return views.Blueprint(scene, collapse_panels=True)
    return views.Blueprint(
        views.Horizontal(
            scene, views.Vertical(*columns), column_shares=[3, 2]
        ),
        collapse_panels=True,
    )


def _times(times: Array) -> Any:
    import rerun

    return [rerun.TimeColumn(TIMELINE, duration=times)]


def _log_player(stream: Any, recording: Recording, name: str) -> None:
    """Log points, body, footsteps and images of a player."""
    import rerun

    run = recording.run
    track, root = run.tracks[name], f"{WORLD}/{name}"
    colour = rgb(colours_in("light", run.players)[name])
    signals = recording.signals.get(name)
    points = {key: getattr(track, key) for key in POINTS}
    points["dcm"] = None if signals is None else signals.dcm
    for key, rows in points.items():
        if rows is None:
            continue
        known = np.isfinite(rows).all(axis=1)
        spots = np.full((int(known.sum()), 3), LIFT)
        spots[:, : rows.shape[1]] = rows[known]
        stream.send_columns(
            f"{root}/{key}",
            _times(run.times[known]),
            rerun.Points3D.columns(positions=spots),
        )
    model = recording.models.get(name)
    if model is not None:
        assert track.qpos is not None
        _log_robot(stream, recording, name, model)
        if track.landings is not None:
            sole = run.settings.robot_of(name).gait.sole
            rows = landed_footsteps(model.description, run.times, track)
            _log_footsteps(stream, f"{root}/footsteps", rows, sole, colour)
    _log_images(stream, recording, name)


def _log_footsteps(
    stream: Any,
    entity: str,
    rows: Array,
    sole: SoleRectangle,
    colour: tuple[int, int, int],
) -> None:
    """Log soles that have landed: rows (time, side, x, y, heading)."""
    import rerun

    half = 0.5 * (sole.front - sole.back), 0.5 * (sole.outer + sole.inner)
    ahead = 0.5 * (sole.front + sole.back)
    for time, side, x, y, heading in rows.tolist():
        left = 0.5 * side * (sole.outer - sole.inner)
        cos, sin = np.cos(heading), np.sin(heading)
        stream.set_time(TIMELINE, duration=time)
        turn = (0.0, 0.0, np.sin(0.5 * heading), np.cos(0.5 * heading))
        stream.log(
            f"{entity}/{round(1e3 * time)}",
            rerun.Boxes3D(
                centers=[
                    (
                        x + cos * ahead - sin * left,
                        y + sin * ahead + cos * left,
                        LIFT,
                    )
                ],
                half_sizes=[(*half, 0.5 * LIFT)],
                quaternions=[turn],
                colors=[colour],
            ),
        )
    stream.reset_time()


def _log_links(stream: Any, name: str, model: RobotModel) -> None:
    """Log the fixed poses and the shapes of the links of a robot."""
    import rerun

    entities = entities_of(name, model)
    for joint in model.tree.joints:
        if joint.number is None:
            turn = quaternion_of(joint.axes)[[1, 2, 3, 0]]
            pose = rerun.Transform3D(
                translation=joint.position,
                quaternion=rerun.Quaternion(xyzw=turn),
            )
            stream.log(entities[joint.child], pose, static=True)
    for link in model.tree.links:
        if link.body is not None and link.body >= 0:
            _log_shapes(stream, entities[link.name], model.model, link)


def _log_robot(
    stream: Any, recording: Recording, name: str, model: RobotModel
) -> None:
    """Log the poses of the moving links of a robot."""
    import rerun

    run = recording.run
    qpos = run.tracks[name].qpos
    assert qpos is not None
    free = qpos[:, :7].astype(np.float64)
    entities = entities_of(name, model)
    stream.send_columns(
        entities[BASE],
        _times(run.times),
        rerun.Transform3D.columns(
            translation=free[:, :3], quaternion=free[:, [4, 5, 6, 3]]
        ),
    )
    for joint, positions, quaternions in joint_poses(model, qpos):
        stream.send_columns(
            entities[joint.child],
            _times(run.times),
            rerun.Transform3D.columns(
                translation=positions,
                quaternion=quaternions[:, [1, 2, 3, 0]],
            ),
        )


def entities_of(name: str, model: RobotModel) -> dict[str, str]:
    """Return the entity of each link of a robot, below that of its parent."""
    entities = {BASE: f"{WORLD}/{name}/{BASE}"}
    for joint in model.tree.joints:
        entities[joint.child] = f"{entities[joint.parent]}/{joint.child}"
    return entities


def _log_shapes(
    stream: Any, entity: str, model: mujoco.MjModel, link: UrdfLink
) -> None:
    """Log the visible geoms of a link."""
    assert link.body is not None
    first = int(model.body_geomadr[link.body])
    for geom in range(first, first + int(model.body_geomnum[link.body])):
        if model.geom_group[geom] <= MAX_VISIBLE_GROUP:
            center = model.geom_pos[geom] - link.anchor
            turn = model.geom_quat[geom][[1, 2, 3, 0]]
            shape = _shape(model, geom, center, turn)
            stream.log(f"{entity}/shapes/{geom}", shape, static=True)


def _shape(
    model: mujoco.MjModel, geom: int, center: Array, turn: Array
) -> Any:
    """Return a geom as an archetype; meshes become their bounding boxes."""
    import rerun

    kind, size = int(model.geom_type[geom]), model.geom_size[geom]
    look: dict[str, Any] = {
        "quaternions": [rerun.Quaternion(xyzw=turn)],
        "colors": [colour_of(model, geom)],
        "fill_mode": "solid",
    }
    if kind == _GEOMS.mjGEOM_SPHERE:
        half = [size[[0, 0, 0]]]
        return rerun.Ellipsoids3D(centers=[center], half_sizes=half, **look)
    if kind == _GEOMS.mjGEOM_ELLIPSOID:
        return rerun.Ellipsoids3D(centers=[center], half_sizes=[size], **look)
    if kind in (_GEOMS.mjGEOM_CYLINDER, _GEOMS.mjGEOM_CAPSULE):
        length = {"lengths": [2.0 * size[1]], "radii": [size[0]]}
        if kind == _GEOMS.mjGEOM_CYLINDER:
            return rerun.Cylinders3D(centers=[center], **length, **look)
        # A capsule of Rerun begins at its origin.
        axes = np.zeros(9)
        mujoco.mju_quat2Mat(axes, model.geom_quat[geom])
        begin = center - size[1] * axes.reshape(3, 3)[:, 2]
        return rerun.Capsules3D(translations=[begin], **length, **look)
    if kind != _GEOMS.mjGEOM_BOX:
        size = model.geom_aabb[geom, 3:]
    return rerun.Boxes3D(centers=[center], half_sizes=[size], **look)


def _colour_images(recording: Recording, name: str) -> list[ColourImage]:
    signals = recording.signals.get(name)
    return [
        image
        for image in (() if signals is None else signals.images)
        if isinstance(image, ColourImage) and not image.low
    ]


def _log_images(stream: Any, recording: Recording, name: str) -> None:
    """Log the images of a robot's top camera as JPEG, with its calibration."""
    import rerun

    images = _colour_images(recording, name)
    if not images:
        return
    import cv2

    quality = [cv2.IMWRITE_JPEG_QUALITY, JPEG_QUALITY]
    blobs = []
    for image in images:
        _, data = cv2.imencode(".jpg", image.pixels[:, :, ::-1], quality)
        blobs.append(data.tobytes())
    entity = _camera_entity(recording, name)
    kind = rerun.EncodedImage.from_fields(media_type="image/jpeg")
    stream.log(entity, kind, static=True)
    stream.send_columns(
        entity,
        _times(np.array([image.time for image in images])),
        rerun.EncodedImage.columns(blob=blobs),
    )
    camera = images[0].camera
    pinhole = rerun.Pinhole(
        focal_length=(camera.focal_x, camera.focal_y),
        width=camera.width,
        height=camera.height,
        image_plane_distance=0.3,
        camera_xyz=rerun.ViewCoordinates.RDF,
    )
    stream.log(entity, pinhole, static=True)


def _camera_entity(recording: Recording, name: str) -> str:
    """Return the entity of the optical frame of a robot's top camera."""
    return entities_of(name, recording.models[name])[f"camera{OPTICAL}"]


def log_room(stream: Any, recording: Recording) -> None:
    """Log obstacles, persons and templates.

    Args:
        stream: Rerun's recording stream.
        recording: The recording.
    """
    import rerun

    archetypes = {
        "CUBE": rerun.Boxes3D,
        "SPHERE": rerun.Ellipsoids3D,
    }
    for time, moved in shapes_over_time(recording.run):
        stream.set_time(TIMELINE, duration=time)
        for placed in moved:
            shape = placed.shape
            half = [tuple(0.5 * length for length in shape.size)]
            look: dict[str, Any] = {
                "centers": [placed.position],
                "quaternions": [
                    rerun.Quaternion(xyzw=placed.quaternion[[1, 2, 3, 0]])
                ],
                "colors": [shape.colour],
                "fill_mode": "solid",
            }
            if shape.kind in archetypes:
                body = archetypes[shape.kind](half_sizes=half, **look)
            else:
                body = rerun.Cylinders3D(
                    lengths=[shape.size[2]],
                    radii=[0.5 * shape.size[0]],
                    **look,
                )
            entity = f"{WORLD}/{shape.owner}/shapes/{placed.number}"
            stream.log(entity, body)
    stream.reset_time()


def _log_series(stream: Any, recording: Recording) -> None:
    """Log all numbers at the samples, one entity per series."""
    import rerun

    times = _times(recording.run.times)
    for series in all_series(recording):
        entity = f"signals/{series.name}"
        width = len(series.columns)
        values = series.values.astype(np.float64).ravel()
        columns = rerun.Scalars.columns(scalars=values).partition(
            np.full(len(recording.run.times), width)
        )
        stream.send_columns(entity, times, columns)
