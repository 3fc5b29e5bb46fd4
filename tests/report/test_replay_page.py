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
from stepaside.games.trajectory import Trajectory
from stepaside.report.replay_page import write_page
from stepaside.report.scene import RunScene
from stepaside.report.visual_geoms import visual_geoms_of
from synthetic_run import drifted

TIMES: Array = 0.02 * np.arange(102, dtype=float)  # 2.02 s


@cache
def made() -> Run:
    """A short run whose robots then are moved by hand."""
    settings = duel(seed=3, duration=2.01, start=StartSettings(1.2, 0.4, -0.2))
    played = run_game(settings)
    assert len(played.times) == len(TIMES)
    return replace(drifted(played, TIMES), name="a </b> run")


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
