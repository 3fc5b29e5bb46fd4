"""Pages and films of a run, read back from what was written."""

import json
import re
from base64 import b64decode
from collections.abc import Iterator
from dataclasses import replace
from functools import cache
from pathlib import Path
from typing import Any

import mujoco
import numpy as np
import pytest

from stepaside.core.errors import ConfigurationError
from stepaside.core.poses import Array
from stepaside.games.duel import run_duel
from stepaside.games.duel_settings import DuelSettings, StartSettings
from stepaside.games.run import DuelRun
from stepaside.games.run_captions import describe_state
from stepaside.games.trajectory import Trajectory
from stepaside.report import film, film_layers, replay_page
from stepaside.report.cycle_means import whole_cycles
from stepaside.report.figure_style import COLOURS, THEORY
from stepaside.report.film import FilmRenderer, FilmSettings
from stepaside.report.landed_footsteps import footsteps_in
from stepaside.report.replay_page import write_page
from stepaside.report.scene import RunScene
from stepaside.report.visual_geoms import visual_geoms_of
from stepaside.sim.offscreen_rendering import RAYCAST
from synthetic_run import changed, drifted

TIMES: Array = 0.02 * np.arange(102, dtype=float)  # 2.02 s


@cache
def made() -> DuelRun:
    """A short run whose robots then are moved by hand."""
    settings = DuelSettings(
        seed=3, duration=2.01, start=StartSettings(1.2, 0.4, -0.2)
    )
    played = run_duel(settings)
    assert len(played.times) == len(TIMES)
    run = drifted(played, TIMES)
    run = changed(run, triggered_at_s=0.5, converged_at_s=1.8)
    landings = np.array([[0.5, -1.0, 1.1, 0.2, 0.3]])
    evader = replace(run.evader, landings=landings)
    tracks = {**run.tracks, "evader": evader}
    return replace(run, name="a </b> run", tracks=tracks)


def thinned(track: Trajectory, every: int) -> Trajectory:
    """Track with some of its samples."""
    assert track.qpos is not None
    return replace(
        track,
        com=track.com[::every],
        place=None if track.place is None else track.place[::every],
        torso=track.torso[::every],
        qpos=track.qpos[::every],
    )


def content(run: DuelRun, folder: Path) -> Any:
    """Data of the page's script."""
    file = folder / "run.html"
    write_page(run, file)
    text = file.read_text(encoding="utf-8")
    assert [p.name for p in folder.iterdir()] == ["run.html"]
    assert "a </b> run" not in text and "a &lt;/b&gt; run" in text
    (found,) = re.findall(r"(\{\"times\".*\})", text)
    return json.loads(found)


def test_a_page_shows_twenty_moments_a_second_and_the_last(
    tmp_path: Path,
) -> None:
    shown = content(made(), tmp_path)
    expected = [*(0.04 * np.arange(51)), 2.02]
    np.testing.assert_allclose(shown["times"], expected, atol=1e-9)


def test_a_page_without_frequent_samples_shows_them_all(
    tmp_path: Path,
) -> None:
    run = made()
    tracks = {n: thinned(track, 25) for n, track in run.tracks.items()}
    thin = replace(run, times=TIMES[::25], tracks=tracks)
    shown = content(thin, tmp_path)
    np.testing.assert_allclose(shown["times"], TIMES[::25], atol=1e-9)


def poses(shown: Any) -> tuple[Array, Array]:
    """Return positions [m] and quaternions by sample and body."""
    shape = (len(shown["times"]), len(shown["bodies"]))
    positions = np.frombuffer(b64decode(shown["positions"]), dtype="<f4")
    turns = np.frombuffer(b64decode(shown["quaternions"]), dtype="<i2")
    return positions.reshape(*shape, 3), turns.reshape(*shape, 4) / 32767.0


