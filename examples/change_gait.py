# /// script
# dependencies = ["stepaside"]
# ///
"""Compare gaits of NAO under a push, with and without feedback.

Run it alone: ``python examples/change_gait.py``.
"""

import sys
from math import hypot

from stepaside import ControlSettings, GaitSettings, Push, run_game, walk

seconds = float(sys.argv[1]) if len(sys.argv) > 1 else 10.0
gaits = {
    "as in the paper": GaitSettings(),
    "longer strides": GaitSettings(stride=0.06),
    "quicker steps": GaitSettings(single_support=0.3, double_support=0.1),
}
feedback = ControlSettings(method="measured", feedback=True)

print("gait             control     outcome      speed [m/s]  tilt [deg]")
for name, gait in gaits.items():
    for control in (ControlSettings(feedback=False), feedback):
        settings = walk(
            duration=seconds,
            gait=gait,
            control=control,
            # A push from the right: 0.6 N s over 0.1 s.
            pushes=(Push(0.6, 0.6 * seconds, 1.57),),
        )
        run = run_game(settings)
        x, y, _ = run.walker.com.T
        speed = hypot(x[-1] - x[0], y[-1] - y[0]) / run.duration
        walking = run.summary.walking
        tilt = walking.tilt_max_deg if walking else None
        loop = "feedback" if control.feedback else "open loop"
        print(
            f"{name:<16} {loop:<11} {run.outcome.value:<12} {speed:11.3f}"
            f"{tilt or 0.0:12.2f}"
        )
