# /// script
# dependencies = ["stepaside[learn]"]
# ///
"""Train an evader by PPO on one core, and compare it with the optimum.

Run it alone: ``python examples/train_evader.py`` on an open floor, or
``... discs 200`` in rooms with three discs, with 200 updates. The policy is
evader-open.onnx or evader-discs.onnx, for ``stepaside duel --strategy``, the
training curve training-open.png or training-discs.png.
"""

import sys
from time import process_time

import matplotlib.pyplot as plt

from stepaside.arena import RoomRecipe
from stepaside.envs import VectorDuel
from stepaside.envs.policy_optimisation import (
    OptimisationSettings,
    PolicyOptimiser,
)
from stepaside.strategies import StepGame
from stepaside.studies.strategy_rating import rating_rows, rating_study

ROOMS = {"open": None, "discs": RoomRecipe(discs=3)}
WORLDS = {"open": ["open floor", "any heading"], "discs": ["3 x 3 m, 3 discs"]}


def main(floor: str, updates: int) -> None:
    """Train, save and rate an evader."""
    is_open = floor == "open"
    games = VectorDuel(
        512,
        role="evader",
        level="steps",
        room=ROOMS[floor],
        any_heading=is_open,
        game=StepGame(capture=0.02 if is_open else 0.35),
        first_arena=1000,  # those before are for the rating
        action="discrete",
        full_state=True,
    )
    learner = PolicyOptimiser(games, OptimisationSettings(updates), seed=1)
    curve = []
    for n in range(updates):
        curve.append(learner.update(n, 1.0 - n / updates).closest_m)
        if n % 10 == 0:
            print(f"{process_time():4.0f} s: {curve[-1]:.3f} m, {n}")
    draw_curve(curve, f"training-{floor}.png")
    learner.strategy().save(f"evader-{floor}.onnx")
    rated = [(f"evader-{floor}.onnx", "evader"), ("aside", "evader")]
    study = rating_study(rated, max(2, updates // 2), 60.0, WORLDS[floor])
    for row in rating_rows([study.measure(case) for case in study.cases]):
        if row["mean_ratio"] is not None:
            print(
                f"{row['strategy']} in {row['world']}: survived "
                f"{row['survived']:.2f}, closest approach over bound "
                f"{row['mean_ratio']:.3f} +- {row['mean_ratio_pm']:.3f}"
            )


def draw_curve(curve: list[float], file: str) -> None:
    """Draw the mean closest approach of the games that ended, in [m]."""
    plt.figure(figsize=(6.0, 2.6), layout="constrained")
    plt.plot(curve, color="#1f5fbf")
    plt.xlabel("update")
    plt.ylabel("closest approach [m]")
    plt.ylim(bottom=0.0)
    plt.grid(alpha=0.3)
    plt.savefig(file, dpi=120)


if __name__ == "__main__":
    floor, updates = sys.argv[1:] or ("open", "100")
    main(floor, int(updates))