@pytest.mark.parametrize("away", [0.0, 7.0, -3000.0])
def test_bodies_on_the_page_are_where_they_were(
    tmp_path: Path, away: float
) -> None:
    """However far from the middle of the world that is."""
    run = made()
    tracks = {n: moved(track, away) for n, track in run.tracks.items()}
    run = replace(run, tracks=tracks)
    shown = content(run, tmp_path)
    places, turns = poses(shown)
    stage = RunScene(run)
    seen = {part.body for part in visual_geoms_of(stage.model)} - {0}
    assert shown["bodies"] == sorted(seen)
    for row, index in ((0, 0), (20, 40), (51, 101)):
        stage.put(index)
        there = stage.data.xpos[shown["bodies"]]
        assert abs(there[:, 0] - away).max() < 3.0
        np.testing.assert_allclose(places[row], there, atol=3e-4, rtol=0.0)
        turned = stage.data.xquat[shown["bodies"]]
        np.testing.assert_allclose(turns[row], turned, atol=2e-5)


def test_a_torso_without_visible_parts_is_on_the_page(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    run = made()
    torso = RunScene(run).model.body("evader/torso").id

    def others(model: Any) -> list[Any]:
        return [own for own in visual_geoms_of(model) if own.body != torso]

    monkeypatch.setattr(replay_page, "visual_geoms_of", others)
    shown = content(run, tmp_path)
    assert torso not in {part["body"] for part in shown["parts"]}
    assert torso in shown["bodies"] and shown["players"][1]["torso"] == torso


def moved(track: Trajectory, away: float) -> Trajectory:
    """Track of a robot that stands somewhere else."""
    assert track.qpos is not None
    qpos = np.array(track.qpos, dtype=np.float64)
    qpos[:, 0] += away
    return replace(track, qpos=qpos)


def test_a_page_tells_what_the_run_tells(tmp_path: Path) -> None:
    run = made()
    shown = content(run, tmp_path)
    chosen = [*range(0, 101, 2), 101]
    said = [shown["messages"][number] for number in shown["message_index"]]
    assert said == [describe_state(run, index) for index in chosen]
    assert len(set(said)) == 4 == len(shown["messages"])
    cycle = 2.0 * run.settings.gait.step_duration
    for key, values, size in (
        ("distance", run.distance, 5e-4),
        ("angle", run.orientation, 0.05),
    ):
        means = whole_cycles(values, run.times, cycle)[chosen]
        told = np.array(shown["means"][key], dtype=float)
        np.testing.assert_allclose(told, means, atol=size + 1e-9)
        assert np.isnan(told[[0, -1]]).all() and np.isfinite(told[25])
        np.testing.assert_allclose(
            shown[key], values[chosen], atol=size + 1e-9
        )
    assert run.theory is not None and run.circle is not None
    assert shown["theory"] == list(run.theory)
    np.testing.assert_allclose(shown["circle"], run.circle, atol=6e-4)
    assert shown["safety"] == 0.8
    both = np.concatenate(
        [track.torso[:, :2] for track in run.tracks.values()]
    )
    middle = 0.5 * (both.min(axis=0) + both.max(axis=0))
    np.testing.assert_allclose(shown["center"], middle, atol=6e-4)
    size = np.hypot(*(both.max(axis=0) - both.min(axis=0)))
    assert shown["camera_distance"] == pytest.approx(1.4 + 1.05 * size)
    stage = RunScene(run)
    for robot, name in zip(
        shown["players"], ("pursuer", "evader"), strict=True
    ):
        assert robot["name"] == name
        assert stage.model.body(robot["torso"]).name == f"{name}/torso"
        np.testing.assert_allclose(
            robot["trace"], run.tracks[name].com[chosen, :2], atol=6e-4
        )
        np.testing.assert_allclose(
            robot["landings"], footsteps_in(run)[name], atol=6e-4
        )
        assert robot["landings"] or name == "evader"
    never = changed(run, converged_at_s=None)
    other = tmp_path / "never"
    other.mkdir()
    assert content(never, other)["circle"] is None


def test_a_page_of_a_person_has_its_way_but_no_footsteps(
    tmp_path: Path,
) -> None:
    settings = DuelSettings(
        duration=0.1, pursuer="person", start=StartSettings(2.5, 0.0, 0.0)
    )
    run = replace(run_duel(settings), name="a </b> run")
    shown = content(run, tmp_path)
    person, robot = shown["players"]
    assert (person["name"], robot["name"]) == ("pursuer", "evader")
    model = RunScene(run).model
    assert model.body(person["torso"]).name == "pursuer/trunk"
    assert model.body(robot["torso"]).name == "evader/torso"
    assert person["landings"] == []
    chosen = [0, 2, 4, 5]
    np.testing.assert_allclose(
        person["trace"], run.pursuer.com[chosen, :2], atol=6e-4
    )
    bodies = {part["body"] for part in shown["parts"]}
    assert {person["torso"], robot["torso"]} <= bodies & set(shown["bodies"])
    # Heights over the torso: a person's trunk is a body on the floor.
    assert person["label_height"] + 1.0 > robot["label_height"] > 0.1


@pytest.mark.parametrize(
    ("shot", "last", "expected"),
    [
        (FilmSettings(rate=10.0, duration=0.3), 9.0, [0.0, 0.1, 0.2, 0.3]),
        (FilmSettings(rate=10.0, begin=0.8), 1.0, [0.8, 0.9, 1.0]),
        (
            FilmSettings(rate=10.0, speed=4.0, duration=1.0),
            9.0,
            [0.0, 0.4, 0.8],
        ),
        (FilmSettings(rate=10.0, begin=2.0), 2.0, [2.0]),
        (FilmSettings(rate=10.0, begin=2.1), 2.0, []),
        (FilmSettings(rate=10.0, begin=5.0), 2.0, []),
    ],
)
def test_pictures_of_a_film_are_evenly_spaced(
    shot: FilmSettings, last: float, expected: list[float]
) -> None:
    np.testing.assert_allclose(shot.frame_times(last), expected, atol=1e-12)


class FakeRenderer:
    """Keeps what it was asked to draw."""

    last: "FakeRenderer"  # made last

    def __init__(self, model: Any, *asked: Any):
        """Note size, backend and look."""
        self.asked = asked
        FakeRenderer.last = self
        self.drawn: list[tuple[Any, Any, Any]] = []

    def draw(self, data: Any, camera: Any, add: Any = None) -> Any:
        """Keep the bodies' places, the camera and what adds lines."""
        self.drawn.append((data.xpos.copy(), camera, add))
        return np.zeros((72, 128, 3), dtype=np.uint8)

    def close(self) -> None:
        """Be closed."""
        self.drawn.clear()


@pytest.fixture
def fake_renderer(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(film, "OffscreenRenderer", FakeRenderer)


def filmed(shot: FilmSettings, time: float) -> tuple[Any, Any, Any]:
    cinema = FilmRenderer(made(), shot, "egl")
    screen = FakeRenderer.last
    width, height, backend, look = screen.asked
    assert (width, height, backend) == (shot.width, shot.height, "egl")
    assert look.samples >= 4 and look.shadow >= 1024
    cinema.picture(time)
    (found,) = screen.drawn
    cinema.close()
    assert screen.drawn == []
    return found


@pytest.mark.usefixtures("fake_renderer")
@pytest.mark.parametrize(
    ("time", "index"), [(0.0, 0), (1.0, 50), (1.01, 51), (2.02, 101), (9, 101)]
)
def test_a_picture_is_of_the_time_asked_for(time: float, index: int) -> None:
    places, _, add = filmed(FilmSettings(), time)
    stage = RunScene(made())
    stage.put(index)
    np.testing.assert_array_equal(places, stage.data.xpos)
    bare, full = scene(), scene()
    add(full)
    film_layers.add_layers(
        bare,
        run=made(),
        footsteps=footsteps_in(made()),
        index=index,
        trail=20.0,
    )
    assert full.ngeom == bare.ngeom
    _, _, add = filmed(FilmSettings(layers=False), time)
    add(empty := scene())
    assert empty.ngeom == 0


def scene() -> mujoco.MjvScene:
    return mujoco.MjvScene(RunScene(made()).model, maxgeom=2000)


def lines_of(drawn: mujoco.MjvScene, colour: str) -> list[Any]:
    rgb = np.array(list(bytes.fromhex(colour[1:]))) / 255.0
    return [
        geom
        for geom in drawn.geoms[: drawn.ngeom]
        if np.allclose(geom.rgba[:3], rgb, atol=1e-3)
    ]


def ends(geom: Any) -> Array:
    """Ends of a line in the world. Shape (2, 3)."""
    axis = np.asarray(geom.mat).reshape(3, 3)[:, 2]
    half = geom.size[2] * axis
    return np.array([geom.pos - half, geom.pos + half])


def test_lines_of_a_film_lie_where_the_run_was() -> None:
    run, index = made(), 60
    drawn = scene()
    film_layers.add_layers(
        drawn,
        run=run,
        footsteps={
            name: np.zeros((0, 5)) if t.landings is None else t.landings
            for name, t in run.tracks.items()
        },
        index=index,
        trail=0.8,
    )
    (sight, *circle) = lines_of(drawn, THEORY)
    places = [run.tracks[n].torso[index, :2] for n in COLOURS]
    np.testing.assert_allclose(
        np.sort(ends(sight), axis=0),
        np.sort([[*p, 0.25] for p in places], axis=0),
        atol=1e-5,
    )
    assert run.circle is not None
    x, y, size = run.circle
    corners = np.concatenate([ends(g) for g in circle])
    away = np.hypot(corners[:, 0] - x, corners[:, 1] - y)
    np.testing.assert_allclose(away, size, atol=1e-5)
    assert len(circle) == 60
    np.testing.assert_allclose(corners[:, 2], 0.002, atol=1e-6)
    blue = lines_of(drawn, COLOURS["evader"])
    (foot,) = [g for g in blue if g.rgba[3] < 0.9]
    heading = 0.3
    at = np.array([1.1 + 0.02 * np.cos(heading), 0.2 + 0.02 * np.sin(heading)])
    np.testing.assert_allclose(foot.pos[:2], at, atol=1e-5)
    frame = np.asarray(foot.mat).reshape(3, 3)
    np.testing.assert_allclose(
        frame[:2, 0], [np.cos(heading), np.sin(heading)], atol=1e-5
    )
    np.testing.assert_allclose(np.linalg.det(frame), 1.0, atol=1e-5)
    np.testing.assert_allclose(foot.size[:2], film_layers.FOOTPRINT, atol=1e-6)
    assert foot.rgba[3] == pytest.approx(0.55)
    rest = [ends(g) for g in blue if g.rgba[3] > 0.9]
    safety = [e for e in rest if abs(e[0, 2] - 0.003) < 1e-6]
    assert len(safety) == 60
    away = np.hypot(*(np.concatenate(safety)[:, :2] - places[1]).T)
    np.testing.assert_allclose(away, 0.8, atol=1e-4)
    trace = [e for e in rest if abs(e[0, 2] - 0.004) < 1e-6]
    # 0.8 s before the sample, one line for each sample.
    assert len(trace) == 40
    com = run.evader.com[20:61, :2]
    ways = np.concatenate(trace)[:, :2]
    np.testing.assert_allclose(ways.min(axis=0), com.min(axis=0), atol=1e-5)
    np.testing.assert_allclose(ways.max(axis=0), com.max(axis=0), atol=1e-5)


@pytest.mark.parametrize(
    ("index", "trail", "shown"),
    [(0, 20.0, 1), (20, 0.4, 1), (60, 0.8, 1), (60, 0.6, 0), (101, 9.0, 1)],
)
def test_footprints_come_half_a_second_early_and_go_with_the_trail(
    index: int, trail: float, shown: int
) -> None:
    drawn = scene()
    film_layers.add_layers(
        drawn,
        run=made(),
        footsteps=footsteps_in(made()),
        index=index,
        trail=trail,
    )
    boxes = [
        geom
        for geom in lines_of(drawn, COLOURS["evader"])
        if geom.rgba[3] < 0.9
    ]
    assert len(boxes) == shown


def test_a_full_scene_takes_no_more() -> None:
    small = mujoco.MjvScene(RunScene(made()).model, maxgeom=10)
    film_layers.add_layers(
        small, run=made(), footsteps=footsteps_in(made()), index=60, trail=20.0
    )
    assert small.ngeom == 10


class InlinePool:
    """A pool of processes that are none."""

    def __init__(self, count: int) -> None:
        """Note nothing."""

    def __enter__(self) -> "InlinePool":
        """Begin."""
        return self

    def __exit__(self, *error: object) -> None:
        """End."""

    def submit(self, draw: Any, times: list[float]) -> Any:
        """Draw when the result is asked for."""

        class Later:
            def result(self) -> Any:
                return draw(times)

        return Later()


def test_pictures_come_in_order_and_all_of_them(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(film, "choose_renderer", lambda wanted: "egl")
    monkeypatch.setattr(film, "load_run", lambda folder: made())
    monkeypatch.setattr(film, "worker_pool", InlinePool)
    monkeypatch.setattr(film, "draw_chunk", lambda f, s, b, times: list(times))
    shot = FilmSettings(rate=100.0)
    for workers in (1, 2, 30):
        drawn = list(film.render_images(Path("run"), shot, workers=workers))
        np.testing.assert_allclose(drawn, 0.01 * np.arange(203))
    with pytest.raises(ConfigurationError, match="before the run's end"):
        list(film.render_images(Path("run"), FilmSettings(begin=5.0)))
    monkeypatch.setattr(film, "choose_renderer", lambda wanted: RAYCAST)
    with pytest.raises(ConfigurationError, match="EGL or OSMesa"):
        list(film.render_images(Path("run"), shot))


def test_a_worker_keeps_its_graphics(monkeypatch: pytest.MonkeyPatch) -> None:
    began: list[Any] = []

    class Kept:
        def __init__(self, *arguments: Any) -> None:
            began.append(arguments)

        def picture(self, time: float) -> float:
            return 2.0 * time

    monkeypatch.setattr(film, "FilmRenderer", Kept)
    monkeypatch.setattr(film, "load_run", lambda folder: folder)
    monkeypatch.setattr(film, "_renderers", {})
    for times in ([1.0, 2.0], [3.0]):
        drawn = film.draw_chunk(Path("run"), FilmSettings(), "egl", times)
        assert drawn == [2.0 * time for time in times]
    assert began == [(Path("run"), FilmSettings(), "egl")]


def shades(count: int) -> Iterator[Any]:
    for number in range(count):
        yield np.full((48, 64, 3), 40 * number, dtype=np.uint8)


@pytest.mark.parametrize("kind", ["gif", "mp4"])
def test_films_have_their_pictures_and_their_rate(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, kind: str
) -> None:
    monkeypatch.setattr(film, "load_run", lambda folder: made())
    monkeypatch.setattr(film, "render_images", lambda folder, shot: shades(6))
    told: list[tuple[int, int]] = []
    file = tmp_path / f"run.{kind}"
    shot = FilmSettings(64, 48, rate=5.0, duration=1.0)

    def report(done: int, all_of_them: int) -> None:
        told.append((done, all_of_them))

    write = film.write_gif if kind == "gif" else film.write_video
    assert write(tmp_path, file, shot, report) == 6
    assert told == [(done, 6) for done in range(1, 7)]
    assert list(tmp_path.iterdir()) == [file]
    if kind == "gif":
        image = pytest.importorskip("PIL.Image").open(file)
        assert image.n_frames == 6 and image.info["duration"] == 200
        assert image.info["loop"] == 0 and image.size == (64, 48)
        return
    av = pytest.importorskip("av")
    with av.open(str(file)) as out:
        assert out.streams.video[0].average_rate == 5
        frames = [f.to_ndarray(format="rgb24") for f in out.decode(video=0)]
    levels = [frame.mean() for frame in frames]
    np.testing.assert_allclose(levels, 40.0 * np.arange(6), atol=6.0)


def test_a_film_that_fails_leaves_nothing_behind(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    pytest.importorskip("av")

    def failing(folder: Path, shot: FilmSettings) -> Iterator[Any]:
        yield from shades(2)
        raise RuntimeError("the light went out")

    monkeypatch.setattr(film, "load_run", lambda folder: made())
    monkeypatch.setattr(film, "render_images", failing)
    with pytest.raises(RuntimeError, match="light"):
        film.write_video(tmp_path, tmp_path / "run.mp4", FilmSettings(64, 48))
    assert list(tmp_path.iterdir()) == []
