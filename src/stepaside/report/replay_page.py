"""Replay of a run as one HTML page that opens from disk, without a network."""

import io
import zipfile
from base64 import b64encode
from functools import cache
from importlib.resources import files
from math import isfinite
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..core.atomic_output import atomic_draft
from ..core.errors import AnyPath, ConfigurationError, as_path, visible
from ..core.poses import Array
from ..games.run import Run
from ..games.trajectory import whole_cycles
from .film_captions import describe_state
from .overlays import LAYERS, overlays_of, safety_areas
from .palette import PALETTES, colours_in
from .scene import RunScene, wall_corners
from .text_escaping import fill_page
from .visual_geoms import label_over, visual_geoms_of

ARCHIVE = "templates/viewer.zip"  # of trimesh
TEMPLATE = "viewer.html.template"
BEGIN = "/**\n * @license\n * Copyright 2010-"  # notice of three.js
END = 'Object.defineProperty(t,"__esModule",{value:!0})}));'
RATE = 20.0  # samples per second of the run
SCRIPTS = ("scene.js", "stage.js", "plots.js", "page.js")
TOP_MARGIN = 0.4  # around the players in the top view, in [m]


@cache
def three_js() -> str:
    """Return the source of three.js, which defines ``THREE`` in a page.

    Raises:
        ConfigurationError: If trimesh is missing or has no three.js.
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
            "pages need a trimesh that contains three.js: versions 4.0 to 5.2"
        ) from error
    return text[begin:end]


def template() -> str:
    """Return the page without a run: markup, style, three.js and scripts."""
    folder = files(__package__).joinpath("page")
    text, style, *sources = (
        folder.joinpath(name).read_text(encoding="utf-8")
        for name in ("page.html", "page.css", *SCRIPTS)
    )
    text = text.replace("@@STYLE@@", style).replace("@@THREE@@", three_js())
    return text.replace("@@SCRIPT@@", '"use strict";\n' + "".join(sources))


def write_page(run: Run, file: AnyPath) -> None:
    """Write the replay page of a run.

    Args:
        run: The run.
        file: Page to write; it appears when it is complete.

    Raises:
        ConfigurationError: If three.js is not installed.
        OutputError: If the file cannot be written.
    """
    file = as_path(file, "file")
    text = fill_page(template(), {"NAME": run.name}, page_data(run))
    with atomic_draft(file) as draft:
        draft.write_text(text, encoding="utf-8", newline="\n")


def page_data(run: Run) -> dict[str, Any]:
    """Return the data that the page's scripts draw, as plain values."""
    scene = RunScene(run)
    geoms = visual_geoms_of(scene.model)
    # Poses are stored only for bodies that move and are visible.
    scene.put(0)
    labels = {
        name: label_over(scene.model, scene.data, name) for name in run.players
    }
    roots = {body for body, _ in labels.values()}
    bodies = sorted({geom.body for geom in geoms} - {0} | roots)
    samples = _samples_shown(run.times)
    positions = np.empty((len(samples), len(bodies), 3), "<f4")
    quaternions = np.empty((len(samples), len(bodies), 4), "<i2")
    for row, index in enumerate(samples):
        scene.put(int(index))
        positions[row] = scene.data.xpos[bodies]
        quaternions[row] = np.rint(32767.0 * scene.data.xquat[bodies])
    messages = [visible(describe_state(run, int(index))) for index in samples]
    distinct = list(dict.fromkeys(messages))
    low, high = _extent(run)
    colours = {
        theme: colours_in(theme, run.players, run.identities)
        for theme in PALETTES
    }
    every = int(samples[1] - samples[0]) if len(samples) > 1 else 1
    measured = {
        "distance": run.distance if run.pair is not None else None,
        "angle": run.orientation if run.has_orientation else None,
    }
    cycle = run.settings.cycle
    return {
        "times": np.round(run.times[samples], 3).tolist(),
        "positions": _packed(positions),
        "quaternions": _packed(quaternions),
        "bodies": bodies,
        "parts": [geom.to_json() for geom in geoms],
        "palettes": {n: p._asdict() for n, p in PALETTES.items()},
        "players": [
            {
                "name": name,
                "torso": labels[name][0],
                "label_height": round(labels[name][1], 3),
                "colours": {theme: colours[theme][name] for theme in colours},
            }
            for name in run.players
        ],
        "pair": [run.players.index(name) for name in run.opponents[0]]
        if run.opponents
        else None,
        "overlays": [
            {
                "layer": own.layer,
                "meaning": LAYERS[own.layer].meaning,
                "height": LAYERS[own.layer].height,
                "label": own.label,
                "colours": {
                    theme: own.colour(theme, colours[theme])
                    for theme in colours
                },
                "segments": _packed(own.segments.astype("<f4")),
                "times": own.times is not None
                and _packed(own.times.astype("<f4")),
                "lasting": own.lasting if isfinite(own.lasting) else None,
                "follows": [run.players.index(name) for name in own.follows],
            }
            for own in overlays_of(run, every)
        ],
        **{
            name: _series(values, samples) for name, values in measured.items()
        },
        "means": {
            name: values is not None
            and _series(whole_cycles(values, run.times, cycle), samples)
            for name, values in measured.items()
        },
        "theory": run.theory,
        "safety": next(iter(safety_areas(run).values()), None),
        "messages": distinct,
        "message_index": [distinct.index(text) for text in messages],
        "center": np.round(0.5 * (low + high), 3).tolist(),
        "half_extent": np.round(0.5 * (high - low) + TOP_MARGIN, 3).tolist(),
        "camera_distance": 1.4 + 1.05 * float(np.hypot(*(high - low))),
    }


def _packed(values: NDArray[Any]) -> str:
    """Return numbers of a page's own types as text."""
    return b64encode(values.tobytes()).decode("ascii")


def _extent(run: Run) -> tuple[Array, Array]:
    """Return the corners of all paths and the room, in [m]. Shapes (2,)."""
    paths = [track.torso[:, :2] for track in run.tracks.values()]
    points = np.concatenate([*paths, wall_corners(run.plan)])
    return points.min(axis=0), points.max(axis=0)


def _series(
    values: Array | None, samples: NDArray[np.int64]
) -> list[float | None] | None:
    """Return the values at the samples shown; None where not finite."""
    if values is None:
        return None
    shown = np.round(values[samples], 3).tolist()
    return [value if isfinite(value) else None for value in shown]


def _samples_shown(times: Array) -> NDArray[np.int64]:
    """Return the samples that are shown: evenly spaced, and the last one."""
    if len(times) < 2:
        return np.arange(len(times))
    every = max(1, round(1.0 / RATE / float(times[1] - times[0])))
    samples = np.arange(0, len(times), every)
    if samples[-1] != len(times) - 1:
        samples = np.append(samples, len(times) - 1)
    return samples
