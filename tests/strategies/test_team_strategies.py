"""Test strategies of teams: cyclic, assigned, pincer, evasion."""

from dataclasses import replace
from itertools import permutations
from math import atan2, cos, hypot, pi, sin
from typing import Any

import numpy as np
import pytest

from stepaside.arena import Box, ObstacleSet
from stepaside.core.player_identity import PlayerIdentity, Role
from stepaside.strategies.knowledge import Knowledge, Limits, OtherPlayer
from stepaside.strategies.team_strategies import (
    AssignedPursuit,
    CyclicPursuit,
    GoalWalk,
    Pincer,
    TeamEvasion,
    assign,
)
from stepaside.strategies.velocity_set import BodyVelocity, VelocitySet

LIMITS = Limits(0.1, 0.2, 0.04, 0.547)
ROLES = {"r": Role.PURSUER, "b": Role.EVADER, "g": Role.BYSTANDER}


def identity(name: str) -> PlayerIdentity:
    role = ROLES[name[0]]
    return PlayerIdentity(name, role, role.value)


def known(own: str, **others: tuple[float, float]) -> Knowledge:
    """Return what a player at the origin knows; names begin with a role."""
    seen = tuple(
        OtherPlayer(identity(name), atan2(y, x), hypot(x, y), (0.0, 0.0))
        for name, (x, y) in others.items()
    )
    opposed = [s for s in seen if identity(own).opposes(s.identity)] or seen
    nearest = min(opposed, key=lambda other: other.distance)
    return Knowledge(
        0.0,
        nearest.bearing,
        nearest.distance,
        LIMITS,
        velocity=(0.0, 0.0),
        identity=identity(own),
        others=seen,
    )


def heading(strategy: Any, knowledge: Knowledge) -> float:
    intent, _ = strategy.decide(knowledge, strategy.begin())
    assert intent.walks
    return float(intent.heading)


def test_in_cyclic_pursuit_each_heads_for_the_next_name() -> None:
    far = {"r2": (0.0, 2.0), "r3": (-2.0, 0.1)}
    assert heading(CyclicPursuit(), known("r1", **far)) == pytest.approx(
        pi / 2
    )
    back = {"r1": (1.0, 1.0), "r2": (0.0, 2.0)}
    assert heading(CyclicPursuit(), known("r3", **back)) == pytest.approx(
        pi / 4
    )
    alone = Knowledge(0.0, 0.3, 1.0, LIMITS)
    assert heading(CyclicPursuit(), alone) == 0.3


