r"""Rewards of pursuer and evader: the closest approach of the episode.

The reward of the evader is the change of the closest approach so far, in
units of v/k, zero or negative; contact with an obstacle counts as a closest
approach of zero. So its return, undiscounted, is the closest approach of the
episode less the initial distance: what
:mod:`stepaside.theory.value.two_cars` bounds. The pursuer has the negative.

Shaping adds :math:`\gamma \Phi(s') - \Phi(s)` to the evader's reward, where
the potential :math:`\Phi` is a weight times the distance, and zero after the
end of a game; that changes no optimal policy (Ng, Harada and Russell 1999).
"""

from typing import TypeVar

from ..core.poses import Array

Values = TypeVar("Values", float, Array)


def evader_reward(
    closest: tuple[Values, Values],
    distance: tuple[Values, Values],
    ended: Values,
    shaping: tuple[float, float],
) -> Values:
    """Return the reward of an evader for one step, in [m].

    Args:
        closest: Closest approach so far, before and after the step, in [m].
        distance: Distance before and after the step, in [m].
        ended: 1 if the game ended with the step, else 0; a game that was
            truncated did not end.
        shaping: Weight of the shaping, and the discount of the learner.
    """
    weight, discount = shaping
    change = closest[1] - closest[0]
    potential = discount * (1.0 - ended) * distance[1] - distance[0]
    return change + weight * potential
