"""Test the response of legs to commands, and its inverse."""

import numpy as np
import pytest

from stepaside.core.errors import PolicyError
from stepaside.locomotion.policy.contract import CommandRanges
from stepaside.locomotion.policy.velocity_response import (
    AxisResponse,
    VelocityResponse,
)
from stepaside.strategies.velocity_set import BodyVelocity
from stored_values import compare_stored, summed

V = BodyVelocity
MEASURED = VelocityResponse(
    *(
        AxisResponse(
            (-1.0, -0.5, 0.0, 0.5, 1.0),
            (
                V(-0.67, 0.01, -0.02),
                V(-0.37, 0.0, -0.01),
                V(),
                V(0.41, 0.0, 0.01),
                V(0.72, 0.01, 0.02),
            ),
        ),
        AxisResponse(
            (-1.0, 0.0, 1.0),  # of legs that creep when they are to stand
            (V(-0.02, -0.4, 0.03), V(0.01, 0, 0.01), V(-0.02, 0.4, -0.01)),
        ),
        AxisResponse(
            (-1.0, 0.0, 1.0), (V(-0.01, 0.02, -0.9), V(), V(-0.01, 0, 0.9))
        ),
    )
)


def command_for(response: VelocityResponse, velocity: V) -> V:
    command = np.zeros(3)
    response.inverse(np.array(velocity), command)()
    return V(*command.tolist())


@pytest.mark.parametrize("forward", [-0.5, -0.1, 0.0, 0.3, 0.6])
@pytest.mark.parametrize("lateral", [-0.2, 0.0, 0.2])
@pytest.mark.parametrize("turn", [-0.6, 0.0, 0.3])
def test_a_deliverable_velocity_is_delivered(
    forward: float, lateral: float, turn: float
) -> None:
    wanted = V(forward, lateral, turn)
    command = command_for(MEASURED, wanted)
    np.testing.assert_allclose(
        MEASURED.deliver(command), wanted, rtol=0.0, atol=1e-9
    )


def test_the_nearest_velocity_keeps_the_path() -> None:
    given = V(1.44, 0.0, 0.3)
    found = MEASURED.velocities.nearest(given)
    assert found.forward == pytest.approx(0.72)
    np.testing.assert_allclose(found, np.array(given) / 2.0)
    assert MEASURED.velocities.nearest(V(0.5, 0.1, 0.3)) == V(0.5, 0.1, 0.3)


def test_ideal_legs_deliver_commands() -> None:
    legs = VelocityResponse.ideal(CommandRanges(forward=(-0.5, 2.0)))
    velocity = V(1.2, -0.3, 0.4)
    assert command_for(legs, velocity) == pytest.approx(velocity)
    assert legs.velocities.forward == (-0.5, 2.0)


def test_an_axis_that_does_not_follow_is_refused() -> None:
    flat = AxisResponse((-1.0, 0.0, 1.0), (V(), V(), V(0.5, 0.0, 0.0)))
    with pytest.raises(PolicyError, match="forward.delivered must ascend"):
        VelocityResponse(flat, MEASURED.lateral, MEASURED.turn)


def test_commands_for_random_velocities_are_as_stored() -> None:
    """Also for those that the legs cannot deliver."""
    wanted = np.random.default_rng(9).uniform(-1.5, 1.5, (300, 3))
    found = [command_for(MEASURED, V(*row)) for row in wanted.tolist()]
    nearest = [MEASURED.velocities.nearest(V(*row)) for row in wanted.tolist()]
    compare_stored("numbers.json", "response", summed([found, nearest]), 1e-5)
