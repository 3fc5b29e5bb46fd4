"""Time one MPC tick against a replan of the closed form, in one process."""

import numpy as np
from call_timing import time_call

from stepaside.locomotion.control_settings import MpcSettings
from stepaside.locomotion.zmp.mpc import IntrinsicallyStableMpc
from stepaside.planning import (
    CenterState,
    Direction,
    Foot,
    GaitSettings,
    ManeuverPlan,
    ManeuverPlanner,
)

TIME = 0.1  # time since the plan began, in [s]
PUSHED = (0.02, 0.03)  # DCM error in [m], large enough to activate constraints


def measure_mpc() -> dict[str, float]:
    """Return the times of one tick with a horizon of two steps, in [us]."""
    gait = GaitSettings()
    planner = ManeuverPlanner(gait)

    def replan() -> ManeuverPlan:
        return planner.plan(
            0.4,
            Direction.FORWARD,
            first_foot=Foot.LEFT,
            state=CenterState((0.01, 0.025), (0.07, -0.04)),
        )

    plan = replan()
    mpc = IntrinsicallyStableMpc(gait, MpcSettings(), edge=0.002)
    zmp = np.zeros(2)

    def solve(dcm: tuple[float, float]) -> object:
        return mpc.solve(plan, TIME, np.array(dcm), zmp)

    return {
        "mpc_tick_us": 1e6 * time_call(lambda: solve((0.005, 0.0)), calls=50),
        "mpc_tick_pushed_us": 1e6 * time_call(lambda: solve(PUSHED), calls=50),
        "mpc_closed_form_us": 1e6 * time_call(replan, calls=50),
    }


if __name__ == "__main__":
    for name, value in measure_mpc().items():
        print(f"{name}: {value:.3g}")
