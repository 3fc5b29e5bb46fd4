"""What is made of games: figure, page, film, tables and a bag, as stored.

Games are those of ``tests/data/games.toml``, values in ``reports.json``.
"""

from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from matplotlib.figure import Figure

import drawn_figure
from stepaside.cli.tables import print_run
from stepaside.report import replay_page
from stepaside.report.export import bag_recording
from stepaside.report.export.bag_messages import MessageFactory
from stepaside.report.export.recording import Recording, recording_of
from stepaside.report.export.signal_tables import tables_of
from stepaside.report.film_camera import FilmCamera
from stepaside.report.film_captions import describe_state
from stepaside.report.film_settings import VIEWS
from stepaside.report.overlays import overlays_of
from stepaside.report.run_figure import draw_run, draw_runs
from stored_games import run_of
from stored_values import compare_stored, content_of, summed, words_of

pytestmark = pytest.mark.xdist_group("stored-games")
REPORTED = [
    *("duel", "duel-hardware", "duel-mpc", "duel-people", "duel-cameras"),
    *("duel-room", "walk-pushed", "walk-fast", "team-physics", "crowd"),
    *("cyclic", "room-steps", "duel-steps"),
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
    names: list[str],
    figures: list[Figure],
    tmp_path: Path,
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