@pytest.mark.parametrize("seed", range(20))
@pytest.mark.parametrize("shape", [(3, 3), (4, 2), (2, 4), (5, 3), (4, 3)])
def test_the_assignment_has_the_least_total_cost(
    shape: tuple[int, int], seed: int
) -> None:
    costs = np.random.default_rng(seed).uniform(size=shape)
    rows, columns = shape
    slots = list(range(columns)) * -(-rows // columns)
    every = [
        option
        for option in permutations(slots, rows)
        if max(map(option.count, option)) - min(map(option.count, option)) < 2
        and (rows < columns or set(option) == set(range(columns)))
    ]
    best = min(costs[range(rows), list(option)].sum() for option in every)
    found = assign(costs)
    assert costs[range(rows), list(found)].sum() == pytest.approx(best)


def test_assigned_pursuers_take_different_evaders() -> None:
    """The nearest evader of both is b1, but one of them takes b2."""
    first = known("r1", r2=(0.0, -2.0), b1=(2.0, 0.0), b2=(0.0, 4.0))
    assert heading(AssignedPursuit(), first) == pytest.approx(pi / 2)
    second = known("r2", r1=(0.0, 2.0), b1=(2.0, 2.0), b2=(0.0, 6.0))
    assert heading(AssignedPursuit(), second) == pytest.approx(pi / 4)


def test_the_pincer_closes_from_both_sides() -> None:
    left = known("r1", r2=(0.0, -1.0), b1=(3.0, -0.5))
    right = known("r2", r1=(0.0, 1.0), b1=(3.0, 0.5))
    straight = atan2(-0.5, 3.0)
    assert heading(Pincer(), left) > straight + 0.1
    assert heading(Pincer(), right) == pytest.approx(-heading(Pincer(), left))
    near = known("r1", r2=(0.0, -1.0), b1=(0.6, 0.1))
    assert heading(Pincer(), near) == pytest.approx(atan2(0.1, 0.6))


def test_a_pursuer_turns_away_from_mates_and_halts_behind_a_near_one() -> None:
    far = {"b1": (3.0, 0.0)}
    aim = heading(Pincer(), known("r1", r2=(-0.2, 0.1), **far))
    aside = known("r1", r2=(0.1, 0.4), **far)
    assert heading(Pincer(), aside) < aim - 0.5
    for bearing, walks in ((0.0, False), (1.2, True)):
        near = known("r1", r2=(0.1 * cos(bearing), 0.1 * sin(bearing)), **far)
        assert Pincer().decide(near, Pincer().begin())[0].walks == walks


def test_an_evader_between_two_pursuers_leaves_through_the_gap() -> None:
    """Moving away from one of them would lead into the other."""
    evasion = TeamEvasion(safety_radius=2.0)
    pair = known("b1", r1=(0.9, 0.0), r2=(-0.9, 0.2))
    turn = heading(evasion, pair)
    mirrored = known("b1", r1=(0.9, 0.0), r2=(-0.9, -0.2))
    assert heading(evasion, mirrored) == pytest.approx(-turn)
    assert abs(turn) > 1.0
    alone = known("b1", r1=(0.9, 0.0))
    assert abs(heading(evasion, alone)) < 0.1
    far = known("b1", r1=(3.0, 0.0))
    assert not evasion.decide(far, False)[0].walks


def test_a_walker_heads_for_its_goal_and_gives_way() -> None:
    walk = GoalWalk(goal=(5.0, 0.0))
    assert heading(walk, known("g1", g2=(-3.0, 0.0))) == pytest.approx(0.0)
    ahead = known("g1", g2=(1.5, 0.05))
    (other,) = ahead.others
    comes = replace(ahead, others=(other._replace(velocity=(-0.3, 0.0)),))
    assert heading(walk, comes) < -0.2
    at_once = known("g1", g2=(0.5, 0.0))
    (other,) = at_once.others
    hit = replace(at_once, others=(other._replace(velocity=(-1.0, 0.0)),))
    assert not walk.decide(hit, walk.begin())[0].walks
    there = GoalWalk(goal=(0.1, 0.0))
    assert not there.decide(ahead, there.begin())[0].walks


LEGS = VelocitySet((-0.5, 0.7), (-0.35, 0.35), (-0.9, 0.9))


def velocity(walk: GoalWalk, knowledge: Knowledge) -> BodyVelocity:
    limits = replace(knowledge.limits, velocities=LEGS)
    wanted = walk.decide(replace(knowledge, limits=limits), walk.begin())[0]
    assert wanted.velocity is not None
    return wanted.velocity


def test_legs_of_any_direction_walk_to_the_goal_and_step_aside() -> None:
    walk = GoalWalk(goal=(5.0, 0.0))
    free = velocity(walk, known("g1", g2=(-3.0, 0.0)))
    assert free.forward == pytest.approx(0.7) and abs(free.lateral) < 1e-9
    ahead = known("g1", g2=(1.5, 0.05))
    (other,) = ahead.others
    comes = replace(ahead, others=(other._replace(velocity=(-0.5, 0.0)),))
    assert velocity(walk, comes).lateral < -0.2
    near = known("g1", g2=(0.4, 0.0))  # within contact: it backs away
    assert velocity(walk, near).forward < 0.0


def test_a_walker_keeps_clear_of_walls_while_it_gives_way() -> None:
    walk = GoalWalk(goal=(5.0, 0.0))
    ahead = known("g1", g2=(1.5, 0.05))
    (other,) = ahead.others
    comes = replace(ahead, others=(other._replace(velocity=(-0.5, 0.0)),))
    slow = replace(ahead, others=(other._replace(velocity=(-0.3, 0.0)),))
    wall = ObstacleSet((Box(1.0, -0.35, 4.0, 0.2),))  # on its right
    assert velocity(walk, comes).lateral < 0.0
    assert velocity(walk, replace(comes, obstacles_in_map=wall)).lateral > 0.0
    assert heading(walk, slow) < -0.2
    assert heading(walk, replace(slow, obstacles_in_map=wall)) > -0.2
