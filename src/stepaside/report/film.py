"""Films of a run, rendered off screen by several processes."""

import os
from collections.abc import Callable, Iterable, Iterator, Mapping
from contextlib import contextmanager
from fractions import Fraction
from functools import cache, partial
from pathlib import Path

import mujoco
import numpy as np

from ..core.atomic_output import atomic_draft, reason_of
from ..core.errors import ConfigurationError, OutputError
from ..core.poses import Array
from ..core.worker_pool import worker_pool
from ..games.run import Run
from ..games.run_archive import load_run
from ..perception.images import Pixels
from ..sim.offscreen_rendering import (
    RAYCAST,
    OffscreenRenderer,
    RenderQuality,
    choose_renderer,
)
from ..sim.room_furnishing import is_room_wall
from .film_camera import HEIGHT, FilmCamera
from .film_captions import caption
from .film_settings import FilmSettings
from .overlays import SceneLines, overlays_of
from .palette import colours_in, fractions
from .scene import RunScene

HALF_WIDTH = 0.0025  # of a line, in [m]
TRAIL = 20.0  # time for which paths and footsteps remain, in [s]
LIGHT_DISTANCE = 4.0  # from a light to its target, in [m]
GEOMS = mujoco.mjtGeom
CHUNK = 15  # images that one worker renders at a time
PERIOD = 0.1  # between the points of a path, in [s]
QUALITY = RenderQuality(samples=4, shadow=2048, slices=18, stacks=10)
SHADOW_REACH = 4.0  # distance from the target at which they end, in [m]


class FilmRenderer:
    """Renders the images of a film of one run."""

    def __init__(self, run: Run, settings: FilmSettings, backend: str) -> None:
        """Set up the scene and the graphics."""
        self._run = run
        self._settings = settings
        self._scene = RunScene(run)
        gap = float(run.times[1] - run.times[0]) if len(run.times) > 1 else 1.0
        self._overlays = [
            each
            for each in overlays_of(run, max(1, round(PERIOD / gap)))
            if each.layer != "ZMP trace"
        ]
        self._colours = colours_in("light", run.players, run.identities)
        model = self._scene.model
        _dim_lights(model)
        self._fovy = float(model.vis.global_.fovy)
        aspect = settings.width / settings.height
        self._camera = FilmCamera(run, settings.camera, self._fovy, aspect)
        self._renderer = OffscreenRenderer(
            model,
            settings.width,
            settings.height,
            backend,
            QUALITY._replace(reach=max(SHADOW_REACH, self._camera.reach)),
        )

    def picture(self, time: float) -> Pixels:
        """Return the image of a time, in [s]. Shape (height, width, 3)."""
        run, settings = self._run, self._settings
        index = run.index_at(time)
        self._scene.put(index)
        view = self._camera.view(index)
        now = float(run.times[index])
        places = {n: track.torso[index] for n, track in run.tracks.items()}
        overlays = self._overlays if settings.layers else []

        def add(scene: mujoco.MjvScene) -> None:
            aim_light(scene, view.target)
            add_layers(scene, overlays, now, places, self._colours)

        with hidden_walls(self._scene.model, view.eye):
            image = self._renderer.draw(self._scene.data, view.camera(), add)
        if not settings.captions:
            return image
        labels = []
        for name, colour in self._colours.items():
            track = run.tracks[name]
            top = max(HEIGHT, 1.9 * float(track.com[index, 2]))
            labels.append((name, np.array([*places[name][:2], top]), colour))
        for own in overlays:
            if own.label:
                at = own.label_place(own.shown(now, places))
                colour = own.colour("light", self._colours)
                labels.append((own.label, at, colour))
        return caption(
            image,
            run,
            index,
            labels,
            partial(view.project, fovy=self._fovy),
            settings.speed,
        )

    def close(self) -> None:
        """Release the graphics."""
        self._renderer.close()


def _dim_lights(model: mujoco.MjModel) -> None:
    """Dim the lights so that the pale floor is not overexposed from above."""
    model.vis.headlight.ambient[:] = 0.3
    model.vis.headlight.diffuse[:] = 0.2
    model.vis.headlight.specular[:] = 0.0
    model.light_diffuse[:] = 0.5
    model.light_specular[:] = 0.1


@contextmanager
def hidden_walls(model: mujoco.MjModel, eye: Array) -> Iterator[list[int]]:
    """Hide the walls between a camera and the inside of a room.

    The room is centered at the world's origin; the camera's position is in
    the world, in [m]. Yields the numbers of the geoms.
    """
    walls = []
    for geom in range(model.ngeom):
        if not is_room_wall(model, geom):
            continue
        axes = np.zeros(9)
        mujoco.mju_quat2Mat(axes, model.geom_quat[geom])
        position = model.body_pos[model.geom_bodyid[geom]]
        thin = int(np.argmin(model.geom_size[geom][:2]))
        normal = axes.reshape(3, 3)[:, thin]
        # The room's center and the camera are on different sides of it.
        if (normal @ position) * (normal @ (position - eye)) < 0.0:
            walls.append(geom)
    opacity = model.geom_rgba[walls, 3].copy()
    model.geom_rgba[walls, 3] = 0.0
    try:
        yield walls
    finally:
        model.geom_rgba[walls, 3] = opacity


# One per process; workers reuse it for all chunks of a film.
_renderers: dict[tuple[Path, FilmSettings, str], FilmRenderer] = {}


