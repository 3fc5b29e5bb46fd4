"""One maneuver: footsteps, ZMP and CoM."""

from math import cos, radians, sin, sqrt
from pathlib import Path

import numpy as np
import pytest

import stepaside as sa
from flows.calls import stepaside
from flows.circles import GAIN, SPEED, STRIDE

BEARING = 40.0  # [deg]
HALF = 0.05  # [m], from the path to each foot
RATE = sqrt(9.81 / 0.268)  # [1/s], of the pendulum
COUNT = 16


def expected(count: int) -> list[tuple[float, float, float]]:
    """Footsteps of an evader by eqs. (8)-(14), left foot first.

    The heading follows θ* = k θ* t for 1/k, then it stays. Frame: right
    foot, from which the path is HALF to the left.
    """
    turn = GAIN * radians(BEARING)  # [rad/s]
    found = []
    for n in range(1, count + 1):
        time = n * STRIDE / SPEED
        bent = min(time, 1 / GAIN)
        theta = turn * bent
        straight = SPEED * (time - bent)
        x = -SPEED * sin(theta) / turn - straight * cos(theta)
        y = -SPEED * (1 - cos(theta)) / turn - straight * sin(theta)
        side = 1 if n % 2 else -1
        found.append(
            (
                x - side * HALF * sin(theta),
                HALF + y + side * HALF * cos(theta),
                theta,
            )
        )
    return found


def test_a_plan_follows_the_paper(tmp_path: Path) -> None:
    figure = tmp_path / "plan.png"
    plan = stepaside(
        *("theory", "plan", "--role", "evader", "--bearing", f"{BEARING}deg"),
        *("--steps", COUNT, "--first-foot", "left", "--json"),
        *("--figure", figure),
    ).json
    assert figure.read_bytes().startswith(b"\x89PNG")
    steps = plan["footsteps"]
    assert [step["foot"] for step in steps] == ["left", "right"] * (COUNT // 2)
    np.testing.assert_allclose(
        [(step["x"], step["y"], step["theta"]) for step in steps],
        expected(COUNT),
        atol=1e-6,
    )
    # Each single support begins one step after the last.
    begins = np.array(plan["phase_starts_s"])
    np.testing.assert_allclose(
        begins[1::2], 0.8 + 0.547 * np.arange(len(begins) // 2)
    )
    times, zmp, com, dcm = (
        np.array(plan[name]) for name in ("times_s", "zmp", "com", "dcm")
    )
    # In single support the ZMP is 2 cm ahead of the ankle that bears.
    feet = [(0.0, 0.0, 0.0), *expected(COUNT)]
    for n in range(COUNT):
        x, y, theta = feet[n]
        ahead = (x + 0.02 * cos(theta), y + 0.02 * sin(theta))
        middle = 0.8 + 0.547 * n + 0.2
        np.testing.assert_allclose(
            zmp[np.argmin(abs(times - middle))], ahead, atol=1e-6
        )
    # The pendulum: x'' = RATE^2 (x - p), DCM = x + x'/RATE, both bounded.
    step = times[1] - times[0]
    force = (com[2:] - 2 * com[1:-1] + com[:-2]) / step**2
    near = RATE**2 * (com - zmp)[1:-1]
    smooth = abs(np.diff(zmp, 2, axis=0)).max(axis=1) < 1e-3
    np.testing.assert_allclose(force[smooth], near[smooth], atol=0.02)
    speed = (com[2:] - com[:-2]) / (2 * step)
    np.testing.assert_allclose(dcm[1:-1], com[1:-1] + speed / RATE, atol=1e-3)
    assert abs(com - zmp).max() < 0.1


def test_a_plan_from_python_is_the_plan_of_the_command(tmp_path: Path) -> None:
    plan = sa.ManeuverPlanner(sa.GaitSettings()).plan(
        radians(BEARING),
        sa.Direction.BACKWARD,
        first_foot=sa.Foot.LEFT,
        standing=True,
    )
    ours = expected(len(plan.footsteps))
    for step, (x, y, theta) in zip(plan.footsteps, ours, strict=True):
        assert (step.x, step.y, step.theta) == pytest.approx((x, y, theta))
    single = plan.sample([0.9, 1.0])
    np.testing.assert_allclose(single.zmp, [[0.02, 0.0]] * 2, atol=1e-9)
    sa.draw_plan(plan, "evader", tmp_path / "plan.pdf")
    assert (tmp_path / "plan.pdf").read_bytes().startswith(b"%PDF")
