"""Film strip: images evenly over time, each above its top view."""

from collections.abc import Iterator
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from stepaside.games.duel_settings import PLAYERS
from stepaside.games.run import Run
from stepaside.games.trajectory import Trajectory
from stepaside.report import film_strip
from stepaside.report.film import FilmSettings, frame_times_of
from stepaside.report.film_strip import FRAMES, strip_settings, write_strip
from synthetic_run import run_of

TIMES = np.linspace(0.0, 30.0, 301)


@cache
def run() -> Run:
    """Return a run of two players that walk apart."""
    tracks = {
        name: Trajectory(
            com=np.column_stack([way, 0.1 * TIMES, 0.27 + 0.0 * TIMES]),
            torso=np.column_stack([way, 0.1 * TIMES, 0.0 * TIMES]),
        )
        for name, way in zip(PLAYERS, (-TIMES, TIMES), strict=True)
    }
    return run_of(TIMES, tracks)


@pytest.mark.parametrize(
    ("begin", "duration", "end"), [(0.0, 100.0, 30.0), (4.0, 12.0, 16.0)]
)
def test_images_are_evenly_spaced_from_begin_to_end(
    begin: float, duration: float, end: float
) -> None:
    film = FilmSettings(begin=begin, duration=duration, speed=3.0, slow=True)
    times = frame_times_of(run(), strip_settings(film, 30.0))
    np.testing.assert_allclose(times, np.linspace(begin, end, FRAMES))


def test_a_strip_has_each_image_above_its_top_view(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    drawn: list[float] = []

    def shades(folder: Path, shot: FilmSettings) -> Iterator[Any]:
        for number in range(FRAMES):
            yield np.full((48, 64, 3), 40 * number, dtype=np.uint8)

    def top(axes: Any, run: Run, index: int) -> None:
        drawn.append(float(run.times[index]))

    monkeypatch.setattr(film_strip, "load_run", lambda folder: run())
    monkeypatch.setattr(film_strip, "render_images", shades)
    monkeypatch.setattr(film_strip, "draw_top", top)
    file = tmp_path / "strip.png"
    reported: list[tuple[int, int]] = []
    count = write_strip(
        tmp_path,
        file,
        FilmSettings(),
        lambda done, total: reported.append((done, total)),
    )
    assert count == FRAMES and file.stat().st_size > 0
    np.testing.assert_allclose(drawn, [0.0, 10.0, 20.0, 30.0])
    assert reported == [(done, FRAMES) for done in range(1, FRAMES + 1)]
