"""Test the heading that a shield reckons with."""

from math import cos, pi, sin

import numpy as np
import pytest

from stepaside.core.poses import wrap_angle
from stepaside.strategies.opponent_track import SeenOpponent
from stepaside.strategies.shield import Course, observed_course

Trace = tuple[tuple[float, float, float], ...]

WINDOW, TURN, SPEED = 0.5, 0.2, 1.0  # [s], [rad/s] and [m/s]
KNOWN = TURN * WINDOW


def observe(before: Course | None, trace: Trace) -> Course | None:
    """Return the heading after the last of exact sightings."""
    seen = [SeenOpponent(*row) for row in trace]
    return observed_course(before, seen, WINDOW, (TURN, 0.0), KNOWN)


def test_heading_is_unknown_until_a_window_has_passed() -> None:
    assert observe(None, ((0.0, 0.0, 0.0), (0.4, 0.4, 0.0))) is None
    course = observe(None, ((0.0, 0.0, 0.0), (0.5, 0.0, 0.5)))
    assert course is not None
    assert course.heading == pytest.approx(0.5 * pi)
    assert course.error == pytest.approx(KNOWN)


@pytest.mark.parametrize("seed", range(20))
def test_observed_heading_turns_as_a_person_and_stays_near_it(
    seed: int,
) -> None:
    """The lemma of docs/shield.md, for people who change pace and turn."""
    random, parts = np.random.default_rng(seed), 50
    x = y = theta = time = 0.0
    course: Course | None = None
    trace: Trace = ((0.0, 0.0, 0.0),)
    for _ in range(60):
        pace, rate = random.choice([0.05, 0.3, 1.0]), random.choice([-1, 0, 1])
        for _ in range(parts):
            tick = WINDOW / parts
            theta += TURN * rate * tick
            x += SPEED * pace * cos(theta) * tick
            y += SPEED * pace * sin(theta) * tick
            if random.random() < 0.02:
                pace, rate = random.random(), random.choice([-1, 1])
        time += WINDOW
        trace = (*trace[-3:], (time, x, y))
        before, course = course, observe(course, trace)
        assert course is not None and course.error == pytest.approx(KNOWN)
        assert abs(wrap_angle(course.heading - theta)) <= KNOWN + 1e-9
        if before is not None:
            moved = abs(wrap_angle(course.heading - before.heading))
            assert moved <= TURN * WINDOW + 1e-9


def test_heading_is_known_after_a_time_without_sightings() -> None:
    """A robot that halts sees nothing: the person may have turned."""
    before = Course(1.0, 0.4, 0.1)
    course = observed_course(
        before, [SeenOpponent(3.0, 0.0, 0.0)], 0.3, (0.2, 0.0), 0.05
    )
    assert course is not None and course.heading == 0.4
    assert course.error == pytest.approx(0.1 + 0.2 * 2.0)
    long = observed_course(
        before, [SeenOpponent(99.0, 0.0, 0.0)], 0.3, (0.2, 0.0), 0.05
    )
    assert long is not None and long.error == pi
