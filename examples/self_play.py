# /// script
# dependencies = ["stepaside[learn]"]
# ///
"""Train evader and pursuer against each other, in turns.

In each round one learns while the other is fixed. Run it alone:
``python examples/self_play.py``; numbers after that are those of
rounds and of updates in each.
The policies are written to self-evader.onnx and self-pursuer.onnx:
``stepaside study tournament --set evader=self-evader.onnx --set
pursuer=self-pursuer.onnx``.
"""

import sys

from train_evader import (
    OptimisationSettings,
    PolicyOptimiser,
    TrainingProgress,
)

from stepaside.envs import VectorDuel
from stepaside.games import duel
from stepaside.strategies import Strategy, load_strategy

FIRST = {"evader": "pursuit", "pursuer": "evasion"}  # opponents


def games_against(opponent: Strategy, role: str) -> VectorDuel:
    """Return games of one role against a fixed opponent."""
    return VectorDuel(
        256,
        role=role,
        opponent=opponent,
        level="steps",
        any_heading=True,
        duel=duel(capture=0.02),
        duration=55.0,
        action="discrete",
        full_state=True,
    )


def main(rounds: int = 6, updates: int = 30) -> None:
    """Play some rounds, and save the policies."""
    opponents = {role: load_strategy(FIRST[role]) for role in FIRST}
    settings = OptimisationSettings(updates=updates)
    learners: dict[str, PolicyOptimiser] = {}
    print("learner: closest approach of its games [m]")
    for n in range(rounds):
        role, other = list(FIRST)[:: 1 - 2 * (n % 2)]
        games = games_against(opponents[role], role)
        new = PolicyOptimiser(games, settings, seed=n)
        learner = learners.setdefault(role, new)
        learner.change_games(games, seed=n)
        found: list[TrainingProgress] = []
        policy = learner.train(found.append)
        first, last = found[1].closest_m, found[-1].closest_m
        print(f"{role}: {first:.3f} m at first, then {last:.3f} m")
        opponents[other] = policy
        policy.save(f"self-{role}.onnx")


if __name__ == "__main__":
    main(*map(int, sys.argv[1:3]))
