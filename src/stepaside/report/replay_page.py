"""A run as one page that opens from disk, without a network."""

import io
import zipfile
from base64 import b64encode
from functools import cache
from importlib.resources import files
from typing import Any

import numpy as np

from ..core.atomic_output import writing
from ..core.errors import AnyPath, ConfigurationError, as_path
from ..core.poses import Array
from ..games.run import Run
from ..robots.description import load_robot
from .body_heights import BodyHeights
from .cycle_means import whole_cycles
from .palette import PALETTES, colours_in
from .room_extent import wall_corners
from .scene import RunScene
from .text_escaping import fill_page, visible
from .visual_geoms import parts_of

ARCHIVE = "templates/viewer.zip"  # of trimesh
TEMPLATE = "viewer.html.template"
BEGIN = "/**\n * @license\n * Copyright 2010-"  # notice of three.js
END = 'Object.defineProperty(t,"__esModule",{value:!0})}));'


@cache
def three() -> str:
    """Text of three.js, which gives a page the name ``THREE``.

    Raises:
        ConfigurationError: If trimesh is not there, or brings it no more.
    """
    try:
        from trimesh.resources import get_bytes

        with zipfile.ZipFile(io.BytesIO(get_bytes(ARCHIVE))) as archive:
            text = archive.read(TEMPLATE).decode("utf-8")
        begin = text.index(BEGIN)
        end = text.index(END, begin) + len(END)
    except ImportError as error:
        raise ConfigurationError(
            "pages need three.js, which comes with trimesh: "
            "pip install 'stepaside[viewer]'"
        ) from error
    except (KeyError, OSError, ValueError, zipfile.BadZipFile) as error:
        raise ConfigurationError(
            "pages need a trimesh that brings three.js, as 4.0 to 5.2 do"
        ) from error
    return text[begin:end]


RATE = 20.0  # frames a second
SCRIPTS = ("scene.js", "plots.js", "page.js")
HEAD = 0.04  # of a name over the highest point of its player, in [m]
BESIDE = 0.4  # margin of what is seen from above, in [m]


def template() -> str:
    """The page without a run: markup, three.js and the page's own scripts."""
    folder = files(__package__).joinpath("page")
    text, *scripts = (
        folder.joinpath(name).read_text(encoding="utf-8")
        for name in ("page.html", *SCRIPTS)
    )
    text = text.replace("@@THREE@@", three())
    # The last one holds the page together, and says how strict all are.
    return text.replace("@@SCRIPT@@", '"use strict";\n' + "".join(scripts))


def write_page(run: Run, file: AnyPath) -> None:
    """Write the page of a run.

    Args:
        run: The run.
        file: Page to write; it appears when it is complete.

    Raises:
        ConfigurationError: If the library that draws is not there.
        OutputError: If it cannot be written.
    """
    file = as_path(file, "file")
    text = fill_page(template(), {"NAME": run.name}, _content(run))
    with writing(file) as draft:
        draft.write_text(text, encoding="utf-8", newline="\n")


