"""Test the measures of the claims on the bounded CoM."""

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


def shifted_by(off: float) -> Any:
    """Return the plan with CoM and DCM shifted over the same ZMP."""

    def sample(times: Any) -> PlanSamples:
        found = PLAN.sample(times)
        return found._replace(dcm=found.dcm + off, com=found.com + off)

    return SimpleNamespace(schedule=PLAN.schedule, sample=sample)


def test_plan_has_no_errors() -> None:
    assert 0.0 <= quadrature_error(PLAN) < 1e-6
    assert 0.0 <= pendulum_error(PLAN) < 1e-4


@pytest.mark.parametrize("off", [3e-3, -3e-3])
def test_errors_have_their_size(off: float) -> None:
    """For a constant error of (15) and (16) to either side."""
    found = shifted_by(off)
    assert quadrature_error(found) == pytest.approx(3e-3, abs=1e-6)
    pulled = GAIT.eta**2 * 3e-3
    assert pendulum_error(found) == pytest.approx(pulled, abs=1e-4)
