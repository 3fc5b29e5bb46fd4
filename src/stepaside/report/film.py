"""Films of a run, drawn off screen."""

import os
from collections.abc import Callable, Iterator
from concurrent.futures import ProcessPoolExecutor
from fractions import Fraction
from functools import partial
from math import floor
from multiprocessing import get_context
from pathlib import Path
from typing import NamedTuple

import mujoco
import numpy as np

from ..errors import ConfigurationError, OutputError
from ..games.folder import load_run
from ..games.run import Run
from ..games.settings import PLAYERS
from ..outputs import reason_of, writing
from ..sensing.images import Pixels
from ..world.graphics import RAYCAST, Screen, choose_renderer
from .film_layers import decorate
from .stage import Stage

CHUNK = 15  # pictures that one worker draws at a time
TRAIL = 20.0  # how long traces are, in [s]


class Shot(NamedTuple):
    """How a film is taken.

    Attributes:
        width: Of a picture, in [pixels].
        height: Likewise.
        rate: Pictures a second.
        speed: Time of the run per time of the film.
        begin: When it begins, in [s] of the run.
        duration: How much of the run it shows, in [s].
        following: Whether the camera follows the robots.
        layers: Whether lines are drawn in.
    """

    width: int = 640
    height: int = 480
    rate: float = 30.0
    speed: float = 1.0
    begin: float = 0.0
    duration: float = 60.0
    following: bool = False
    layers: bool = True

    def instants(self, last: float) -> list[float]:
        """Times of the pictures in the run, in [s].

        Args:
            last: End of the run, in [s].
        """
        end = min(last, self.begin + self.duration)
        step = self.speed / self.rate
        number = floor((end - self.begin) / step + 1e-9) + 1
        return [self.begin + i * step for i in range(max(number, 0))]


class Cinema:
    """Draws pictures of one run."""

    def __init__(self, run: Run, shot: Shot, backend: str) -> None:
        """Set up graphics."""
        self._run, self._shot = run, shot
        self._stage = Stage(run)
        self._screen = Screen(
            self._stage.model, shot.width, shot.height, backend
        )
        middle = np.concatenate(
            [run.tracks[name].torso[:, :2] for name in PLAYERS]
        )
        low, high = middle.min(axis=0), middle.max(axis=0)
        self._center = 0.5 * (low + high)
        self._extent = float(np.hypot(*(high - low)))

    def picture(self, time: float) -> Pixels:
        """Picture of a time, in [s]. Shape (height, width, 3)."""
        run, shot = self._run, self._shot
        index = int(np.searchsorted(run.times, time - 1e-9))
        index = min(index, len(run.times) - 1)
        self._stage.put(index)
        camera = mujoco.MjvCamera()
        camera.type = mujoco.mjtCamera.mjCAMERA_FREE
        camera.azimuth, camera.elevation = 60.0, -38.0
        center, away = self._center, 0.9 + 0.95 * self._extent
        if shot.following:
            places = [run.tracks[n].torso[index, :2] for n in PLAYERS]
            center = 0.5 * (places[0] + places[1])
            away = 1.1 + float(np.hypot(*(places[1] - places[0])))
        camera.lookat[:] = [*center, 0.2]
        camera.distance = away
        if not shot.layers:
            return self._screen.draw(self._stage.data, camera)
        add = partial(decorate, run=run, index=index, trail=TRAIL)
        return self._screen.draw(self._stage.data, camera, add)

    def close(self) -> None:
        """Let go of the graphics."""
        self._screen.close()


_cinemas: dict[tuple[Path, Shot, str], Cinema] = {}


def _draw(
    folder: Path, shot: Shot, backend: str, times: list[float]
) -> list[Pixels]:
    """Draw some pictures in a process that keeps its graphics."""
    key = (folder, shot, backend)
    if key not in _cinemas:
        _cinemas[key] = Cinema(load_run(folder), shot, backend)
    return [_cinemas[key].picture(time) for time in times]


def pictures(
    folder: Path, shot: Shot, *, workers: int | None = None
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
    times = shot.instants(float(load_run(folder).times[-1]))
    if not times:
        raise ConfigurationError(
            f"film must begin before the run's end, got {shot.begin:g} [s]"
        )
    chunks = [times[i : i + CHUNK] for i in range(0, len(times), CHUNK)]
    draw = partial(_draw, folder, shot, backend)
    count = workers or os.cpu_count() or 1
    with ProcessPoolExecutor(count, get_context("spawn")) as pool:
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
    shot: Shot,
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

    number = len(shot.instants(float(load_run(folder).times[-1])))
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
    shot: Shot,
    report: Callable[[int, int], None] | None = None,
) -> int:
    """Write a short film as GIF; see :func:`write_video`."""
    from PIL import Image

    number = len(shot.instants(float(load_run(folder).times[-1])))
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


__all__ = ["Shot", "pictures", "write_gif", "write_video"]
