"""Many maneuvers on a fake body, with the memory in use after each.

Run by a test in a process of its own, where no simulator is installed:
stand, evade the other until it is gone, halt, stand. Between two
maneuvers it rests. Prints what Python and NumPy hold after each maneuver,
as JSON, with the time that they took.
"""

import gc
import json
import sys

import numpy as np

from fake_body import FakeBody
from stepaside.control.scheme import build_scheme
from stepaside.locomotion.control_settings import ControlSettings
from stepaside.locomotion.locomotion import Phase
from stepaside.planning import GaitSettings
from stepaside.robots.description import load_robot
from stepaside.robots.forward_kinematics import ForwardKinematics
from stepaside.strategies import Evasion

TICK = 0.012
NEAR, FAR = 0.45, 3.0  # of the other, in [m]
CONTROLS = {
    "open loop": ControlSettings(),
    "feedback": ControlSettings(method="measured", feedback=True),
    "mpc": ControlSettings(method="mpc", feedback=True),
}


class Day:
    """One robot's control, and the body that it moves."""

    def __init__(self, kind: str) -> None:
        """Stand at midnight; ``kind`` is of ``CONTROLS``."""
        nao = load_robot("nao")
        self.mind = build_scheme(
            Evasion(safety_radius=0.8, release_distance=1.5),
            nao,
            GaitSettings(),
            CONTROLS[kind],
            tick=TICK,
        )
        weight = 9.81 * ForwardKinematics(nao).mass
        self.body = FakeBody(self.mind.joint_targets, weight, TICK)
        self.steps = 0

    def pass_until(self, phase: Phase, longest: float) -> None:
        """Let time pass tick by tick until a phase begins."""
        body, mind = self.body, self.mind
        until = body.time + longest
        while mind.phase is not phase:
            if body.time > until:
                raise RuntimeError(f"no {phase} within {longest} s")
            self.tick()

    def tick(self) -> None:
        """One tick of control."""
        self.body.write(self.mind.update(self.body.read()))
        self.body.step()
        self.steps += self.mind.begun is not None

    def maneuver(self) -> None:
        """Stand, walk for six seconds, halt, stand."""
        body = self.body
        body.distance = NEAR
        self.pass_until(Phase.WALKING, 5.0)
        for _ in range(round(6.0 / TICK)):
            self.tick()
        body.distance = FAR
        self.pass_until(Phase.STANDING, 30.0)
        for _ in range(round(2.5 / TICK)):
            self.tick()


def main(kind: str, maneuvers: int) -> None:
    """Play maneuvers, and print what is held after each."""
    day = Day(kind)
    found = np.zeros(maneuvers, dtype=np.int64)
    for number in range(maneuvers):
        day.maneuver()
        gc.collect()
        # Tracing each allocation would slow control down tenfold.
        found[number] = sys.getallocatedblocks()
    plain = {"held": found.tolist(), "steps": day.steps, "s": day.body.time}
    print(json.dumps(plain))


if __name__ == "__main__":
    main(sys.argv[1], int(sys.argv[2]))
