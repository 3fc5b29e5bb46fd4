"""Recordings as a LeRobot dataset, format 3.0: one episode per robot.

Layout and entries are those that LeRobot itself reads: a table of frames,
a table of episodes, statistics of each feature, and a video per camera.
"""

import json
from collections.abc import Mapping
from dataclasses import dataclass
from fractions import Fraction
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ...core.errors import ConfigurationError
from ...core.poses import Array, wrap_angles
from ...games.replayed_signals import RobotSignals
from ...perception.images import ColourImage
from .recording import Recording
from .signal_series import FOOT_CORNERS

VERSION = "v3.0"
FILE = "chunk-000/file-{:03d}"
CAMERA = "observation.images.camera"
TASKS = {
    "pursuer": "turn towards the evader and walk to it",
    "evader": "step aside of the pursuer and keep away from it",
    "walker": "walk straight",
}
IMU_NAMES = ("gyro_x", "gyro_y", "gyro_z", "accel_x", "accel_y", "accel_z")
FRAME_INFO = ("timestamp", "frame_index", "episode_index", "index")


@dataclass(frozen=True, slots=True, eq=False)
class Episode:
    """Episode of one robot.

    Attributes:
        player: Name of the robot.
        features: Values by name of the feature; single precision. Shape
            (frames, width).
        names: Names of the columns of each feature.
        images: Colour image of each frame; empty without a camera.
    """

    player: str
    features: Mapping[str, NDArray[np.float32]]
    names: Mapping[str, tuple[str, ...]]
    images: tuple[ColourImage, ...]

    @property
    def task(self) -> str:
        """Task of the robot, as a sentence."""
        return TASKS.get(self.player, f"play as {self.player}")


def write_lerobot(folder: Path, recording: Recording) -> None:
    """Write a dataset with one episode for each robot.

    Args:
        folder: Root of the dataset.
        recording: The recording.

    Raises:
        ConfigurationError: If it has no robot, its samples are not at a
            whole number of frames per second, or robots differ in their
            features.
    """
    rate, frames = _frame_rate(recording.run.times)
    episodes = [
        _episode(recording, name, rate, frames) for name in recording.models
    ]
    if not episodes:
        raise ConfigurationError(
            "a LeRobot dataset must have a robot with recorded joints, got "
            f"{' and '.join(recording.run.players)}"
        )
    first = episodes[0]
    for other in episodes[1:]:
        if other.names != first.names or bool(other.images) != bool(
            first.images
        ):
            raise ConfigurationError(
                "robots of a LeRobot dataset must have the same joints and "
                f"sensors, got {first.player} and {other.player}"
            )
    robots = {m.description.name.lower() for m in recording.models.values()}
    _write_frames(folder, episodes, rate)
    stats = [_statistics(episode) for episode in episodes]
    for number, episode in enumerate(episodes):
        if episode.images:
            _write_video(_video(folder, number), episode.images, rate)
    _write_episodes(folder, episodes, stats, rate)
    _write_tasks(folder, episodes)
    _write_json(folder / "meta/stats.json", _joined(stats))
    info = _info(episodes, rate, " and ".join(sorted(robots)))
    _write_json(folder / "meta/info.json", info)


def _frame_rate(times: Array) -> tuple[int, int]:
    """Return frames per second, and the number of evenly spaced samples.

    Raises:
        ConfigurationError: If the rate is not a whole number.
    """
    if len(times) < 2:
        raise ConfigurationError(
            "a LeRobot dataset must have at least 2 samples, got 1"
        )
    period = float(times[1] - times[0])
    rate = round(1.0 / period)
    even = np.abs(times - times[0] - np.arange(len(times)) * period) < 1e-6
    frames = len(times) if even.all() else int(np.argmin(even))
    if abs(rate * period - 1.0) > 1e-6 or frames < len(times) - 1:
        raise ConfigurationError(
            "samples of a LeRobot dataset must be evenly spaced, at a whole "
            f"number per second, got {1.0 / period:.6g} per second"
        )
    return rate, frames


def _episode(
    recording: Recording, name: str, rate: int, frames: int
) -> Episode:
    """Return the episode of one robot, cut to a number of frames."""
    run, joints = recording.run, recording.models[name].joints
    track = run.tracks[name]
    assert track.qpos is not None
    signals = recording.signals.get(name, RobotSignals())
    values: dict[str, Array | None] = {
        "observation.state": track.qpos[:, 7:],
        "observation.velocity": signals.joint_velocity,
        "observation.effort": signals.joint_effort,
        "observation.imu": None
        if signals.gyro is None or signals.accelerometer is None
        else np.hstack([signals.gyro, signals.accelerometer]),
        "observation.foot_forces": signals.foot_forces,
        "observation.environment_state": _opponent(recording, name),
        "action": signals.joint_targets,
    }
    names = {
        "observation.state": joints,
        "observation.velocity": joints,
        "observation.effort": joints,
        "observation.imu": IMU_NAMES,
        "observation.foot_forces": FOOT_CORNERS,
        "observation.environment_state": ("bearing_rad", "distance_m"),
        "action": signals.target_names,
    }
    features = {
        key: rows[:frames].astype(np.float32)
        for key, rows in values.items()
        if rows is not None
    }
    images = _image_of_each_frame(signals, run.times[:frames])
    kept = {key: names[key] for key in features}
    return Episode(name, features, kept, images)


