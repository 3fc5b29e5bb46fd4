"""Intrinsically stable MPC: agreement, boundedness, infeasibility."""

from dataclasses import replace
from math import exp

import numpy as np
import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st
from scipy.optimize import linprog

from reference_plans import KINDS, plan_of, reference_corners
from stepaside.core.poses import Array
from stepaside.locomotion.control_settings import MpcSettings
from stepaside.locomotion.zmp.mpc import IntrinsicallyStableMpc
from stepaside.planning import (
    CenterState,
    Direction,
    Foot,
    GaitSettings,
    ManeuverPlan,
    ManeuverPlanner,
)
from stored_values import compare_stored, summed

GAIT = GaitSettings()
EDGE = 0.002
ZERO = np.zeros(2)


def plan(bearing: float, foot: Foot = Foot.LEFT) -> ManeuverPlan:
    """Plan that walks on from where a nominal gait would be."""
    state = CenterState((0.01, 0.025 * foot.value), (0.07, -0.04 * foot.value))
    return ManeuverPlanner(GAIT).plan(
        bearing, Direction.FORWARD, first_foot=foot, state=state
    )


def solver(edge: float = EDGE, **changes: object) -> IntrinsicallyStableMpc:
    changed = replace(MpcSettings(), **changes)  # type: ignore[arg-type]
    return IntrinsicallyStableMpc(GAIT, changed, edge=edge)


class ReferenceQp:
    """The constraints of one tick, from the corners of the soles.

    The unknowns are the ZMP less the plan's at the end of each sample, and
    weights that make each ZMP a mean of corners of the feet on the floor.
    """

    def __init__(
        self, mpc: IntrinsicallyStableMpc, p: ManeuverPlan, time: float
    ) -> None:
        """Look at each sample, and at each change of the feet."""
        n = mpc.settings.steps * mpc.settings.samples
        delta, eta = mpc.interval, GAIT.eta
        ends = time + delta * np.arange(1, n + 1)
        changes = p.schedule.starts[1:-1]
        changes = changes[(changes > time) & (changes < ends[-1])]
        times = np.concatenate([ends, changes])
        corners = [reference_corners(p, float(t)) for t in times]
        size = 2 * n + sum(map(len, corners))
        planned = p.sample(times).zmp
        rows, right, weight = [], [], 2 * n
        for t, here, (x, y) in zip(times, corners, planned, strict=True):
            i = min(int(np.ceil((t - time) / delta - 1e-9)), n) - 1
            share = (t - time) / delta - i
            one = np.zeros(size)
            one[weight : weight + len(here)] = 1.0
            rows.append(one)
            right.append(1.0)
            for axis, where in ((0, x), (1, y)):
                row = np.zeros(size)
                row[weight : weight + len(here)] = here[:, axis]
                row[axis * n + i] -= share
                if i:
                    row[axis * n + i - 1] -= 1.0 - share
                rows.append(row)
                right.append(float(where))
            weight += len(here)
        kappa = np.exp(-eta * delta * np.arange(n)) * (
            (1.0 - exp(-eta * delta)) / (eta * delta)
        )
        # Abel: sum kappa_i (z_i - z_(i - 1)), from z = 0.
        self.reach = np.zeros((2, size))
        for axis in range(2):
            part = kappa.copy()
            part[:-1] -= kappa[1:]
            self.reach[axis, axis * n : axis * n + n] = part
        self.rows, self.right = np.array(rows), np.array(right)
        free = [(None, None)] * (2 * n)
        self.bounds = free + [(0.0, None)] * (size - 2 * n)

    def holds(self, dcm: Array) -> bool:
        """Whether a ZMP under the feet holds a DCM that is off by this."""
        answer = linprog(
            np.zeros(self.rows.shape[1]),
            A_eq=np.vstack([self.rows, self.reach]),
            b_eq=np.concatenate([self.right, dcm]),
            bounds=self.bounds,
        )
        return bool(answer.status == 0)

    def farthest(self, heading: Array) -> float:
        """How far in a direction a DCM can be off and still be held."""
        answer = linprog(
            -heading @ self.reach,
            A_eq=self.rows,
            b_eq=self.right,
            bounds=self.bounds,
        )
        return -float(answer.fun)


