# /// script
# dependencies = ["stepaside[export]"]
# ///
"""Study of an own evader: 20 duels over a parameter, a frame and a figure."""

from dataclasses import dataclass, replace
from typing import Any

import stepaside as sa


@dataclass(frozen=True)
class BackOff(sa.Evasion):
    """Moves aside, and straight back from a pursuer nearer than ``near``."""

    near: float = 0.5  # [m]

    def decide(self, knowledge: sa.Knowledge, memory: Any) -> Any:
        """Return the intent and the memory of the paper's evader."""
        angle = 0.0 if knowledge.distance < self.near else self.angle
        evader = replace(self, angle=angle)
        return sa.Evasion.decide(evader, knowledge, memory)


if __name__ == "__main__":
    own = f"{__file__}:BackOff(near=%s)"
    shared = {"duration": 10.0, "start.distance": 0.7}
    near = {n: {"evader.strategy": own % n} for n in (0.3, 0.5, 0.7, 0.9)}
    study = sa.make_study(
        "duel", shared, {"seed": range(5)}, variants={"near": near}
    )
    run = sa.run_study(study, "back_off.sqlite", workers=4)
    run.draw("back_off.png", "min_distance_m")
    frame = run.to_frame().select("near", "min_distance_m")
    for n, closest in frame.group_by("near").mean().sort("near").rows():
        print(f"back off at {n} m: closest approach {closest:.3f} m")
