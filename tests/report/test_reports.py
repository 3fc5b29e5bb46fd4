"""What is made of games: figure, page, film, tables and a bag, as stored.

Games are those of ``tests/data/games.toml``, values in ``reports.json``.
"""

from collections.abc import Iterator
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import Any

import mujoco
import numpy as np
import pytest
from matplotlib.figure import Figure

import drawn_figure
from stepaside.cli.tables import print_run
from stepaside.locomotion.policy.velocity_response import (
    AxisResponse,
    VelocityResponse,
)
from stepaside.report import replay_page
from stepaside.report.export import bag_recording
from stepaside.report.export.bag_messages import MessageFactory
from stepaside.report.export.recording import Recording, recording_of
from stepaside.report.export.signal_tables import tables_of
from stepaside.report.figure_style import colours_of
from stepaside.report.film import add_layers
from stepaside.report.film_camera import FilmCamera
from stepaside.report.film_captions import caption, describe_state
from stepaside.report.film_settings import VIEWS
from stepaside.report.overlays import overlays_of
from stepaside.report.robot_figure import draw_robot
from stepaside.report.run_figure import draw_run, draw_runs
from stepaside.report.scene import RunScene
from stepaside.report.study_figures import draw_response
from stepaside.robots.description import load_robot
from stepaside.strategies.velocity_set import BodyVelocity
from stored_games import run_of
from stored_values import compare_stored, content_of, summed, words_of

pytestmark = pytest.mark.xdist_group("stored-games")
REPORTED = [
    *("duel", "duel-hardware", "duel-mpc", "duel-people", "duel-cameras"),
    *("duel-room", "walk-pushed", "walk-fast", "team-physics", "crowd"),
    *("cyclic", "room-steps", "duel-steps", "duel-moving", "persons"),
]
WITH_SIGNALS = ("duel-cameras", "walk-pushed")


@pytest.fixture
def figures(monkeypatch: pytest.MonkeyPatch) -> list[Figure]:
    """Figures that were saved."""
    saved: list[Figure] = []

    def save(figure: Figure, file: Any, **_: Any) -> None:
        saved.append(figure)
        file.write(b"figure")

    monkeypatch.setattr(Figure, "savefig", save)
    return saved


def shown_by(figures: list[Figure]) -> Iterator[str | float]:
    for figure in figures:
        yield from drawn_figure.content_of(figure)
        figure.clear()


@pytest.mark.parametrize("name", REPORTED)
def test_a_game_is_drawn_printed_and_shown_as_stored(
    name: str,
    figures: list[Figure],
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    run = run_of(name)
    draw_run(run, tmp_path / "run.png")
    found = [*shown_by(figures), *summed(overlays_of(run, 9))]
    monkeypatch.setattr(replay_page, "_packed", np.asarray)
    found += summed(replay_page.page_data(run))
    last = len(run.times) - 1
    found += [describe_state(run, last * n // 5) for n in range(6)]
    for view in VIEWS:
        camera = FilmCamera(run, view, 40.0, 1.5)
        found += [view, *content_of(camera.view(last // 2))]
    print_run(run)
    found += words_of(capsys.readouterr().out)
    compare_stored("reports.json", name, found)


@pytest.mark.parametrize(
    "names", [["duel", "duel-mpc"], ["walk-pushed", "walk-fast"]]
)
def test_runs_are_compared_as_stored(
    names: list[str], figures: list[Figure], tmp_path: Path
) -> None:
    draw_runs([run_of(name) for name in names], tmp_path / "runs.png")
    found = shown_by(figures)
    compare_stored("reports.json", " and ".join(names), found)


def recorded(name: str) -> Recording:
    repeats = name in WITH_SIGNALS
    run = run_of(name)
    return recording_of(run, repeats=repeats, report=lambda _: None)


@pytest.mark.parametrize("name", [*WITH_SIGNALS, "team-physics", "duel-room"])
def test_signals_are_those_that_are_stored(name: str) -> None:
    pytest.importorskip("rosbags", reason="rosbags is not installed")
    recording = recorded(name)
    found = [*summed([recording.absent, tables_of(recording)])]
    topics: dict[str, list[Any]] = {}
    factory = MessageFactory()
    for message in bag_recording.messages_of(
        recording, factory, lambda *_: None
    ):
        topics.setdefault(message.topic, []).append(message)
    for topic, messages in topics.items():
        found += [topic, float(len(messages))]
        found += summed([messages[0], messages[len(messages) // 2]])
    compare_stored("reports.json", f"signals of {name}", found, 1e-4)


def test_moving_boxes_are_drawn_where_they_were() -> None:
    run = run_of("duel-moving")
    scene, room = RunScene(run), run.plan
    assert room is not None
    for index in (0, len(run.times) - 1):
        scene.put(index)
        place = room.moving[0].place_at(run.times[index])
        found = scene.data.body("moving box 1").xpos[:2]
        np.testing.assert_allclose(found, place)


def response() -> VelocityResponse:
    """Legs that deliver less than commanded, and drift aside."""
    axes = [
        AxisResponse(
            commands=(-0.4, 0.0, 0.5, 0.9),
            delivered=tuple(
                BodyVelocity(*np.roll([c * scale, 0.1 * c, 0.05], number))
                for c in (-0.4, 0.0, 0.5, 0.9)
            ),
            lag=0.1 * number,
        )
        for number, scale in enumerate((0.8, 0.6, 0.9))
    ]
    forward, lateral, turn = axes
    return VelocityResponse(forward, lateral, turn)


@pytest.mark.parametrize("name", ["robot", "response"])
def test_other_figures_are_those_that_are_stored(
    name: str, figures: list[Figure], tmp_path: Path
) -> None:
    file = tmp_path / "figure.png"
    if name == "robot":
        nao = load_robot("nao")  # frames of sensors do not show
        text = nao.path_of(nao.model).read_text()
        inner = '<body pos="9 0 0"/></body>'
        (tmp_path / nao.model).write_text(text.replace("</body>", inner, 1))
        draw_robot(replace(nao, folder=tmp_path), file)
    else:
        draw_response(response(), file)
    compare_stored("reports.json", name, shown_by(figures))


def test_a_picture_of_a_film_is_captioned_as_stored() -> None:
    """Lines are bars of the scene; the image is that of its text."""
    run = run_of("walk-pushed")
    scene = mujoco.MjvScene(RunScene(run).model, 1000)
    index = run.index_at(1.8)
    assert run.index_at(99.0) == len(run.times) - 1
    places = {n: track.torso[index] for n, track in run.tracks.items()}
    add_layers(scene, overlays_of(run, 9), 1.8, places, colours_of(run))
    found: list[str | float] = [float(scene.ngeom)]
    for bar in scene.geoms[: scene.ngeom]:
        found += [*summed([bar.pos, bar.mat, bar.size, bar.rgba])][1:]
    image = np.full((240, 426, 3), 90, dtype=np.uint8)
    labels = [("walker", np.array([0.0, 0.0, 0.5]), "#1f5fbf")]
    view = FilmCamera(run, "follow", 40.0, 1.5).view(index)
    project = partial(view.project, fovy=40.0)
    shown = caption(image, run, index, labels, project, 0.5).astype(float)
    for axis in (0, 1):
        for part in np.array_split(shown, 8, axis=axis):
            found += part.mean(axis=(0, 1)).tolist()
    compare_stored("reports.json", "film", found)
