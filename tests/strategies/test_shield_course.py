"""Test the heading that a shield reckons with."""

from math import asin, cos, pi, sin, sqrt

import numpy as np
import pytest

from stepaside.core.poses import wrap_angle
from stepaside.strategies.observed_course import (
    ChordModel,
    Course,
    observed_course,
    tried_headings,
)
from stepaside.strategies.opponent_track import SeenOpponent

ERROR, SPEED, RADIUS, STEP = 0.003, 0.35, 8.0, 0.32
MODEL = ChordModel(ERROR, SPEED, RADIUS, STEP)
TURN = SPEED / RADIUS


def seen_on(
    seed: int, *, bends: bool
) -> list[tuple[SeenOpponent, tuple[float, float]]]:
    """Return sightings of a person, each with heading and pace then.

    The person changes its pace, stops, and turns: within the radius at any
    pace, or, unless it only ``bends``, at any pace at the greatest rate.
    """
    random, parts = np.random.default_rng(seed), 20
    x = y = time = 0.0
    theta, pace, side = float(random.uniform(-pi, pi)), 1.0, 1.0
    found = []
    for i in range(400 * parts):
        if i % parts == 0:
            off = ERROR * np.exp(1j * random.uniform(-pi, pi))
            row = SeenOpponent(time, x + off.real, y + off.imag)
            found.append((row, (theta, pace)))
        if random.random() < 0.01:
            pace = float(random.choice([0.0, 0.1, 0.4, 1.0, 1.0]))
            side = float(random.choice([-1.0, 0.0, 1.0]))
        tick = STEP / parts
        theta += side * (pace if bends else 1.0) * TURN * tick
        x += SPEED * pace * cos(theta) * tick
        y += SPEED * pace * sin(theta) * tick
        time += tick
    return found


@pytest.mark.parametrize("seed", range(10))
def test_heading_is_within_its_bound_of_who_keeps_to_the_radius(
    seed: int,
) -> None:
    """At any pace, after any pause; and it turns no faster than the person."""
    rows: tuple[SeenOpponent, ...] = ()
    course: Course | None = None
    known = 0
    for row, (theta, _) in seen_on(seed, bends=True):
        rows, before = MODEL.note(rows, row), course
        course = observed_course(course, rows, MODEL)
        assert abs(wrap_angle(course.heading - theta)) <= course.error + 1e-9
        if before is not None and before.error <= MODEL.bound:
            known += 1
            assert course.error == MODEL.bound
            turned = abs(wrap_angle(course.heading - before.heading))
            assert turned <= TURN * (course.time - before.time) + 1e-9
    assert known > 300
    assert len(rows) < 40


@pytest.mark.parametrize("seed", range(10))
def test_heading_is_within_its_spread_of_who_turns_on_the_spot(
    seed: int,
) -> None:
    rows: tuple[SeenOpponent, ...] = ()
    course: Course | None = None
    beyond = 0
    for row, (theta, _) in seen_on(seed, bends=False):
        rows = MODEL.note(rows, row)
        course = observed_course(course, rows, MODEL)
        off = abs(wrap_angle(course.heading - theta))
        assert off <= course.spread + 1e-9
        beyond += off > course.error
    assert beyond > 0  # who turns on the spot is not within the first bound


def test_bound_is_that_of_the_best_chord() -> None:
    """No method is better than 2 sqrt(e / R); sightings cost a little more."""
    least = 2.0 * sqrt(ERROR / RADIUS)
    assert MODEL.best == pytest.approx(2.0 * sqrt(ERROR * RADIUS))
    assert least < MODEL.bound < 1.2 * least
    exact = MODEL._replace(error=0.0)
    assert exact.bound == pytest.approx(
        asin(0.5 * SPEED * STEP / RADIUS), rel=0.05
    )


def test_heading_is_unknown_at_first_and_after_a_long_absence() -> None:
    row = SeenOpponent(1.0, 0.0, 0.0)
    course = observed_course(None, [row], MODEL)
    assert course.error == course.spread == pi
    before = Course(1.0, 0.4, 0.1, 0.1)
    gone = observed_course(before, [SeenOpponent(5.0, 0.0, 0.0)], MODEL)
    assert gone.heading == 0.4
    assert gone.error == pytest.approx(0.1 + 4.0 * TURN)


def test_all_headings_within_an_error_are_tried() -> None:
    course = Course(0.0, 0.3)
    assert tried_headings(course, 0.1, 0.1) == [0.3]
    tried = tried_headings(course, 0.6, 0.1)
    assert min(tried) == pytest.approx(-0.3)
    assert max(tried) == pytest.approx(0.9)
    assert np.diff(tried).max() <= 0.25
