# /// script
# dependencies = ["stepaside"]
# ///
"""Custom evader: aside at a distance, backward when the pursuer is near."""

import sys
from dataclasses import dataclass
from math import pi

import stepaside as sa
from stepaside import strategies as st


@dataclass(frozen=True)
class BackAndAside:
    """Blend "move back" into "move aside" as the distance grows."""

    direction: sa.Direction = sa.Direction.BACKWARD
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
    start = sa.StartSettings(0.9, -0.3, 0.2)
    settings = sa.duel(duration=duration, start=start)
    names = {"aside": "evasion", "own": f"{__file__}:BackAndAside"}
    levels = {"unicycles": "steps", "humanoids": "physics"}
    for label, name in names.items():
        for bodies, level in levels.items():
            duel = sa.run_game(settings.changed(evader=name, level=level))
            closest, path = duel.summary.min_distance_m, duel.evader.torso
            moved = (path - path[0])[:, :2]
            floor = (moved**2).sum(axis=1).max() ** 0.5
            print(f"{label} {bodies}: closest approach "
                  f"{closest:.2f} m, floor used {floor:.2f} m")  # fmt: skip


if __name__ == "__main__":
    main(float(sys.argv[1]) if len(sys.argv) > 1 else 40.0)
