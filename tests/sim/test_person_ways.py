"""Test recorded walks and repeated visits."""

from math import cos, hypot, pi, sin
from pathlib import Path

import pytest

from stepaside.core.poses import Pose, wrap_angle
from stepaside.sim.person_crossings import RADIUS, RepeatedCrossings
from stepaside.sim.person_motion import PersonMotion
from stepaside.sim.person_settings import PersonSettings

GOLDEN = 0.5 * (5.0**0.5 - 1.0)


@pytest.mark.parametrize("speed", [0.01, 1.0, 10.0])
@pytest.mark.parametrize("eighth", range(8))
def test_a_recorded_person_heads_along_the_path(
    eighth: int, speed: float, tmp_path: Path
) -> None:
    """In any direction, however fast."""
    course = 0.25 * pi * eighth
    x, y = (round(4.0 * speed * f(course), 12) for f in (cos, sin))
    file = tmp_path / "walk.csv"
    file.write_text(f"time,x,y\n0,0,0\n4,{x},{y}\n", encoding="utf-8")
    motion = PersonMotion(
        PersonSettings(str(file)), Pose(0.0, 0.0, 0.0), (9.0, 9.0)
    )
    for time in (0.0, 1.0, 3.3):
        motion.advance(time, 0.02, (9.0, 9.0))
        assert wrap_angle(motion.pose.theta - course) == pytest.approx(0.0)


def test_visit_offsets_follow_the_golden_ratio() -> None:
    """Crossing k aims 1.5 m (2 frac(k / 1.618) - 1) to the left."""
    visits, evader = RepeatedCrossings(0.4), (0.7, -0.3)
    x, y, course, step = evader[0] - RADIUS, evader[1] + 0.4, 0.0, 0.02
    aims: dict[int, float] = {}
    passed: dict[int, float] = {}
    while visits.number < 8:
        course = visits.course((x, y), course, evader)
        x, y = x + step * cos(course), y + step * sin(course)
        if visits.crossing:
            aims[visits.number] = visits.miss
            u, v = x - evader[0], y - evader[1]
            if hypot(u, v) < 1.6:
                # How far to the left of the evader, seen along the course.
                aside = -u * sin(course) + v * cos(course)
                passed[visits.number] = aside
    for number in range(2, 8):
        wanted = 1.5 * (2.0 * (number * GOLDEN % 1.0) - 1.0)
        assert aims[number] == pytest.approx(wanted, abs=1e-4)
        assert passed[number] == pytest.approx(wanted, rel=0.08)
