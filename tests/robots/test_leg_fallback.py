"""Test when legs take a damped step instead of the one written out."""

from collections.abc import Callable
from dataclasses import replace
from functools import cache

import numpy as np
import pytest

from stepaside.robots.description import load_robot
from stepaside.robots.leg_joints import LegJoints
from stepaside.robots.leg_kinematics import FAR, BodyReference, LegKinematics
from stepaside.robots.tree_cache import load_tree

NAO = load_robot("nao")
STANCE = BodyReference(
    (0.02, 0.0, 0.26), (0.0, 0.05, 0.0, 0.0), (0.0, -0.05, 0.0, 0.0)
)
NEAR = STANCE._replace(com=(0.021, 0.001, 0.259))
Step = Callable[..., tuple[float, ...]]


def following(quick: Callable[[Step], Step | None]) -> LegKinematics:
    """Legs that have stood and followed once, with another quick step."""
    legs = LegKinematics(NAO, tick=0.004)
    legs.stand(STANCE)
    own = legs._solver.quick
    assert own is not None
    legs._solver = legs._solver._replace(quick=quick(own))
    before = legs.joint_targets
    assert np.abs(legs.track(NEAR) - before).max() > 1e-4
    return legs


@cache
def damped() -> LegKinematics:
    """What they do without a step that is written out."""
    return following(lambda _: None)


def test_a_step_within_all_limits_is_not_damped() -> None:
    own = following(lambda quick: quick)
    off = np.abs(own.joint_targets - damped().joint_targets).max()
    assert 0.0 < off < 1e-3


@pytest.mark.parametrize("sign", [-1.0, 1.0])
@pytest.mark.parametrize("unknown", range(4))
def test_a_step_that_goes_too_far_is_damped(unknown: int, sign: float) -> None:
    """Of the torso, along any axis or in its heading."""

    def leaping(quick: Step) -> Step:
        def leap(*arguments: float) -> tuple[float, ...]:
            step = list(quick(*arguments))
            step[unknown] = sign * 1.01 * FAR
            return tuple(step)

        return leap

    assert following(leaping).stance == damped().stance


@pytest.mark.parametrize("sign", [-1.0, 1.0])
@pytest.mark.parametrize("joint", range(11))
def test_a_step_that_is_too_fast_for_a_joint_is_damped(
    joint: int, sign: float
) -> None:
    def fast(quick: Step) -> Step:
        def move(*arguments: float) -> tuple[float, ...]:
            step = list(quick(*arguments))
            step[4 + joint] = sign * 0.1
            return tuple(step)

        return move

    assert following(fast).stance == damped().stance


def test_a_step_that_has_no_solution_is_damped() -> None:
    def singular(*arguments: float) -> tuple[float, ...]:
        raise ZeroDivisionError

    assert following(lambda _: singular).stance == damped().stance


def test_no_leg_that_is_plain_has_joints_that_move_as_one() -> None:
    """A knee that its hip moves leaves a row without an unknown."""
    plain = LegJoints.of(NAO, load_tree(NAO))
    assert plain.is_plain and len(plain.free) == 11
    for chain in (plain.chain(0), plain.chain(1)):
        columns = list(plain.columns)
        columns[chain[3]] = columns[chain[2]]
        assert not replace(plain, columns=tuple(columns)).is_plain
