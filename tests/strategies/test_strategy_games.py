"""Test matches of unicycles with any two strategies."""

from dataclasses import replace
from math import pi, sin

import numpy as np
import pytest

from floor_duels import STEP, play_steps
from sampled_unicycles import play_sampled
from stepaside.core.poses import wrap_angle
from stepaside.games import Outcome, duel, run_game
from stepaside.games.game_settings import StartSettings
from stepaside.strategies import Evasion, Pursuit, StandStill, Strategy
from stepaside.studies.tournament import StrategyTrack
from stepaside.theory.unicycle import RelativeStart, Unicycles

FIG_2 = Unicycles(1.0, 1.0, 0.5, 0.5)
START = RelativeStart(2.5, 0.3, -0.2)
ALWAYS = Evasion(safety_radius=1e9, side_hysteresis=0.0)


# As in FIG_2, with a sample time of 0.2 s of path time.
GAIT = {"speed": 1.0, "gain": 0.5, "stride": 0.2}


def play(
    evader: Strategy = ALWAYS,
    start: RelativeStart = START,
    steps: int = 50,
    capture: float = 1e-6,
) -> StrategyTrack:
    """Play the paper's pursuer against an evader."""
    return play_steps(
        Pursuit(), evader, start.poses(), steps, gait=GAIT, capture=capture
    )


@pytest.mark.parametrize("angle", [0.0, 1.0, pi / 2, 2.5])
@pytest.mark.parametrize("bearing", [-0.2, 0.4, 2.9])
def test_strategies_of_the_paper_are_its_sampled_game(
    angle: float, bearing: float
) -> None:
    """Two programs that share the laws alone."""
    start = replace(START, bearing=bearing)
    run = play(replace(ALWAYS, angle=angle), start)
    game = Unicycles(1.0, 1.0, 0.5, 0.5, angle)
    _, _, pursuer, evader = play_sampled(game, start, 10.0, 0.2)
    np.testing.assert_allclose(run.pursuer, pursuer, atol=1e-9)
    np.testing.assert_allclose(run.evader, evader, atol=1e-9)
    np.testing.assert_allclose(run.times[-1], 50 * STEP, atol=1e-9)


def test_they_end_on_the_circle_of_the_theory() -> None:
    """Sec. 3: r = 4 v sin(alpha / 2) / (k alpha), headings pi/2 apart."""
    run = play(steps=600)
    expected = 4.0 * sin(pi / 4.0) / (0.5 * pi / 2.0)
    assert run.distances[-1] == pytest.approx(expected, rel=1e-3)
    apart = wrap_angle(float(run.evader[-1, 2] - run.pursuer[-1, 2]))
    assert abs(apart) == pytest.approx(pi / 2, rel=1e-3)


def test_a_saturated_evader_ends_on_a_circle_of_radius_v_over_k() -> None:
    """Sec. 4, eq. (6): r = 2 v sin(1) / k."""
    run = play(evader=replace(ALWAYS, saturated=True), steps=600)
    assert run.distances[-1] == pytest.approx(2.0 * sin(1.0) / 0.5, rel=0.01)


def test_an_evader_stands_until_the_other_is_in_its_safety_area() -> None:
    run = play(evader=Evasion(safety_radius=1.5))
    still = (run.evader == run.evader[0]).all(axis=1)
    first = int(np.argmin(still))
    assert still[:first].all() and 1.2 < run.distances[first] < 1.5
    assert run.outcome is Outcome.COMPLETED


def test_one_that_stands_is_captured_and_the_game_ends() -> None:
    run = play(evader=StandStill(), start=RelativeStart(2.5), capture=0.15)
    assert run.outcome is Outcome.CAPTURED
    assert run.closest_distance == run.distances[-1] <= 0.15
    assert len(run.times) == len(run.pursuer) == len(run.evader)
    assert 2.3 < run.times[-1] * 0.2 / STEP < 3.0
    assert play(capture=2.6).times.tolist() == [0.0]


MIRRORED = [
    ("pursuit", "evasion"),
    ("lead", "matador"),
    ("sharp", "evasion"),
    ("stop-and-wait", "wary"),
    ("herding", "look-ahead"),
    ("pursuit", "step-aside"),
]


@pytest.mark.parametrize(("pursuer", "evader"), MIRRORED)
@pytest.mark.parametrize("level", ["unicycle", "steps"])
def test_a_mirrored_game_is_the_mirror_image(
    pursuer: str, evader: str, level: str
) -> None:
    games = []
    for sign in (1.0, -1.0):
        start = StartSettings(0.9, 0.3 * sign, -0.2 * sign)
        settings = {"pursuer": pursuer, "evader": evader, "level": level}
        games.append(run_game(duel(duration=8.0, start=start, **settings)))
    for name in ("pursuer", "evader"):
        left, right = (game.tracks[name].torso for game in games)
        turned = left * (1.0, -1.0, -1.0) - right
        turned[:, 2] = np.remainder(turned[:, 2] + pi, 2.0 * pi) - pi
        np.testing.assert_allclose(turned, 0.0, atol=1e-6)
