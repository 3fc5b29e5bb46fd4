"""Test when inverse kinematics falls back to the damped step."""

from collections.abc import Callable
from dataclasses import replace
from functools import cache

import numpy as np
import pytest

from stepaside.core.machine_code import plain_python
from stepaside.robots.description import load_robot
from stepaside.robots.ik_step import GREATEST_MOVE
from stepaside.robots.leg_joints import LegJoints
from stepaside.robots.leg_kinematics import (
    BodyReference,
    LegKinematics,
)
from stepaside.robots.tree_cache import load_tree

NAO = load_robot("nao")
STANCE = BodyReference(
    (0.02, 0.0, 0.26), (0.0, 0.05, 0.0, 0.0), (0.0, -0.05, 0.0, 0.0)
)
NEAR = STANCE._replace(com=(0.021, 0.001, 0.259))
Step = Callable[..., tuple[float, ...]]


def tracked(replaced: Callable[[Step], Step | None]) -> LegKinematics:
    """Track once with another undamped step."""
    with plain_python():
        legs = LegKinematics(NAO, tick=0.004)
    legs.stand(STANCE)
    own = legs._solver.newton_step
    assert own is not None
    legs._solver = legs._solver._replace(newton_step=replaced(own))
    before = legs.joint_targets
    assert np.abs(legs.track(NEAR) - before).max() > 1e-4
    return legs


@cache
def damped() -> LegKinematics:
    """Track once without an undamped step."""
    return tracked(lambda _: None)


def test_a_step_within_all_limits_is_not_damped() -> None:
    own = tracked(lambda step: step)
    off = np.abs(own.joint_targets - damped().joint_targets).max()
    assert 0.0 < off < 1e-3


@pytest.mark.parametrize("sign", [-1.0, 1.0])
@pytest.mark.parametrize("unknown", range(4))
def test_a_long_step_of_the_torso_is_damped(unknown: int, sign: float) -> None:
    """Along any axis, or in heading."""

    def too_far(step_function: Step) -> Step:
        def leap(*arguments: float) -> tuple[float, ...]:
            step = list(step_function(*arguments))
            step[unknown] = sign * 1.01 * GREATEST_MOVE
            return tuple(step)

        return leap

    assert tracked(too_far).stance == damped().stance


@pytest.mark.parametrize("sign", [-1.0, 1.0])
@pytest.mark.parametrize("joint", range(11))
def test_a_step_that_is_too_fast_for_a_joint_is_damped(
    joint: int, sign: float
) -> None:
    def fast(step_function: Step) -> Step:
        def move(*arguments: float) -> tuple[float, ...]:
            step = list(step_function(*arguments))
            step[4 + joint] = sign * 0.1
            return tuple(step)

        return move

    assert tracked(fast).stance == damped().stance


def test_a_singular_step_is_damped() -> None:
    def singular(*arguments: float) -> tuple[float, ...]:
        raise ZeroDivisionError

    assert tracked(lambda _: singular).stance == damped().stance


def test_a_leg_with_coupled_joints_is_not_plain() -> None:
    """A knee coupled to the hip leaves a row without an unknown."""
    plain = LegJoints.of(NAO, load_tree(NAO))
    assert plain.is_plain and len(plain.free) == 11
    for chain in (plain.chain(0), plain.chain(1)):
        columns = list(plain.columns)
        columns[chain[3]] = columns[chain[2]]
        assert not replace(plain, columns=tuple(columns)).is_plain
