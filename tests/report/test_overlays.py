"""What lies over a scene: laws of its lines."""

from dataclasses import replace

import numpy as np
import pytest

from stepaside.games.game_settings import StartSettings, duel
from stepaside.games.recorded_game import run_game
from stepaside.games.run import Run
from stepaside.locomotion.control_settings import ControlSettings
from stepaside.report.overlays import (
    LAYERS,
    PUSH_LENGTH,
    PUSH_SHOWN,
    footsteps_in,
    line_of_sight,
    overlays_of,
    push_arrows,
    safety_ring,
    soles,
)
from stepaside.report.scene import RunScene
from stepaside.sim.body_settings import BODIES

PLACES = {"a": np.array([1.0, 2.0, 0.3]), "b": np.array([-1.0, 0.5, 0.0])}
PUSHES = np.array([[2.0, 0.1, 0.5, -0.5, 0.3, 0.4]])


@pytest.fixture(scope="module")
def run() -> Run:
    start = StartSettings(0.7, 0.0, 0.3)
    return run_game(duel(seed=3, duration=3.0, start=start))


def test_a_ring_moves_with_its_player() -> None:
    shown = safety_ring("a", 0.8).shown(0.0, PLACES)
    away = np.hypot(*(shown[..., :2] - PLACES["a"][:2]).T)
    np.testing.assert_allclose(away, 0.8)
    np.testing.assert_allclose(shown[:, 1], np.roll(shown[:, 0], -1, 0))


def test_a_line_of_sight_connects_two_players() -> None:
    (line,) = line_of_sight("a", "b").shown(5.0, PLACES)
    height = LAYERS["line of sight"].height
    ends = [[*PLACES[name][:2], height] for name in "ab"]
    np.testing.assert_allclose(line, ends)


def test_an_arrow_is_shown_for_a_second_along_its_push() -> None:
    arrow = push_arrows("a", PUSHES)
    for now, count in ((1.99, 0), (2.0, 3), (2.9, 3), (2.0 + PUSH_SHOWN, 0)):
        assert len(arrow.shown(now, {})) == count
    (start, tip), *barbs = arrow.shown(2.5, {})[..., :2]
    np.testing.assert_allclose(tip, PUSHES[0, 2:4])
    np.testing.assert_allclose(tip - start, PUSH_LENGTH * PUSHES[0, 4:])
    for one, other in barbs:
        own = one + other - tip  # the end that is not the tip
        assert (own - tip) @ (start - tip) > 0.0


def test_a_path_grows_and_forgets_what_is_older_than_the_trail(
    run: Run,
) -> None:
    (path,) = (
        each
        for each in overlays_of(run)
        if (each.layer, each.owner) == ("CoM trace", "evader")
    )
    shown = path.shown(1.0, {}, trail=0.5)
    since, now = run.index_at(0.5), run.index_at(1.0)
    com = run.evader.com[since : now + 1, :2]
    np.testing.assert_allclose(shown[:, 0, :2], com[:-1])
    np.testing.assert_allclose(shown[:, 1, :2], com[1:])
    assert len(path.shown(1e3, {})) == len(run.times) - 1


def test_outlines_of_soles_lie_where_the_soles_landed(run: Run) -> None:
    rows = footsteps_in(run, "pursuer")
    sole = run.settings.player("pursuer").gait.sole
    outlines = soles(rows[:, 1:], sole).reshape(len(rows), 4, 2, 2)
    for (_, side, x, y, heading), outline in zip(rows, outlines, strict=True):
        away = outline[:, 0] - (x, y)
        ahead = away @ (np.cos(heading), np.sin(heading))
        aside = side * (away @ (-np.sin(heading), np.cos(heading)))
        assert (ahead.min(), ahead.max()) == pytest.approx(
            (sole.back, sole.front)
        )
        assert (aside.min(), aside.max()) == pytest.approx(
            (-sole.inner, sole.outer)
        )


def test_colours_are_those_of_the_players_or_of_the_layer(
    run: Run,
) -> None:
    pursuer = replace(run.pursuer, pushes=PUSHES)
    tracks = {**run.tracks, "pursuer": pursuer}
    run = replace(run, tracks=tracks)
    colours = {"pursuer": "#ff0000", "evader": "#0000ff"}
    found = {
        (each.layer, each.owner): each.colour("light", colours)
        for each in overlays_of(run)
    }
    assert found["CoM trace", "evader"] == "#0000ff"
    assert found["footsteps", "pursuer"] == "#ff0000"
    assert found["pushes", "pursuer"] not in colours.values()
    assert found["line of sight", "pursuer-evader"] not in colours.values()


def test_footsteps_of_a_run_are_where_the_soles_landed() -> None:
    """Without feedback, the odometry of a pursuer that turns drifts."""
    run = run_game(
        duel(
            start=StartSettings(1.2, 1.4, 0.0),
            body=BODIES["hardware"],
            control=ControlSettings(feedback=False),
            duration=12.0,
        )
    )
    found, planned = footsteps_in(run, "pursuer"), run.pursuer.landings
    assert planned is not None
    np.testing.assert_array_equal(found[:, :2], planned[: len(found), :2])
    assert len(found) in (len(planned), len(planned) - 1)
    assert found[-1, 0] <= run.times[-1]
    scene, stood = RunScene(run), []
    inside = found[found[:, 0] < run.times[-1] - 0.2]
    for time, side, *_ in inside.tolist():  # in the middle of the next step
        scene.put(run.index_at(time + 0.15))
        site = f"pursuer/{'l' if side > 0.0 else 'r'}_sole_center"
        stood.append(scene.data.site(site).xpos[:2].copy())
    away = np.linalg.norm(inside[:, 2:4] - stood, axis=1)
    assert away.max() < 5e-3
    # Those of the plan, in odometry, are elsewhere.
    wrong = planned[: len(inside), 2:4] - stood
    assert np.linalg.norm(wrong, axis=1).max() > 0.03
