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
    TrainingProgress,
)
from stepaside.strategies import StepGame
from stepaside.studies import load_study, run_study

ROOMS = {"open": None, "discs": RoomRecipe(discs=3)}
FLOORS = {"open": "open*,any*", "discs": "*discs"}


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
    curve: list[float] = []

    def note(progress: TrainingProgress) -> None:
        if len(curve) % 10 == 0:
            print(
                f"{process_time():4.0f} s: {progress.closest_m:.3f} m, "
                f"{len(curve)}"
            )
        curve.append(progress.closest_m)

    learner.train(note).save(f"evader-{floor}.onnx")
    draw_curve(curve, f"training-{floor}.png")
    study = load_study(
        "rating",
        [
            f"evader=evader-{floor}.onnx,evasion(safety_radius=100)",
            f"floor={FLOORS[floor]}",
            "pursuer=pursuit",
            f"seed=0:{max(2, updates // 2)}",
        ],
    )
    for row in run_study(study).table(values=["survived", "of_bound"]):
        over = row["of_bound"]
        print(
            f"{row['evader']} on {row['floor']}: survived "
            f"{row['survived']['share']:.2f}, closest approach over bound "
            f"{over['mean']:.3f} +- {over['half']:.3f}"
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
