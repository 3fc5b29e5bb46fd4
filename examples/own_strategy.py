# /// script
# dependencies = ["stepaside"]
# ///
"""Custom evader: aside at a distance, backward when the pursuer is near."""

import sys
from dataclasses import dataclass
from math import pi

import numpy as np

from stepaside import (
    Direction,
    DuelSettings,
    RelativeStart,
    StartSettings,
    run_duel,
)
from stepaside import strategies as st
from stepaside.theory.unicycle.unicycle_game import Unicycle


@dataclass(frozen=True)
class BackAndAside:
    """Blend "move back" into "move aside" as the distance grows."""

    direction: Direction = Direction.BACKWARD
    saturated: bool = False

    def begin(self) -> st.EvasionMemory:
        """Return the memory before the first decision."""
        return st.EvasionMemory()

    def decide(
        self, knowledge: st.Knowledge, memory: st.EvasionMemory
    ) -> tuple[st.Intent, st.EvasionMemory]:
        """Evade as in the paper, at an angle that depends on the distance."""
        blend = 2.0 * knowledge.distance - 1.0  # 0 at 0.5 m, 1 at 1 m
        angle = 0.5 * pi * min(max(blend, 0.0), 1.0)
        return st.Evasion(angle=angle).decide(knowledge, memory)


def main(duration: float) -> None:
    """Compare it with moving aside, with unicycles and with humanoids."""
    body = Unicycle(0.1, 0.2)  # of NAO, in path time: 0.4 s per 0.547 s
    for name in ("evasion", f"{__file__}:BackAndAside"):
        game = st.play_strategies(
            st.Pursuit(),
            st.load_strategy(name),
            RelativeStart(0.9, 0.3, -0.2),
            bodies=(body, body),
            period=0.4,
            duration=0.4 / 0.547 * duration,
        )
        start = StartSettings(0.9, -0.3, 0.2)
        duel = run_duel(
            DuelSettings(duration=duration, start=start, evader_strategy=name)
        )
        for bodies, closest, path in (
            ("unicycles", game.closest_distance, game.evader),
            ("humanoids", duel.summary.min_distance_m, duel.evader.torso),
        ):
            floor = np.hypot(*(path - path[0])[:, :2].T).max()
            strategy = "aside" if name == "evasion" else "own"
            print(
                f"{strategy} {bodies}: closest approach {closest:.2f} m, "
                f"floor used {floor:.2f} m"
            )


if __name__ == "__main__":
    main(float(sys.argv[1]) if len(sys.argv) > 1 else 40.0)
