"""Games of one, two and three players in figures, pages and films."""

import json
import re
from dataclasses import replace
from functools import cache
from pathlib import Path
from typing import Any

import matplotlib.pyplot as plt
import mujoco
import numpy as np
import pytest
from matplotlib.colors import to_hex
from matplotlib.figure import Figure

from stepaside.core.poses import Array
from stepaside.games.outcome import Outcome
from stepaside.games.run import Run
from stepaside.games.run_captions import describe_state
from stepaside.games.trajectory import Trajectory
from stepaside.games.walk_game import run_walk
from stepaside.games.walk_settings import WalkSettings
from stepaside.report import film_layers, run_folder
from stepaside.report.compare_figure import draw_comparison
from stepaside.report.figure_style import COLOURS, PUSHED, THEORY, colours_of
from stepaside.report.landed_footsteps import footsteps_in
from stepaside.report.replay_page import write_page
from stepaside.report.scene import RunScene
from stepaside.report.viewer.scene_layers import push_arrows

NAMES = ("walker", "hare", "tortoise")
PUSH = np.array([[0.1, 0.1, 0.3, -0.2, 0.0, 0.8]])


@cache
def game(count: int) -> Run:
    """Return robots that walk abreast, 1 m apart; the last is pushed."""
    alone = run_walk(WalkSettings(duration=0.4))
    tracks = {
        name: _beside(alone.walker, float(number))
        for number, name in enumerate(NAMES[:count])
    }
    last = NAMES[count - 1]
    tracks[last] = replace(tracks[last], pushes=PUSH)
    return Run(
        name="abreast",
        settings=alone.settings,
        outcome=Outcome.COMPLETED,
        message="played 0.40 s",
        duration=alone.duration,
        times=alone.times,
        tracks=tracks,
        summary=alone.summary,
    )


def _beside(track: Trajectory, y: float) -> Trajectory:
    assert track.qpos is not None
    columns = {"com": 1, "torso": 1, "qpos": 1}
    moved: dict[str, Array] = {}
    for name, column in columns.items():
        moved[name] = getattr(track, name).copy()
        moved[name][:, column] += y
    return replace(track, place=None, **moved)


by_count = pytest.mark.parametrize("count", [1, 2, 3])


@by_count
def test_a_run_has_its_players_and_the_least_distance(
    count: int,
) -> None:
    run = game(count)
    assert run.players == run.robots == NAMES[:count]
    assert run.theory is None and run.safety is None and run.circle is None
    if count == 1:
        assert run.pair is None and not run.has_orientation
        assert np.isnan(run.distance).all()
    else:
        assert run.has_orientation is (count == 2)
        np.testing.assert_allclose(run.distance, 1.0)
        assert len(run.opponents) == (1 if count == 2 else 3)
    if count == 2:
        np.testing.assert_allclose(run.orientation, 0.0, atol=1e-9)
    assert run.pushed_at(0.05) == () and run.pushed_at(0.1) == (
        NAMES[count - 1],
    )
    if count > 1:
        names = " and ".join(NAMES[:count])
        assert describe_state(run, 0) == f"{names} in motion"
        assert describe_state(run, 10) == f"{NAMES[count - 1]} is pushed"


def test_players_have_the_colours_of_their_roles_or_their_own() -> None:
    colours = colours_of(("evader", *NAMES, "pursuer"))
    assert colours["evader"] == COLOURS["evader"]
    assert colours["pursuer"] == COLOURS["pursuer"]
    assert len(set(colours.values())) == 5
    many = colours_of(f"robot-{i}" for i in range(20))
    assert len(many) == 20 and len(set(many.values())) > 5


@by_count
def test_every_player_is_in_the_figure(
    count: int, monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    figures: list[Figure] = []
    monkeypatch.setattr(
        Figure, "savefig", lambda f, *_, **__: figures.append(f)
    )
    monkeypatch.setattr(
        "stepaside.report.figure_style.plt.close", lambda _: None
    )
    run = game(count)
    run_folder.draw_run(run, tmp_path / "figure.png")
    every: Any = figures[0].axes
    (paths,) = [
        axes
        for axes in every
        if f"{NAMES[0]}, CoM" in [line.get_label() for line in axes.lines]
    ]
    for name, colour in colours_of(run.players).items():
        (way,) = [
            line for line in paths.lines if line.get_label() == f"{name}, CoM"
        ]
        np.testing.assert_allclose(
            np.column_stack(way.get_data()), run.tracks[name].com[:, :2]
        )
        assert to_hex(way.get_color()) == colour
    assert "Walk, seed 1: played 0.40 s" in figures[0].get_suptitle()
    if count > 1:
        draw_comparison([run, run], tmp_path / "both.png")
        assert len(figures[1].axes[0].lines) == 2 * count
    for figure in figures:
        plt.close(figure)


@by_count
def test_every_player_is_on_the_page(count: int, tmp_path: Path) -> None:
    run, file = game(count), tmp_path / "run.html"
    write_page(run, file)
    text = file.read_text(encoding="utf-8")
    (found,) = re.findall(r"(\{\"times\".*\})", text)
    shown = json.loads(found)
    assert [robot["name"] for robot in shown["players"]] == [*run.players]
    assert [robot["pushes"] for robot in shown["players"]] == [
        *([[]] * (count - 1)),
        PUSH.tolist(),
    ]
    assert (shown["distance"] is None) is (count == 1)
    assert (shown["angle"] is None) is (count != 2)
    assert shown["pair"] == (None if count == 1 else [0, 1])
    assert shown["safety"] is None and shown["safeties"] == []
    assert shown["sights"] == ([[0, 1]] if count == 2 else [])


@by_count
def test_every_player_is_in_the_film(count: int) -> None:
    run = game(count)
    drawn = mujoco.MjvScene(RunScene(run).model, maxgeom=5000)
    film_layers.add_layers(
        drawn, run=run, footsteps=footsteps_in(run), index=20, trail=0.8
    )
    colours = list(colours_of(run.players).values())
    for colour in colours:
        assert _of(drawn, colour)
    assert len(_of(drawn, THEORY)) == (1 if count == 2 else 0)
    (arrow,) = _of(drawn, PUSHED)
    assert arrow.type == mujoco.mjtGeom.mjGEOM_ARROW
    early = mujoco.MjvScene(RunScene(run).model, maxgeom=5000)
    film_layers.add_layers(
        early, run=run, footsteps=footsteps_in(run), index=3, trail=0.8
    )
    assert _of(early, PUSHED) == []


def _of(drawn: mujoco.MjvScene, colour: str) -> list[Any]:
    rgb = np.array(list(bytes.fromhex(colour[1:]))) / 255.0
    geoms = [drawn.geoms[i] for i in range(drawn.ngeom)]
    return [g for g in geoms if np.allclose(g.rgba[:3], rgb, atol=1e-3)]


def test_an_arrow_ends_where_the_push_was_applied() -> None:
    lines = push_arrows(PUSH, 0.5)
    np.testing.assert_allclose(lines[0, 1, :2], (0.3, -0.2))
    np.testing.assert_allclose(
        lines[0, 1, :2] - lines[0, 0, :2], 0.25 * PUSH[0, 4:]
    )
    for time, shown in ((0.09, 0), (0.1, 3), (1.09, 3), (1.11, 0)):
        assert len(push_arrows(PUSH, time)) == shown
    assert push_arrows(None, 0.5).shape == (0, 2, 3)
