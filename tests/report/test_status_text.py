"""Test the status text of a pursuer that approaches, passes or leaves."""

from dataclasses import replace
from math import cos, hypot, inf, nan, sin

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from stepaside.games.approach_forecast import LEAST, estimate_approach
from stepaside.games.run import DuelRun
from stepaside.games.run_captions import describe_state
from stepaside.games.trajectory import Trajectory
from stepaside.locomotion.walk_snapshots import Phase
from stepaside.report.viewer.status_text import outlook, status_text
from stepaside.strategies.approach import Approach
from synthetic_run import run_of

SPEED = st.floats(-2.0, 2.0)
PLACE = st.floats(-20.0, 20.0)


def seen(offset: tuple[float, float], velocity: tuple[float, float]) -> str:
    """Status text of a pursuer while the evader stands."""
    return outlook(
        hypot(*offset),
        Phase.STANDING,
        safety=0.8,
        approach=Approach(*offset, *velocity),
        theory=(0.9, 90.0),
        settling=10.0,
    )


@given(PLACE, PLACE, SPEED, SPEED)
def test_an_approach_agrees_with_where_it_leads(
    x: float, y: float, vx: float, vy: float
) -> None:
    """Closest approach and time against a fine walk along the course."""
    approach = Approach(x, y, vx, vy)
    times = np.linspace(0.0, 60.0, 6001)
    away = np.hypot(x + vx * times, y + vy * times)
    assert approach.miss <= away.min() + 1e-9
    reached = approach.contact_time(0.8)
    if reached == inf:
        slow = approach.speed < 0.05 or approach.closing_speed <= 0.0
        assert slow or away.min() > 0.8 - 1e-6
    elif reached < 60.0:
        at = hypot(x + vx * reached, y + vy * reached)
        assert at == pytest.approx(min(0.8, hypot(x, y)), abs=1e-6)
        assert (away[times < reached - 1e-9] > 0.8 - 1e-6).all()
    if hypot(x, y) > 0.1:
        step = 1e-6
        ahead = hypot(x + vx * step, y + vy * step)
        falls = (hypot(x, y) - ahead) / step
        assert approach.closing_speed == pytest.approx(falls, abs=1e-4)


@given(PLACE, PLACE, SPEED, SPEED, st.floats(0.1, 2.0))
def test_an_approach_is_found_again_from_two_offsets(
    x: float, y: float, vx: float, vy: float, elapsed: float
) -> None:
    """Its speed is that of the distance, on any course, also round about."""
    before = x - vx * elapsed, y - vy * elapsed
    if hypot(x, y) < 0.1:
        return
    found = estimate_approach(before, (x, y), elapsed)
    assert found is not None
    falls = (hypot(*before) - hypot(x, y)) / elapsed
    assert found.closing_speed == pytest.approx(falls, abs=1e-9)
    turned = estimate_approach((x, y), (-y, x), elapsed)
    assert turned is not None and abs(turned.closing_speed) < 1e-9 < LEAST


def test_a_time_is_said_of_who_comes_within_the_radius_alone() -> None:
    assert "in about 10 s" in seen((1.53, 0.0), (-0.073, 0.0))
    for offset, velocity in (
        ((12.0, 0.0), (0.8, 0.0)),  # leaves
        ((5.0, 1.5), (-0.8, 0.0)),  # passes 1.5 m beside
        ((3.0, 0.0), (0.0, 0.0)),  # stands
        ((3.0, 0.0), (-1e-3, 0.0)),  # an hour away
    ):
        said = seen(offset, velocity)
        assert "in about" not in said
        assert "0.80 m" in said
    assert "passes at 1.50 m" in seen((5.0, 1.5), (-0.8, 0.0))


def test_nothing_is_said_of_a_time_that_cannot_be_told() -> None:
    for approach in (None, estimate_approach((nan, 0.0), (1.0, 0.0), 1.0)):
        said = outlook(
            2.0,
            Phase.STANDING,
            safety=0.8,
            approach=approach,
            theory=None,
            settling=None,
        )
        assert "about" not in said and "0.80 m" in said
    assert estimate_approach((1.0, 0.0), (1.0, 0.0), 0.0) is None


@pytest.mark.parametrize(
    ("velocity", "said"),
    [
        ((-0.1, 0.0), "the pursuer approaches"),
        ((0.1, 0.0), "the pursuer moves away"),
        ((0.0, 0.1), "the pursuer walks"),
        (None, "the pursuer walks"),
    ],
)
def test_a_pursuer_comes_only_while_the_distance_falls(
    velocity: tuple[float, float] | None, said: str
) -> None:
    approach = None if velocity is None else Approach(3.0, 0.0, *velocity)
    phases = (Phase.WALKING, Phase.STANDING)
    words = status_text(phases, 3.0, 90.0, 0.8, None, approach=approach)
    assert said in words and "standing" in words
    assert words.count("pursuer") == 1
    near = status_text(phases, 0.3, 90.0, inf, None, approach=approach)
    assert "triggered" not in near


def walked(velocity: float, bearing: float) -> DuelRun:
    """A pursuer that walks straight from 3 m while the evader stands."""
    times = np.linspace(0.0, 6.0, 301)
    way = 3.0 - velocity * times
    pursuer = np.column_stack(
        [way * cos(bearing), way * sin(bearing), np.zeros(301)]
    )
    evader = np.zeros((301, 3))
    tracks = {
        "pursuer": Trajectory(com=pursuer.copy(), torso=pursuer),
        "evader": Trajectory(com=evader.copy(), torso=evader),
    }
    return run_of(times, tracks)


@pytest.mark.parametrize("bearing", [0.0, 2.0, -1.0])
def test_a_replay_says_so_too(bearing: float) -> None:
    for velocity, said in (
        (0.2, "approaches"),
        (-0.2, "moves away"),
        (0.0, "walks"),
    ):
        run = walked(velocity, bearing)
        for index in (0, 1, 200, 300):
            words = describe_state(run, index)
            assert words == f"the pursuer {said}; the evader stands"
    triggered = replace(run.summary, triggered_at_s=1.0)
    later = replace(run, summary=triggered)
    assert "evading" in describe_state(later, 290)