def draw_chunk(
    folder: Path, settings: FilmSettings, backend: str, times: list[float]
) -> list[Pixels]:
    """Render some images in a process that keeps its renderer."""
    key = (folder, settings, backend)
    if key not in _renderers:
        _renderers[key] = FilmRenderer(load_run(folder), settings, backend)
    return [_renderers[key].picture(time) for time in times]


def render_images(
    folder: Path, settings: FilmSettings, times: list[float]
) -> Iterator[Pixels]:
    """Render the images of a film at times in [s], in order, on all cores.

    Raises:
        ConfigurationError: If this machine has no OpenGL, or the film begins
            after the end of the run.
    """
    backend = choose_renderer("auto")
    if backend == RAYCAST:
        raise ConfigurationError(
            "films need EGL or OSMesa, and neither works here: install "
            "libegl1 or libosmesa6"
        )
    if not times:
        raise ConfigurationError(
            f"film must begin before the run's end, got {settings.begin:g} [s]"
        )
    chunks = [times[i : i + CHUNK] for i in range(0, len(times), CHUNK)]
    draw = partial(draw_chunk, folder, settings, backend)
    count = os.cpu_count() or 1
    with worker_pool(count) as pool:
        # Only a few chunks are submitted ahead, to bound the memory used.
        ahead = [pool.submit(draw, c) for c in chunks[: 2 * count]]
        following = iter(chunks[2 * count :])
        while ahead:
            images = ahead.pop(0).result()
            chunk = next(following, None)
            if chunk is not None:
                ahead.append(pool.submit(draw, chunk))
            yield from images


def write_film(
    folder: Path,
    file: Path,
    settings: FilmSettings,
    report: Callable[[int, int], None],
) -> int:
    """Write a film: H.264, which browsers can play, or a GIF by its suffix.

    The file appears when it is complete. ``report`` is called with the
    numbers of finished and of all images.

    Returns:
        Number of images.

    Raises:
        ConfigurationError: As in :func:`render_images`.
        OutputError: If the file cannot be written.
    """
    times = settings.frame_times(float(load_run(folder).times[-1]))

    def images() -> Iterator[Pixels]:
        pictures = render_images(folder, settings, times)
        for done, picture in enumerate(pictures, 1):
            yield picture
            report(done, len(times))

    write = _write_gif if file.suffix == ".gif" else _write_video
    write(file, settings, images())
    return len(times)


def _write_video(
    file: Path, settings: FilmSettings, images: Iterator[Pixels]
) -> None:
    """Write a film as H.264.

    Raises:
        OutputError: If the file cannot be written.
    """
    import av

    options = {"movflags": "faststart"}
    rate = Fraction(settings.rate).limit_denominator(1000)
    with atomic_draft(file) as draft:
        try:
            with av.open(str(draft), "w", options=options) as out:
                stream = out.add_stream("libx264", rate=rate)
                stream.width, stream.height = settings.width, settings.height
                stream.pix_fmt = "yuv420p"
                stream.options = {"crf": "23", "preset": "veryfast"}
                for picture in images:
                    frame = av.VideoFrame.from_ndarray(picture, format="rgb24")
                    out.mux(stream.encode(frame))
                out.mux(stream.encode(None))
        except av.FFmpegError as error:
            raise OutputError(
                f"{file} could not be written: {reason_of(error)}"
            ) from error


def _write_gif(
    file: Path, settings: FilmSettings, images: Iterator[Pixels]
) -> None:
    """Write a short film as GIF."""
    from PIL import Image

    first, *others = (
        Image.fromarray(each).quantize(64, dither=Image.Dither.NONE)
        for each in images
    )
    with atomic_draft(file) as draft:
        first.save(
            draft,
            format="GIF",
            save_all=True,
            append_images=others,
            duration=round(1000.0 / settings.rate),
            loop=0,
            optimize=True,
        )


def add_layers(
    scene: mujoco.MjvScene,
    overlays: Iterable[SceneLines],
    now: float,
    places: Mapping[str, Array],
    colours: Mapping[str, str],
) -> None:
    """Add lines of a time, in [s], to a scene.

    Places are the positions of the players then, in [m], by name.
    """
    for overlay in overlays:
        rgba = _rgba(overlay.colour("light", colours))
        for start, end in overlay.shown(now, places, TRAIL):
            if scene.ngeom < scene.maxgeom:
                _add_bar(scene.geoms[scene.ngeom], start, end, rgba)
                scene.ngeom += 1


def _add_bar(
    geom: mujoco.MjvGeom, start: Array, end: Array, rgba: Array
) -> None:
    """Make a geom a bar, which has far fewer vertices than a cylinder."""
    none, upright = np.zeros(3), np.eye(3).ravel()
    mujoco.mjv_initGeom(geom, GEOMS.mjGEOM_CYLINDER, none, none, upright, rgba)
    mujoco.mjv_connector(geom, GEOMS.mjGEOM_CYLINDER, HALF_WIDTH, start, end)
    geom.type = GEOMS.mjGEOM_BOX


@cache
def _rgba(colour: str) -> Array:
    return np.array([*fractions(colour), 1.0], dtype=np.float32)


def aim_light(scene: mujoco.MjvScene, target: Array) -> None:
    """Move the lights that cast shadows so that they shine on a target."""
    for light in scene.lights[: scene.nlight]:
        if light.castshadow:
            light.pos[:] = target - LIGHT_DISTANCE * np.asarray(light.dir)
