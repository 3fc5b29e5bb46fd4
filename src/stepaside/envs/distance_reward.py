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

from typing import NamedTuple, TypeVar

from ..core.poses import Array

Values = TypeVar("Values", float, Array)


class DistanceReward(NamedTuple):
    """Reward of an evader.

    Attributes:
        unit: Unit of length, v/k, in [m].
        shaping: Weight of the shaping.
        discount: Discount of the learner.
    """

    unit: float
    shaping: float = 0.0
    discount: float = 1.0

    def evader(
        self,
        closest: tuple[Values, Values],
        distance: tuple[Values, Values],
        ended: Values,
    ) -> Values:
        """Return the reward of one step.

        Args:
            closest: Closest approach so far, before and after the step, in
                [m].
            distance: Distance before and after the step, in [m].
            ended: 1 if the game ended with the step, else 0; a game that
                was truncated did not end.
        """
        change = closest[1] - closest[0]
        potential = self.discount * (1.0 - ended) * distance[1] - distance[0]
        return (change + self.shaping * potential) / self.unit


def reward_sign(role: str) -> float:
    """Return the sign of a role's reward: the game is zero-sum."""
    return 1.0 if role == "evader" else -1.0
