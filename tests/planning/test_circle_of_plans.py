"""Test that two plans, walked to perfection, end on the template's circle.

No physics: a robot is where its reference asks it to be. What is left are
the plans, the bearings they are made from, and when.
"""

from math import atan2, cos, degrees, hypot, pi, sin
from typing import Any

import numpy as np
import pytest

from fake_robot import FakeLegs, scheme_of
from sampled_unicycles import play_sampled
from stepaside.core.poses import Array, Pose, wrap_angle
from stepaside.perception.measurement import RobotState, Sighting
from stepaside.planning import Foot, GaitSettings
from stepaside.strategies import Evasion, Pursuit
from stepaside.theory.unicycle import RelativeStart, Unicycles
from stepaside.theory.unicycle.circles import Circle, find_circle, fit_circle

TICK = 0.02
GAIT = GaitSettings()
NOTHING = np.zeros(3)


class Ghost:
    """A robot without a body."""

    def __init__(
        self, strategy: Any, gait: GaitSettings, frame: Pose, foot: Foot
    ) -> None:
        legs: Any = FakeLegs()
        self.legs, self.frame, self.lead = legs, frame, gait.zmp_forward
        self.scheme = scheme_of(
            strategy, gait, legs, tick=TICK, first_foot=foot
        )

    def pose(self) -> Pose:
        """Place, and heading of the torso: midway between the feet's."""
        body = self.scheme.walk.reference
        apart = wrap_angle(body.left_foot[3] - body.right_foot[3])
        heading = body.right_foot[3] + 0.5 * apart
        self.legs.torso_heading = heading
        x, y, _ = body.com
        x, y = x - self.lead * cos(heading), y - self.lead * sin(heading)
        return self.frame.compose(Pose(x, y, heading))

    def tick(self, now: float, time: float, own: Pose, other: Pose) -> None:
        """Control, by a sighting of a time that has passed."""
        x, y = other.x - own.x, other.y - own.y
        bearing = wrap_angle(atan2(y, x) - own.theta)
        seen = Sighting(time, bearing, hypot(x, y))
        self.scheme.update(
            RobotState(now, NOTHING, NOTHING, NOTHING, np.zeros(8), seen)
        )


def play(
    gait: GaitSettings,
    *,
    duration: float = 160.0,
    late: float = 0.0,
    foot: Foot = Foot.LEFT,
) -> tuple[Array, Circle]:
    """Poses of both over the last whole gait cycles, from on the circle."""
    circle = find_circle(gait.speed, gait.speed, gait.gain, gait.gain)
    apart = Pose(circle.distance_m, 0.0, 0.75 * pi)
    ghosts = (
        Ghost(Pursuit(), gait, Pose(0.0, 0.0, -0.25 * pi), Foot.LEFT),
        Ghost(Evasion(safety_radius=3.0), gait, apart, foot),
    )
    been: list[tuple[Pose, Pose]] = []
    for tick in range(round(duration / TICK)):
        been.append((ghosts[0].pose(), ghosts[1].pose()))
        then = max(0, tick - round(late / TICK))
        pursuer, evader = been[then]
        ghosts[0].tick(tick * TICK, then * TICK, pursuer, evader)
        ghosts[1].tick(tick * TICK, then * TICK, evader, pursuer)
    cycle = 2.0 * gait.step_duration
    last = round(round(0.25 * duration / cycle) * cycle / TICK)
    rows = [[*pursuer, *evader] for pursuer, evader in been[-last:]]
    return np.array(rows), circle


def off(gait: GaitSettings = GAIT, **changes: Any) -> list[float]:
    """Radii and distance by theory's, less 1, and what the angle misses."""
    rows, circle = play(gait, **changes)
    pursuer, evader = rows[:, :3], rows[:, 3:]
    radii = [fit_circle(track[:, :2])[1] for track in (pursuer, evader)]
    distance = float(np.hypot(*(evader - pursuer)[:, :2].T).mean())
    apart = np.abs(wrap_all(evader[:, 2] - pursuer[:, 2])).mean()
    return [
        radii[0] / circle.radius_pursuer_m - 1.0,
        radii[1] / circle.radius_evader_m - 1.0,
        distance / circle.distance_m - 1.0,
        degrees(float(apart) - circle.headings_apart_rad) / 90.0,
    ]


def wrap_all(angles: Array) -> Array:
    """Angles in [-pi, pi), in [rad]."""
    wrapped: Array = (angles + pi) % (2.0 * pi) - pi
    return wrapped


@pytest.mark.parametrize("foot", Foot)
def test_plans_end_on_the_circle_of_the_template(foot: Foot) -> None:
    np.testing.assert_allclose(off(foot=foot), 0.0, atol=1e-3)


def test_late_sightings_leave_the_circle_as_it_is() -> None:
    """Line of sight and heading are equally old."""
    np.testing.assert_allclose(off(late=0.3), 0.0, atol=1e-3)


@pytest.mark.slow
@pytest.mark.parametrize(
    "gait",
    [
        GaitSettings(single_support=0.3, double_support=0.3),
        GaitSettings(single_support=0.3, double_support=0.1, stride=0.03),
        GaitSettings(zmp_forward=0.0),
    ],
    ids=["half and half", "quick and short", "over the ankles"],
)
def test_it_is_the_same_circle_with_any_gait(gait: GaitSettings) -> None:
    np.testing.assert_allclose(off(gait), 0.0, atol=1e-3)


def test_the_sampled_template_is_in_balance_on_the_circle() -> None:
    """Held turns, decided as late as a body is behind its foot."""
    circle = find_circle(GAIT.speed, GAIT.speed, GAIT.gain, GAIT.gain)
    game = Unicycles(GAIT.speed, GAIT.speed, GAIT.gain, GAIT.gain)
    start = RelativeStart(circle.distance_m, -0.25 * pi, 0.25 * pi)
    for delay in (0.0, 0.34 * GAIT.path_interval):
        states, _, _, evader = play_sampled(
            game, start, 200.0, GAIT.path_interval, delay
        )
        radius = fit_circle(evader[-250:, :2])[1]
        assert radius == pytest.approx(circle.radius_evader_m, rel=1e-6)
        assert states[-1, 0] == pytest.approx(circle.distance_m, rel=1e-6)
