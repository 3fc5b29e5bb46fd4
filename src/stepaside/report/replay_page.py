"""A run as one page that opens from disk, without a network."""

from base64 import b64encode
from importlib.resources import files
from pathlib import Path
from typing import Any

import mujoco
import numpy as np

from ..games.duel import walkers_of
from ..games.run import Run
from ..games.settings import PLAYERS
from ..games.track import Track
from ..outputs import writing
from ..poses import Array
from ..robots.description import load_robot
from .inert import fill_page, visible
from .stage import Stage
from .style import COLOURS

RATE = 20.0  # frames a second
UNIT = 2e-4  # of a stored position, in [m]
VISIBLE = 2  # last geom group that is seen


def shapes_of(model: mujoco.MjModel) -> list[dict[str, Any]]:
    """Visible geoms as thick lines: body, ends, radius and colour."""
    shapes = []
    types = mujoco.mjtGeom
    for geom in range(model.ngeom):
        body = int(model.geom_bodyid[geom])
        if body == 0 or model.geom_group[geom] > VISIBLE:
            continue
        size = model.geom_size[geom]
        frame = np.zeros(9)
        mujoco.mju_quat2Mat(frame, model.geom_quat[geom])
        axes = frame.reshape(3, 3)
        # As int: an enumeration does not equal a number of numpy.
        kind = int(model.geom_type[geom])
        if kind in (types.mjGEOM_CAPSULE, types.mjGEOM_CYLINDER):
            axis, half, radius = axes[:, 2], size[1], size[0]
        elif kind == types.mjGEOM_SPHERE:
            axis, half, radius = axes[:, 2], 0.0, size[0]
        else:
            longest = int(np.argmax(size))
            others = np.delete(size, longest)
            radius = float(np.sqrt(others[0] * others[1]))
            axis = axes[:, longest]
            half = max(0.0, float(size[longest]) - radius)
        material = model.geom_matid[geom]
        rgba = (
            model.mat_rgba[material]
            if material >= 0
            else model.geom_rgba[geom]
        )
        red, green, blue = (rgba[:3] * 255).astype(int).tolist()
        center = model.geom_pos[geom]
        shapes.append(
            {
                "body": body,
                "a": np.round(center - half * axis, 4).tolist(),
                "b": np.round(center + half * axis, 4).tolist(),
                "r": round(float(radius), 4),
                "colour": f"#{red:02x}{green:02x}{blue:02x}",
            }
        )
    return shapes


def write_page(run: Run, file: Path) -> None:
    """Write the page of a run.

    Args:
        run: The run.
        file: Page to write; it appears when it is complete.

    Raises:
        OutputError: If it cannot be written.
    """
    template = files(__package__).joinpath("replay_page.html")
    text = template.read_text(encoding="utf-8")
    text = fill_page(text, {"NAME": run.name}, _content(run))
    with writing(file) as draft:
        draft.write_text(text, encoding="utf-8", newline="\n")


def _content(run: Run) -> dict[str, Any]:
    stage = Stage(run)
    chosen = _chosen(run.times)
    poses = np.empty((len(chosen), stage.model.nbody, 7))
    for row, index in enumerate(chosen):
        stage.put(int(index))
        poses[row, :, :3] = stage.data.xpos / UNIT
        poses[row, :, 3:] = stage.data.xquat * 32767
    stored = np.clip(np.rint(poses), -32767, 32767).astype("<i2")
    torso = load_robot(run.settings.robot).torso
    words = [visible(run.words(int(index))) for index in chosen]
    known = list(dict.fromkeys(words))
    both = np.concatenate([t.torso[:, :2] for t in run.tracks.values()])
    low, high = both.min(axis=0), both.max(axis=0)
    return {
        "times": np.round(run.times[chosen], 3).tolist(),
        "poses": b64encode(stored.tobytes()).decode("ascii"),
        "unit": UNIT,
        "bodies": stage.model.nbody,
        "shapes": shapes_of(stage.model),
        "robots": [
            {
                "name": name,
                "colour": COLOURS[name],
                "torso": stage.model.body(
                    f"{name}/{torso}"
                    if name in walkers_of(run.settings)
                    else f"{name}/trunk"
                ).id,
                "trace": np.round(
                    run.tracks[name].com[chosen, :2], 3
                ).tolist(),
                "landings": _landings(run.tracks[name]),
            }
            for name in PLAYERS
        ],
        "distance": np.round(run.distance[chosen], 3).tolist(),
        "angle": np.round(run.orientation[chosen], 1).tolist(),
        "theory": None if run.theory is None else list(run.theory),
        "circle": run.circle and [round(v, 3) for v in run.circle],
        "safety": run.settings.strategy.safety_radius,
        "words": known,
        "says": [known.index(text) for text in words],
        "middle": np.round(0.5 * (low + high), 3).tolist(),
        "away": 1.2 + 0.9 * float(np.hypot(*(high - low))),
    }


def _landings(track: Track) -> list[list[float]]:
    """Footsteps of a player; none of one who plans none."""
    if track.landings is None:
        return []
    rows: list[list[float]] = np.round(track.landings, 3).tolist()
    return rows


def _chosen(times: Array) -> np.ndarray:
    """Samples that are shown: evenly, and the last one."""
    if len(times) < 2:
        return np.arange(len(times))
    every = max(1, round(1.0 / RATE / float(times[1] - times[0])))
    chosen = np.arange(0, len(times), every)
    if chosen[-1] != len(times) - 1:
        chosen = np.append(chosen, len(times) - 1)
    return chosen
