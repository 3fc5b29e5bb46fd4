"""Test figure, colours, page and film of games of several players."""

import json
import re
from functools import cache
from itertools import combinations
from pathlib import Path

import matplotlib.pyplot as plt
import mujoco
import numpy as np
import pytest
from matplotlib.figure import Figure

from stepaside.core.player_colours import markers_of
from stepaside.games.game_file import parse_game
from stepaside.games.game_match import run_game
from stepaside.games.run import MatchRun
from stepaside.games.run_captions import describe_state
from stepaside.report import film_layers
from stepaside.report.figure_style import EVADER, PURSUER, colours_of
from stepaside.report.landed_footsteps import footsteps_in
from stepaside.report.palette import colours_in, contrast
from stepaside.report.replay_page import write_page
from stepaside.report.run_folder import draw_run
from stepaside.report.scene import RunScene


@cache
def run() -> MatchRun:
    """Return two pursuers, an evader and a person, by templates."""
    players = [
        {"name": "red", "role": "pursuer"},
        {"name": "ruby", "role": "pursuer"},
        {"name": "blue", "role": "evader"},
        {
            "name": "guest",
            "body": "person",
            "start": [3.0, 0.0, 0.0],
            "goal": [-3.0, 0.0],
        },
    ]
    entries = {"players": players, "level": "steps", "duration": 4.0}
    return run_game(parse_game(entries, "game"))


def test_roles_have_shades_of_their_colour_and_markers() -> None:
    colours = colours_of(run().players, run().identities)
    assert colours["red"] == PURSUER and colours["blue"] == EVADER
    assert len(set(colours.values())) == 4
    assert len(set(markers_of(run().tracks).values())) == 4

    def parts(colour: str) -> list[int]:
        return list(bytes.fromhex(colour[1:]))

    for name in ("red", "ruby"):
        assert np.argmax(parts(colours[name])) == 0
    assert np.ptp(parts(colours["guest"])) < 10
    for theme in ("light", "dark"):
        shown = colours_in(theme, run().players, run().identities)
        for one, other in combinations(shown.values(), 2):
            assert one != other
    assert contrast(colours["red"], colours["ruby"]) > 1.2


def test_every_player_and_pair_is_in_the_figure(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    figures: list[Figure] = []
    monkeypatch.setattr(
        Figure, "savefig", lambda f, *_, **__: figures.append(f)
    )
    monkeypatch.setattr(
        "stepaside.report.figure_style.plt.close", lambda _: None
    )
    draw_run(run(), tmp_path / "game.png")
    labels = {
        line.get_label() for axes in figures[0].axes for line in axes.lines
    }
    assert {"red (pursuer)", "blue (evader)", "guest (bystander)"} <= labels
    assert {
        f"{one} - {other}" for one, other in combinations(run().players, 2)
    } <= labels
    plt.close(figures[0])


def test_the_page_and_the_film_show_every_player(tmp_path: Path) -> None:
    write_page(run(), tmp_path / "run.html")
    text = (tmp_path / "run.html").read_text(encoding="utf-8")
    (found,) = re.findall(r"(\{\"times\".*\})", text)
    shown = json.loads(found)
    players = shown["players"]
    assert shown["pair"] == [0, 2]  # a pursuer and the evader
    np.testing.assert_allclose(
        shown["distance"][0], run().distance[0], atol=1e-3
    )
    assert [player["name"] for player in players] == [*run().players]
    scene = RunScene(run())
    drawn = mujoco.MjvScene(scene.model, maxgeom=5000)
    film_layers.add_layers(
        drawn, run=run(), footsteps=footsteps_in(run()), index=100, trail=2.0
    )
    assert drawn.ngeom > 0
    scene.put(100)
    for name in run().players:
        body = scene.model.body(f"{name}/trunk").id
        np.testing.assert_allclose(
            scene.data.xpos[body, :2], run().tracks[name].torso[100, :2]
        )


def test_the_caption_names_the_nearest_opponents() -> None:
    text = describe_state(run(), 0)
    starts = {n: t.torso[0, :2] for n, t in run().tracks.items()}
    least = min(
        float(np.hypot(*(starts[name] - starts["blue"])))
        for name in ("red", "ruby")
    )
    assert text.endswith(f"{least:.2f} m") and "blue" in text
    assert f"{run().distance[0]:.2f} m" in text
