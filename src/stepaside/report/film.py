"""Films of a run, drawn off screen."""

import os
from collections.abc import Callable, Iterator
from fractions import Fraction
from functools import partial
from pathlib import Path

import mujoco
import numpy as np

from ..core.atomic_output import reason_of, writing
from ..core.errors import ConfigurationError, OutputError
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
from .film_camera import FilmCamera
from .film_captions import caption, title_of
from .film_insets import FilmInsets, room_beside
from .film_layers import decorate, light_up
from .film_shot import FilmSettings
from .film_walls import see_through
from .scene import RunScene

CHUNK = 15  # pictures that one worker draws at a time
TRAIL = 20.0  # how long traces are, in [s]
FINE = RenderQuality(samples=4, shadow=2048, slices=18, stacks=10)
# Beyond, nothing has shadows; who looks far must not see where that is.
REACH = {"eyes": 12.0}
NEARBY = 4.0  # for all other cameras


class FilmRenderer:
    """Draws pictures of one run."""

    def __init__(self, run: Run, shot: FilmSettings, backend: str) -> None:
        """Set up graphics."""
        self._run, self._shot = run, shot
        self._stage = RunScene(run)
        model = self._stage.model
        _dim(model)
        self._fovy = float(model.vis.global_.fovy)
        wide, self._insets = shot.width, None
        if shot.camera == "split":
            beside = room_beside(shot.width, shot.height)
            wide -= beside
            size = beside, shot.height
            self._insets = FilmInsets(run, self._stage, backend, size)
        aspect = wide / shot.height
        self._man = FilmCamera(run, shot.camera, self._fovy, aspect)
        self._screen = OffscreenRenderer(
            model,
            wide,
            shot.height,
            backend,
            FINE._replace(
                reach=max(REACH.get(shot.camera, NEARBY), self._man.reach)
            ),
        )
        self._closest = closest_time(run)

    def picture(self, time: float) -> Pixels:
        """Picture of a time, in [s]. Shape (height, width, 3)."""
        run, shot = self._run, self._shot
        index = run.index_at(time)
        self._stage.put(index)
        view = self._man.view(index)

        def add(scene: mujoco.MjvScene) -> None:
            light_up(scene, view.target)
            if shot.layers:
                decorate(scene, run=run, index=index, trail=TRAIL)

        with see_through(self._stage.model, view.eye):
            drawn = self._screen.draw(self._stage.data, view.camera(), add)
        if shot.words:
            drawn = caption(
                drawn,
                run,
                index,
                view=view,
                fovy=self._fovy,
                pace=shot.pace(time, self._closest),
            )
        drawn = title_of(drawn, shot.title)
        if self._insets is not None:
            seen = self._insets.picture(index)
            drawn = np.concatenate([drawn, seen], axis=1)
        return drawn

    def close(self) -> None:
        """Let go of the graphics."""
        self._screen.close()
        if self._insets is not None:
            self._insets.close()


def _dim(model: mujoco.MjModel) -> None:
    """Let light fall so that a pale floor is not white, seen from above."""
    model.vis.headlight.ambient[:] = 0.3
    model.vis.headlight.diffuse[:] = 0.2
    model.vis.headlight.specular[:] = 0.0
    model.light_diffuse[:] = 0.5
    model.light_specular[:] = 0.1


def closest_time(run: Run) -> float | None:
    """When the first two of a run were closest, in [s]; None for one."""
    if run.distance is None:
        return None
    return float(run.times[int(np.argmin(run.distance))])


def instants_of(run: Run, shot: FilmSettings) -> list[float]:
    """Times of the pictures of a film of a run, in [s]."""
    return shot.instants(float(run.times[-1]), closest_time(run))


_cinemas: dict[tuple[Path, FilmSettings, str], FilmRenderer] = {}


def _draw(
    folder: Path, shot: FilmSettings, backend: str, times: list[float]
) -> list[Pixels]:
    """Draw some pictures in a process that keeps its graphics."""
    key = (folder, shot, backend)
    if key not in _cinemas:
        _cinemas[key] = FilmRenderer(load_run(folder), shot, backend)
    return [_cinemas[key].picture(time) for time in times]


def pictures(
    folder: Path, shot: FilmSettings, *, workers: int | None = None
) -> Iterator[Pixels]:
    """Draw the pictures of a film in order, on all cores.

    Args:
        folder: Run folder.
        shot: How the film is taken.
        workers: Processes; as many as there are cores by default.

    Raises:
        ConfigurationError: If the machine cannot draw, or there is nothing
            to draw.
    """
    backend = choose_renderer("auto")
    if backend == RAYCAST:
        raise ConfigurationError(
            "films need EGL or OSMesa, and neither works here: install "
            "libegl1 or libosmesa6"
        )
    times = instants_of(load_run(folder), shot)
    if not times:
        raise ConfigurationError(
            f"film must begin before the run's end, got {shot.begin:g} [s]"
        )
    chunks = [times[i : i + CHUNK] for i in range(0, len(times), CHUNK)]
    draw = partial(_draw, folder, shot, backend)
    count = workers or os.cpu_count() or 1
    with worker_pool(count) as pool:
        # A few chunks ahead of what was taken, so that memory is bounded.
        ahead = [pool.submit(draw, c) for c in chunks[: 2 * count]]
        following = iter(chunks[2 * count :])
        while ahead:
            drawn = ahead.pop(0).result()
            chunk = next(following, None)
            if chunk is not None:
                ahead.append(pool.submit(draw, chunk))
            yield from drawn


def write_video(
    folder: Path,
    file: Path,
    shot: FilmSettings,
    report: Callable[[int, int], None] | None = None,
) -> int:
    """Write a film as H.264, which browsers play.

    Args:
        folder: Run folder.
        file: Film to write; it appears when it is complete.
        shot: How it is taken.
        report: Called with the pictures that are done, and all of them.

    Returns:
        Number of pictures.
    """
    import av

    number = len(instants_of(load_run(folder), shot))
    done = 0
    with writing(file) as draft:
        try:
            with av.open(
                str(draft), "w", options={"movflags": "faststart"}
            ) as out:
                rate = Fraction(shot.rate).limit_denominator(1000)
                stream = out.add_stream("libx264", rate=rate)
                stream.width, stream.height = shot.width, shot.height
                stream.pix_fmt = "yuv420p"
                stream.options = {"crf": "23", "preset": "veryfast"}
                for picture in pictures(folder, shot):
                    frame = av.VideoFrame.from_ndarray(picture, format="rgb24")
                    out.mux(stream.encode(frame))
                    done += 1
                    if report is not None:
                        report(done, number)
                out.mux(stream.encode(None))
        except av.FFmpegError as error:
            raise OutputError(
                f"{file} could not be written: {reason_of(error)}"
            ) from error
    return done


def write_gif(
    folder: Path,
    file: Path,
    shot: FilmSettings,
    report: Callable[[int, int], None] | None = None,
) -> int:
    """Write a short film as GIF; see :func:`write_video`."""
    from PIL import Image

    number = len(instants_of(load_run(folder), shot))
    frames = []
    for picture in pictures(folder, shot):
        image = Image.fromarray(picture)
        frames.append(image.quantize(64, dither=Image.Dither.NONE))
        if report is not None:
            report(len(frames), number)
    with writing(file) as draft:
        frames[0].save(
            draft,
            format="GIF",
            save_all=True,
            append_images=frames[1:],
            duration=round(1000.0 / shot.rate),
            loop=0,
            optimize=True,
        )
    return len(frames)


__all__ = ["FilmSettings", "pictures", "write_gif", "write_video"]
