# /// script
# dependencies = ["stepaside"]
# ///
"""Control a NAO without a simulator: measurements in, joint angles out.

The body here is trivial: its joints are at their targets. A real robot or
another simulator would take its place.
"""

import sys

sys.modules["mujoco"] = None  # type: ignore[assignment]

from time import perf_counter  # noqa: E402

import numpy as np  # noqa: E402

from stepaside import (  # noqa: E402
    ControlScheme,
    ControlSettings,
    Evasion,
    GaitSettings,
    RobotState,
    Sighting,
    build_walk,
    load_robot,
)

TICK = 0.004  # [s]
at_rest = np.array([0.0, 0.0, 9.81])  # specific force, in [m/s^2]
forces = np.full(8, 6.5)  # at the corners of the soles, in [N]

walk = build_walk(
    load_robot("nao"), GaitSettings(), ControlSettings(), tick=TICK
)
controller = ControlScheme(Evasion(), walk)
spent, worst = 0.0, 0.0
for tick in range(2500):
    now = tick * TICK
    # The pursuer approaches straight ahead at 0.15 m/s, and stops at 0.5 m.
    sighting = Sighting(now, 0.0, max(0.5, 1.4 - 0.15 * now))
    measured = RobotState(
        now, controller.joint_targets, np.zeros(3), at_rest, forces, sighting
    )
    began = perf_counter()
    targets = controller.update(measured)
    took = perf_counter() - began
    spent, worst = spent + took, max(worst, took)
    if controller.begun is not None:
        step = controller.begun
        x, y, heading = step.landing
        print(
            f"{now:6.2f} s  {controller.phase.value}: {step.foot.name.lower()}"
            f" foot to ({x:6.3f}, {y:6.3f}) m, {heading:6.3f} rad"
        )
print(f"{len(targets)} joints; a tick took {1e6 * spent / 2500:.0f} us in the")
print(f"mean and {1e3 * worst:.2f} ms at worst, of {1e3 * TICK:.0f} ms")
