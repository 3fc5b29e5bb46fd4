"""Intrinsically stable MPC: agreement, boundedness, infeasibility."""

from dataclasses import replace
from math import exp

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.optimize import linprog

from stepaside.control.mpc import (
    IntrinsicallyStableMpc,
    MpcResult,
    support_boxes,
)
from stepaside.control.settings import STABILISED, ControlSettings, MpcSettings
from stepaside.errors import ConfigurationError
from stepaside.planning import (
    CenterState,
    Direction,
    Foot,
    GaitSettings,
    ManeuverPlan,
    ManeuverPlanner,
)
from stepaside.poses import Array
from stepaside.simulation.push import Push
from stepaside.simulation.walk import WalkSettings, run_walk
from stepaside.simulation.walk_summary import summarise_walk

GAIT = GaitSettings()
EDGE = 0.002
ZERO = np.zeros(2)


def plan(bearing: float, foot: Foot = Foot.LEFT) -> ManeuverPlan:
    """Plan that walks on from where a nominal gait would be."""
    state = CenterState((0.01, 0.025 * foot.value), (0.07, -0.04 * foot.value))
    return ManeuverPlanner(GAIT).plan(
        bearing, Direction.FORWARD, first_foot=foot, state=state
    )


def solver(**changes: object) -> IntrinsicallyStableMpc:
    changed = replace(MpcSettings(), **changes)  # type: ignore[arg-type]
    return IntrinsicallyStableMpc(GAIT, changed, edge=EDGE)


def feasible_by_lp(
    mpc: IntrinsicallyStableMpc, p: ManeuverPlan, time: float, dcm: Array
) -> bool:
    """Whether a bounded ZMP in the feet exists, asked of another solver."""
    n = mpc.settings.steps * mpc.settings.samples
    delta, eta = mpc.interval, GAIT.eta
    times: Array = np.linspace(time + delta, time + n * delta, n)
    centre, theta, low, high = support_boxes(p, times, EDGE)
    planned = p.sample(times).zmp
    rows, upper = [], []
    for i in range(n):
        c, s = np.cos(theta[i]), np.sin(theta[i])
        for axis, k in (((c, s), 0), ((-s, c), 1)):
            row = np.zeros(2 * n)
            row[: i + 1] = delta * axis[0]
            row[n : n + i + 1] = delta * axis[1]
            off = float(np.dot(axis, planned[i] - centre[i]))
            rows += [row, -row]
            upper += [high[i, k] - off, off - low[i, k]]
    kappa = np.exp(-eta * delta * np.arange(n)) * (
        (1.0 - exp(-eta * delta)) / eta
    )
    zero = np.zeros(n)
    answer = linprog(
        np.zeros(2 * n),
        A_ub=np.array(rows),
        b_ub=np.array(upper),
        A_eq=np.array([[*kappa, *zero], [*zero, *kappa]]),
        b_eq=dcm,
        bounds=(None, None),
    )
    return bool(answer.status == 0)


@pytest.mark.parametrize("bearing", [0.0, 0.7, -0.7])
def test_on_the_plan_mpc_and_closed_form_are_one(bearing: float) -> None:
    """No constraint acts and the tail is the plan's: nothing to add."""
    mpc = solver()
    p = plan(bearing)
    for time in np.linspace(0.0, p.schedule.first_step_duration, 15):
        result = mpc.solve(p, float(time), ZERO, ZERO)
        assert result.feasible
        np.testing.assert_allclose(result.velocity, 0.0, atol=1e-9)


def test_other_tails_agree_up_to_what_they_assume() -> None:
    """Two steps ahead a wrong tail still counts by exp(-eta T)."""
    p = plan(0.0)
    off = {}
    for tail in ("truncated", "periodic"):
        for steps in (2, 3):
            mpc = solver(tail=tail, steps=steps)
            v = mpc.solve(p, 0.1, ZERO, ZERO).velocity
            off[tail, steps] = float(np.hypot(*v))
    for tail in ("truncated", "periodic"):
        assert 0.0 < off[tail, 3] < 0.15 * off[tail, 2]


