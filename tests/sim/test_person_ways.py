"""Test recorded walks."""

from math import cos, pi, sin
from pathlib import Path

import pytest

from stepaside.core.poses import Pose, wrap_angle
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