def _opponent(recording: Recording, name: str) -> Array | None:
    """Return true bearing and distance of the first other player."""
    tracks = recording.run.tracks
    other = next((n for n in tracks if n != name), None)
    if other is None:
        return None
    own, seen = tracks[name].unicycle, tracks[other].unicycle
    offset = seen[:, :2] - own[:, :2]
    sight = np.arctan2(offset[:, 1], offset[:, 0])
    bearing = wrap_angles(sight - own[:, 2])
    return np.column_stack([bearing, np.hypot(*offset.T)])


def _image_of_each_frame(
    signals: RobotSignals, times: Array
) -> tuple[ColourImage, ...]:
    """Return the newest image at each time; none without a camera.

    Only images of the top camera count.
    """
    images = [
        image
        for image in signals.images
        if isinstance(image, ColourImage) and not image.low
    ]
    if not images:
        return ()
    taken = np.array([image.time for image in images])
    newest = np.searchsorted(taken, times + 1e-9, side="right") - 1
    return tuple(images[max(index, 0)] for index in newest.tolist())


def _write_frames(folder: Path, episodes: list[Episode], rate: int) -> None:
    import pyarrow
    from pyarrow.parquet import write_table

    columns: dict[str, Any] = {}
    for key in episodes[0].features:
        rows = np.concatenate([each.features[key] for each in episodes])
        columns[key] = pyarrow.FixedSizeListArray.from_arrays(
            pyarrow.array(rows.ravel()), rows.shape[1]
        )
    frames = [np.arange(_length(episode)) for episode in episodes]
    frame, tasks = np.concatenate(frames), _tasks(episodes)
    numbers = np.repeat(np.arange(len(episodes)), [len(f) for f in frames])
    columns["timestamp"] = (frame / rate).astype(np.float32)
    columns["frame_index"] = frame
    columns["episode_index"] = numbers
    columns["index"] = np.arange(len(frame))
    columns["task_index"] = np.array(
        [tasks.index(episode.task) for episode in episodes]
    )[numbers]
    file = folder / "data" / f"{FILE.format(0)}.parquet"
    file.parent.mkdir(parents=True)
    write_table(pyarrow.table(columns), file)


def _length(episode: Episode) -> int:
    return len(episode.features["observation.state"])


def _tasks(episodes: list[Episode]) -> list[str]:
    return list(dict.fromkeys(episode.task for episode in episodes))


def _write_tasks(folder: Path, episodes: list[Episode]) -> None:
    """Write the table of tasks, whose index in pandas is the text."""
    import pyarrow
    from pyarrow.parquet import write_table

    tasks = _tasks(episodes)
    index = {"name": "task", "field_name": "task", "metadata": None}
    number = {"name": "task_index", "field_name": "task_index"}
    pandas = {
        "index_columns": ["task"],
        "column_indexes": [],
        "columns": [
            number
            | {"pandas_type": "int64", "numpy_type": "int64"}
            | {"metadata": None},
            index | {"pandas_type": "unicode", "numpy_type": "object"},
        ],
    }
    table = pyarrow.table(
        {"task_index": np.arange(len(tasks)), "task": tasks}
    ).replace_schema_metadata({"pandas": json.dumps(pandas)})
    write_table(table, folder / "meta/tasks.parquet")


def _statistics(episode: Episode) -> dict[str, dict[str, Any]]:
    """Return least, greatest, mean and standard deviation of each feature."""
    found = {}
    for key, rows in episode.features.items():
        values = rows.astype(np.float64)
        found[key] = {
            "min": values.min(axis=0).tolist(),
            "max": values.max(axis=0).tolist(),
            "mean": values.mean(axis=0).tolist(),
            "std": values.std(axis=0).tolist(),
            "count": [len(values)],
        }
    if episode.images:
        # Each image once, a tenth of the pixels, as in LeRobot per channel.
        unique = {image.time: image.pixels for image in episode.images}
        pixels = np.concatenate(
            [image[::3, ::3].reshape(-1, 3) for image in unique.values()]
        )
        values = pixels / 255.0
        found[CAMERA] = {
            "min": values.min(axis=0).reshape(3, 1, 1).tolist(),
            "max": values.max(axis=0).reshape(3, 1, 1).tolist(),
            "mean": values.mean(axis=0).reshape(3, 1, 1).tolist(),
            "std": values.std(axis=0).reshape(3, 1, 1).tolist(),
            "count": [len(episode.images)],
        }
    return found


