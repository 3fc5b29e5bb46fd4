"""The page of a run, read back from what was written."""

import json
import re
from base64 import b64decode
from dataclasses import replace
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from stepaside.core.poses import Array
from stepaside.games.game_settings import StartSettings, duel
from stepaside.games.recorded_game import run_game
from stepaside.games.run import Run
from stepaside.games.trajectory import Trajectory, whole_cycles
from stepaside.report.film_captions import describe_state
from stepaside.report.overlays import circle_of, overlays_of
from stepaside.report.replay_page import write_page
from stepaside.report.scene import RunScene
from stepaside.report.visual_geoms import visual_geoms_of
from synthetic_run import changed, drifted

TIMES: Array = 0.02 * np.arange(102, dtype=float)  # 2.02 s


@cache
def made() -> Run:
    """A short run whose robots then are moved by hand."""
    settings = duel(seed=3, duration=2.01, start=StartSettings(1.2, 0.4, -0.2))
    played = run_game(settings)
    assert len(played.times) == len(TIMES)
    run = drifted(played, TIMES)
    run = changed(run, triggered_at_s=0.5, converged_at_s=1.8)
    landings = np.array([[0.5, -1.0, 1.1, 0.2, 0.3]])
    evader = replace(run.evader, landings=landings)
    tracks = {**run.tracks, "evader": evader}
    return replace(run, name="a </b> run", tracks=tracks)


def content(run: Run, folder: Path) -> Any:
    """Data of the page's script."""
    file = folder / "run.html"
    write_page(run, file)
    text = file.read_text(encoding="utf-8")
    assert [p.name for p in folder.iterdir()] == ["run.html"]
    assert "a </b> run" not in text and "a &lt;/b&gt; run" in text
    (found,) = re.findall(r"(\{\"times\".*\})", text)
    return json.loads(found)


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
    assert run.theory is not None and circle_of(run) is not None
    assert shown["theory"] == list(run.theory)
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
    for told, own in zip(shown["overlays"], overlays_of(run, 2), strict=True):
        assert told["layer"] == own.layer and told["label"] == own.label
        ends = np.frombuffer(b64decode(told["segments"]), dtype="<f4")
        np.testing.assert_allclose(ends, own.segments.ravel(), atol=1e-5)


def test_a_page_of_a_person_has_its_way_but_no_footsteps(
    tmp_path: Path,
) -> None:
    settings = duel(
        duration=0.1,
        pursuer={"body": "person"},
        start=StartSettings(2.5, 0.0, 0.0),
    )
    run = replace(run_game(settings), name="a </b> run")
    shown = content(run, tmp_path)
    person, robot = shown["players"]
    assert (person["name"], robot["name"]) == ("pursuer", "evader")
    model = RunScene(run).model
    assert model.body(person["torso"]).name == "pursuer/trunk"
    assert model.body(robot["torso"]).name == "evader/torso"
    bodies = {part["body"] for part in shown["parts"]}
    assert {person["torso"], robot["torso"]} <= bodies & set(shown["bodies"])
    # Heights over the torso: a person's trunk is a body on the floor.
    assert person["label_height"] + 1.0 > robot["label_height"] > 0.1
