"""Test how the claims on the bounded CoM measure a plan's errors."""

from types import SimpleNamespace
from typing import Any

import pytest

from stepaside.planning import Direction, Foot, ManeuverPlanner
from stepaside.planning.plan import PlanSamples
from stepaside.studies.balance_claims import pendulum_error, quadrature_error
from stepaside.studies.planner_claims import COUNT, GAIT

PLAN = ManeuverPlanner(GAIT).plan(
    0.7,
    Direction.BACKWARD,
    first_foot=Foot.LEFT,
    standing=True,
    count=COUNT,
)


def missed_by(off: float) -> Any:
    """The plan, with another CoM and DCM above the same ZMP."""

    def sample(times: Any) -> PlanSamples:
        found = PLAN.sample(times)
        return found._replace(dcm=found.dcm + off, com=found.com + off)

    return SimpleNamespace(schedule=PLAN.schedule, sample=sample)


def test_a_plan_has_no_errors() -> None:
    assert 0.0 <= quadrature_error(PLAN) < 1e-6
    assert 0.0 <= pendulum_error(PLAN) < 1e-4


@pytest.mark.parametrize("off", [3e-3, -3e-3])
def test_errors_are_told_in_their_size(off: float) -> None:
    """Eqs. (15) and (16), missed by as much to either side."""
    found = missed_by(off)
    assert quadrature_error(found) == pytest.approx(3e-3, abs=1e-6)
    pulled = GAIT.eta**2 * 3e-3
    assert pendulum_error(found) == pytest.approx(pulled, abs=1e-4)
