"""Test the support polygon over time, and the ZMP of every plan in it."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from reference_plans import KINDS, plan_of, reference_corners, reference_feet
from stepaside.planning import Direction, Foot, ManeuverPlan

ANGLES = np.linspace(0.0, 6.28, 25)
AROUND = np.column_stack([np.cos(ANGLES), np.sin(ANGLES)])


def instants(plan: ManeuverPlan) -> list[float]:
    """Times inside every phase, and after the last."""
    starts = plan.schedule.starts
    inside = np.concatenate(
        [starts[:-1] + share * np.diff(starts) for share in (0.01, 0.5, 0.99)]
    )
    return [*inside.tolist(), float(starts[-1]) + 1.0]


@settings(max_examples=60, deadline=None)
@given(
    st.sampled_from(KINDS),
    st.floats(-3.1, 3.1),
    st.floats(-3.1, 3.1),
    st.integers(2, 6),
    st.sampled_from(Foot),
    st.sampled_from(Direction),
)
def test_zmp_of_every_plan_is_under_the_feet(
    kind: str,
    bearing: float,
    turn_to: float,
    horizon: int,
    foot: Foot,
    direction: Direction,
) -> None:
    plan = plan_of(
        kind,
        bearing,
        turn_to=turn_to,
        foot=foot,
        direction=direction,
        horizon=horizon,
    )
    for phase in plan.support():
        end = min(phase.end, plan.schedule.duration + 1.0)
        zmp = plan.sample(np.linspace(phase.start, end, 60)).zmp
        room = phase.offsets - zmp @ phase.normals.T
        assert room.min() > 0.02
        assert room.min() >= plan.margin() - 1e-12


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("foot", Foot)
def test_feet_on_the_floor_are_those_worked_out_by_hand(
    kind: str, foot: Foot
) -> None:
    """The farthest points of both hulls agree in every direction."""
    plan = plan_of(kind, 0.9, foot=foot)
    phases = plan.support()
    for time in instants(plan):
        [phase] = [p for p in phases if p.start < time < p.end]
        expected = reference_corners(plan, time)
        assert phase.rows == reference_feet(plan, time)
        assert phase.single == (expected.shape[0] == 4)
        farthest = (AROUND @ expected.T).max(axis=1)
        np.testing.assert_allclose(
            (AROUND @ phase.corners.T).max(axis=1), farthest, atol=1e-12
        )


@pytest.mark.parametrize("kind", KINDS)
def test_phases_leave_no_gap_and_the_last_one_stays(kind: str) -> None:
    plan = plan_of(kind)
    phases = plan.support()
    assert phases[0].start == 0.0 and phases[-1].end == np.inf
    for one, two in zip(phases, phases[1:], strict=False):
        assert one.end == two.start
        assert one.single != two.single
    assert phases[0].single == (kind != "start")
    first = plan.support(plan.schedule.first_step_duration)
    assert len(first) == (3 if kind == "start" else 2)


def test_margin_sees_the_peak_of_a_correction_between_samples() -> None:
    """The correction peaks at a third of the phase, with its amplitude."""
    plan = plan_of("walk", 0.0)
    inputs = plan.inputs.copy()
    inputs[-2] = (0.0, -0.030 if plan.first_foot is Foot.LEFT else 0.030)
    shifted = replace(plan, inputs=inputs)
    first = plan.schedule.settings.single_support
    sole = plan.schedule.settings.sole
    assert shifted.margin(first) == pytest.approx(
        sole.outer - 0.030, abs=1e-12
    )