def _joined(
    stats: list[dict[str, dict[str, Any]]],
) -> dict[str, dict[str, Any]]:
    """Return the statistics of all episodes together."""
    found = {}
    for key in stats[0]:
        counts = np.array([each[key]["count"][0] for each in stats], float)
        means = np.array([each[key]["mean"] for each in stats])
        spreads = np.array([each[key]["std"] for each in stats])
        weights = (counts / counts.sum()).reshape(-1, *[1] * (means.ndim - 1))
        mean = (weights * means).sum(axis=0)
        square = (weights * (spreads**2 + (means - mean) ** 2)).sum(axis=0)
        found[key] = {
            "min": np.min([each[key]["min"] for each in stats], 0).tolist(),
            "max": np.max([each[key]["max"] for each in stats], 0).tolist(),
            "mean": mean.tolist(),
            "std": np.sqrt(square).tolist(),
            "count": [int(counts.sum())],
        }
    return found


def _write_episodes(
    folder: Path,
    episodes: list[Episode],
    stats: list[dict[str, dict[str, Any]]],
    rate: int,
) -> None:
    import pyarrow
    from pyarrow.parquet import write_table

    rows: list[dict[str, Any]] = []
    begin = 0
    for number, (episode, own) in enumerate(zip(episodes, stats, strict=True)):
        length = _length(episode)
        row: dict[str, Any] = {
            "episode_index": number,
            "tasks": [episode.task],
            "length": length,
            "data/chunk_index": 0,
            "data/file_index": 0,
            "dataset_from_index": begin,
            "dataset_to_index": begin + length,
        }
        if episode.images:
            row |= {
                f"videos/{CAMERA}/chunk_index": 0,
                f"videos/{CAMERA}/file_index": number,
                f"videos/{CAMERA}/from_timestamp": 0.0,
                f"videos/{CAMERA}/to_timestamp": length / rate,
            }
        for key, values in own.items():
            row |= {f"stats/{key}/{name}": v for name, v in values.items()}
        row |= {"meta/episodes/chunk_index": 0, "meta/episodes/file_index": 0}
        rows.append(row)
        begin += length
    file = folder / "meta/episodes" / f"{FILE.format(0)}.parquet"
    file.parent.mkdir(parents=True)
    write_table(pyarrow.Table.from_pylist(rows), file)


def _info(episodes: list[Episode], rate: int, robot: str) -> dict[str, Any]:
    """Return the content of ``info.json``."""
    features: dict[str, Any] = {
        key: {
            "dtype": "float32",
            "shape": [rows.shape[1]],
            "names": list(episodes[0].names[key]),
        }
        for key, rows in episodes[0].features.items()
    }
    for key in (*FRAME_INFO, "task_index"):
        kind = "float32" if key == "timestamp" else "int64"
        features[key] = {"dtype": kind, "shape": [1], "names": None}
    if episodes[0].images:
        camera = episodes[0].images[0].camera
        features[CAMERA] = {
            "dtype": "video",
            "shape": [camera.height, camera.width, 3],
            "names": ["height", "width", "channels"],
            "info": {
                "video.height": camera.height,
                "video.width": camera.width,
                "video.codec": "h264",
                "video.pix_fmt": "yuv420p",
                "video.is_depth_map": False,
                "video.fps": rate,
                "video.channels": 3,
                "has_audio": False,
            },
        }
    path = "chunk-{chunk_index:03d}/file-{file_index:03d}"
    has_video = bool(episodes[0].images)
    return {
        "codebase_version": VERSION,
        "robot_type": robot,
        "total_episodes": len(episodes),
        "total_frames": sum(_length(episode) for episode in episodes),
        "total_tasks": len(_tasks(episodes)),
        "chunks_size": 1000,
        "data_files_size_in_mb": 100,
        "video_files_size_in_mb": 200,
        "fps": rate,
        "splits": {"train": f"0:{len(episodes)}"},
        "data_path": f"data/{path}.parquet",
        "video_path": f"videos/{{video_key}}/{path}.mp4"
        if has_video
        else None,
        "features": features,
    }


def _video(folder: Path, number: int) -> Path:
    return folder / "videos" / CAMERA / f"{FILE.format(number)}.mp4"


def _write_video(
    file: Path, images: tuple[ColourImage, ...], rate: int
) -> None:
    """Write one frame per sample; key frames often, for random access."""
    import av

    file.parent.mkdir(parents=True, exist_ok=True)
    height, width, _ = images[0].pixels.shape
    with av.open(str(file), "w") as container:
        stream = container.add_stream("libx264", rate=rate)
        stream.width, stream.height = width, height
        stream.pix_fmt = "yuv420p"
        stream.time_base = Fraction(1, rate)
        stream.options = {"crf": "23", "preset": "veryfast", "g": "2"}
        for number, image in enumerate(images):
            frame = av.VideoFrame.from_ndarray(image.pixels, format="rgb24")
            frame.pts, frame.time_base = number, Fraction(1, rate)
            container.mux(stream.encode(frame))
        container.mux(stream.encode(None))


def _write_json(file: Path, value: Any) -> None:
    file.parent.mkdir(parents=True, exist_ok=True)
    text = json.dumps(value, indent=2, allow_nan=False) + "\n"
    file.write_text(text, encoding="utf-8")