@settings(deadline=None, max_examples=40)
@given(
    st.floats(-0.08, 0.08),
    st.floats(-0.08, 0.08),
    st.floats(0.0, 0.5),
    st.floats(-1.0, 1.0),
)
def test_infeasible_exactly_when_another_solver_says_so(
    x: float, y: float, time: float, bearing: float
) -> None:
    mpc, p, dcm = solver(), plan(bearing), np.array([x, y])
    result = mpc.solve(p, time, dcm, ZERO)
    less = feasible_by_lp(mpc, p, time, 0.999 * dcm)
    more = feasible_by_lp(mpc, p, time, 1.001 * dcm)
    if less == more:  # not within a thousandth of the border
        assert result.feasible == less
    if not result.feasible:
        held = dcm - np.array(result.excess)
        assert feasible_by_lp(mpc, p, time, 0.998 * held)


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


def test_a_warm_start_changes_nothing() -> None:
    warm, p = solver(), plan(0.4)
    generator = np.random.default_rng(3)
    for dcm in generator.normal(0.0, 0.02, (60, 2)):
        hot = warm.solve(p, 0.15, dcm, ZERO)
        cold = solver().solve(p, 0.15, dcm, ZERO)
        assert hot.feasible == cold.feasible
        np.testing.assert_allclose(hot.velocity, cold.velocity, atol=1e-5)


@pytest.mark.parametrize("tail", ["anticipative", "periodic", "truncated"])
def test_the_closed_loop_stays_bounded(tail: str) -> None:
    """The pendulum under the MPC's ZMP comes back to its plan."""
    mpc, p = solver(tail=tail), plan(0.0)
    tick, eta = 0.004, GAIT.eta
    dcm, zmp = np.array([0.02, -0.01]), np.zeros(2)
    largest = 0.0
    for k in range(round(p.schedule.first_step_duration / tick)):
        result: MpcResult = mpc.solve(p, k * tick, dcm, zmp)
        assert result.feasible
        zmp = zmp + tick * np.array(result.velocity)
        dcm = zmp + exp(eta * tick) * (dcm - zmp)
        largest = max(largest, float(np.abs(dcm).max()))
    assert largest < 0.03  # open loop: 0.02 exp(eta T) = 0.55 m
    if tail == "anticipative":
        assert np.abs(dcm).max() < 0.25 * 0.02


def test_the_zmp_stays_in_the_sole() -> None:
    """Constraints hold at the samples, 55 ms apart; between them nearly."""
    mpc, p = solver(), plan(0.3)
    tick, eta = 0.004, GAIT.eta
    dcm, zmp = np.array([0.0, 0.03]), np.zeros(2)
    for k in range(100):
        result = mpc.solve(p, k * tick, dcm, zmp)
        zmp = zmp + tick * np.array(result.velocity)
        dcm = zmp + exp(eta * tick) * (dcm - zmp)
        now = np.array([(k + 1) * tick])
        centre, theta, low, high = support_boxes(p, now, EDGE)
        off = p.sample(now).zmp[0] + zmp - centre[0]
        c, s = np.cos(theta[0]), np.sin(theta[0])
        turned = np.array([c * off[0] + s * off[1], c * off[1] - s * off[0]])
        assert (turned >= low[0] - 2e-3).all()
        assert (turned <= high[0] + 2e-3).all()


def test_walks_with_mpc_and_reports_the_solver() -> None:
    control = replace(STABILISED, method="mpc")
    result = run_walk(
        WalkSettings(
            duration=9.0,
            control=control,
            pushes=(Push(1.0, 5.0, 1.57),),
        )
    )
    summary = summarise_walk(result)
    assert summary["outcome"] == "completed"
    qp = summary["qp"]
    assert qp["solves"] > 100 and 0 <= qp["infeasible"] <= qp["solves"]
    assert qp["median_us"] > 0.0


def test_nonsense_is_refused() -> None:
    with pytest.raises(ConfigurationError, match="mpc.tail"):
        MpcSettings(tail="none")  # type: ignore[arg-type]
    with pytest.raises(ConfigurationError, match="mpc.steps"):
        MpcSettings(steps=0)
    with pytest.raises(ConfigurationError, match="needs feedback"):
        ControlSettings("mpc")