@pytest.mark.parametrize("bearing", [0.0, 0.7, -0.7])
def test_on_the_plan_mpc_and_closed_form_are_one(bearing: float) -> None:
    """No constraint acts and the tail is the plan's: nothing to add."""
    mpc = solver()
    p = plan(bearing)
    for time in np.linspace(0.0, p.schedule.first_step_duration, 15):
        result = mpc.solve(p, float(time), ZERO, ZERO)
        assert result.feasible
        np.testing.assert_allclose(result.velocity, 0.0, atol=1e-9)


@given(
    st.sampled_from(KINDS),
    st.floats(-0.08, 0.08),
    st.floats(-0.08, 0.08),
    st.floats(0.0, 1.0),
    st.floats(-1.0, 1.0),
)
def test_infeasible_exactly_when_no_zmp_under_the_soles_holds(
    kind: str, x: float, y: float, time: float, bearing: float
) -> None:
    """Asked of another solver, with soles that were drawn by hand."""
    mpc, p, dcm = solver(edge=0.0), plan_of(kind, bearing), np.array([x, y])
    result = mpc.solve(p, time, dcm, ZERO)
    reference = ReferenceQp(mpc, p, time)
    less, more = (reference.holds(0.999 * dcm), reference.holds(1.001 * dcm))
    if less == more:  # not within a thousandth of the border
        assert result.feasible == less


@settings(deadline=None, max_examples=30)
@given(
    st.sampled_from(KINDS),
    st.floats(-3.1, 3.1),
    st.floats(0.03, 0.3),
    st.floats(0.0, 1.0),
)
@example("start", 2.0, 0.1, 0.4)
@example("walk", -1.5, 0.05, 0.4)
def test_excess_is_the_least_there_is(
    kind: str, angle: float, size: float, time: float
) -> None:
    """No ZMP takes the DCM farther along the excess than it was taken."""
    mpc, p = solver(edge=0.0), plan_of(kind)
    dcm = size * np.array([np.cos(angle), np.sin(angle)])
    result = mpc.solve(p, time, dcm, ZERO)
    excess = np.array(result.excess)
    length = float(np.hypot(*excess))
    if result.feasible:
        assert length == 0.0
        return
    if length < 1e-4:
        return
    heading = excess / length
    least = float(heading @ dcm) - ReferenceQp(mpc, p, time).farthest(heading)
    assert length == pytest.approx(least, rel=0.0, abs=1e-6)


@settings(deadline=None, max_examples=30)
@given(st.floats(-0.05, 0.05), st.floats(-0.05, 0.05), st.floats(-0.8, 0.8))
def test_mirrored_games_have_mirrored_answers(
    x: float, y: float, bearing: float
) -> None:
    one = solver().solve(plan(bearing), 0.1, np.array([x, y]), ZERO)
    two = solver().solve(
        plan(-bearing, Foot.RIGHT), 0.1, np.array([x, -y]), ZERO
    )
    assert one.feasible == two.feasible
    if one.feasible:
        assert two.velocity[0] == pytest.approx(one.velocity[0], abs=1e-6)
        assert two.velocity[1] == pytest.approx(-one.velocity[1], abs=1e-6)


@pytest.mark.parametrize("kind", KINDS)
def test_random_errors_are_answered_as_stored(kind: str) -> None:
    """Also those that no ZMP holds, and ZMPs that lie outside the feet."""
    draw, mpc, found = np.random.default_rng(5), solver(), list[object]()
    for _ in range(60):
        time, bearing = draw.random(), draw.uniform(-1.0, 1.0)
        dcm, zmp = draw.normal(0.0, 0.03, (2, 2))
        found += mpc.solve(plan_of(kind, bearing), time, dcm, zmp)[:3]
    compare_stored("numbers.json", f"mpc, {kind}", summed(found), 1e-3)