def _content(run: Run) -> dict[str, Any]:
    """What the page's scripts are given."""
    stage = RunScene(run)
    parts = parts_of(stage.model)
    # Only what moves and is seen is told over time.
    bodies = sorted({part.body for part in parts} - {0})
    chosen = _chosen(run.times)
    places = np.empty((len(chosen), len(bodies), 3), "<f4")
    turns = np.empty((len(chosen), len(bodies), 4), "<i2")
    for row, index in enumerate(chosen):
        stage.put(int(index))
        places[row] = stage.data.xpos[bodies]
        turns[row] = np.rint(32767.0 * stage.data.xquat[bodies])
    words = [visible(run.words(int(index))) for index in chosen]
    known = list(dict.fromkeys(words))
    low, high = _extent(run)
    tops = BodyHeights(parts)
    sole = run.settings.gait.sole
    return {
        "times": np.round(run.times[chosen], 3).tolist(),
        "places": b64encode(places.tobytes()).decode("ascii"),
        "turns": b64encode(turns.tobytes()).decode("ascii"),
        "bodies": bodies,
        "parts": [part.to_json() for part in parts],
        "palettes": {n: p._asdict() for n, p in PALETTES.items()},
        "sole": [sole.back, sole.front, -sole.inner, sole.outer],
        "robots": [
            _robot(run, stage, name, chosen, tops) for name in run.players
        ],
        "distance": _series(run.distance, chosen, 3),
        "angle": _series(run.orientation, chosen, 1),
        "means": {
            "distance": _means(run, run.distance, chosen, 3),
            "angle": _means(run, run.orientation, chosen, 1),
        },
        "theory": None if run.theory is None else list(run.theory),
        "circle": run.circle and [round(v, 3) for v in run.circle],
        "safety": run.safety and run.safety.radius,
        "guarded": run.safety and run.players.index(run.safety.player),
        "words": known,
        "says": [known.index(text) for text in words],
        "middle": np.round(0.5 * (low + high), 3).tolist(),
        "half": np.round(0.5 * (high - low) + BESIDE, 3).tolist(),
        "away": 1.4 + 1.05 * float(np.hypot(*(high - low))),
    }


def _means(
    run: Run, values: Array | None, chosen: np.ndarray, digits: int
) -> list[float | None] | None:
    """Means of whole gait cycles; None where there is none."""
    if values is None:
        return None
    period = 2.0 * run.settings.gait.step_duration
    return _series(whole_cycles(values, run.times, period), chosen, digits)


def _robot(
    run: Run, stage: RunScene, name: str, chosen: np.ndarray, tops: BodyHeights
) -> dict[str, Any]:
    """What the page shows of one player."""
    torso = "trunk"
    if name in run.robots:
        torso = load_robot(run.settings.robot_of(name).robot).torso
    track, body = run.tracks[name], stage.model.body(f"{name}/{torso}").id
    stage.put(0)
    own = [
        i
        for i in range(stage.model.nbody)
        if stage.model.body(i).name.startswith(f"{name}/")
    ]
    over = tops.of(own, stage.data.xpos, stage.data.xquat)
    return {
        "name": name,
        "torso": body,
        "head": round(float(over - stage.data.xpos[body, 2]) + HEAD, 3),
        "trace": np.round(track.com[chosen, :2], 3).tolist(),
        "landings": _rows(track.landings),
        "pushes": _rows(track.pushes),
        "colours": {
            light: colours_in(light, run.players)[name] for light in PALETTES
        },
    }


def _extent(run: Run) -> tuple[Array, Array]:
    """Corners of the players' ways and of the room. Shape (2,) each."""
    ways = [track.torso[:, :2] for track in run.tracks.values()]
    both = np.concatenate([*ways, wall_corners(run.plan)])
    return both.min(axis=0), both.max(axis=0)


def _rows(table: Array | None) -> list[list[float]]:
    """Footsteps or pushes of a player; none of one who has none."""
    if table is None:
        return []
    rows: list[list[float]] = np.round(table, 3).tolist()
    return rows


def _series(
    values: Array | None, chosen: np.ndarray, digits: int
) -> list[float | None] | None:
    """Values at the samples that are shown; None where one is not known."""
    if values is None:
        return None
    shown = values[chosen].tolist()
    return [round(v, digits) if np.isfinite(v) else None for v in shown]


def _chosen(times: Array) -> np.ndarray:
    """Samples that are shown: evenly, and the last one."""
    if len(times) < 2:
        return np.arange(len(times))
    every = max(1, round(1.0 / RATE / float(times[1] - times[0])))
    chosen = np.arange(0, len(times), every)
    if chosen[-1] != len(times) - 1:
        chosen = np.append(chosen, len(times) - 1)
    return chosen
