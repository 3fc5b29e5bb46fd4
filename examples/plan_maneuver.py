# /// script
# dependencies = ["stepaside"]
# ///
"""Plan one maneuver of the evader: footsteps, ZMP and bounded CoM.

Run it alone: ``python examples/plan_maneuver.py``. It needs numpy only.
"""

from math import degrees, radians
from time import perf_counter

import numpy as np

from stepaside import Direction, Foot, GaitSettings, ManeuverPlanner

planner = ManeuverPlanner(GaitSettings())

# The pursuer is 40 degrees to the left; the evader, which walks backward,
# turns until its heading is perpendicular to the line of sight (eq. 5).
began = perf_counter()
plan = planner.plan(
    radians(40.0 - 90.0),
    Direction.BACKWARD,
    first_foot=Foot.RIGHT,
    standing=True,
)
took = perf_counter() - began

print(f"planned {len(plan.footsteps)} footsteps in {1e3 * took:.2f} ms")
print("foot      x [m]    y [m]   heading [deg]")
for step in plan.footsteps:
    name = step.foot.name.lower()
    heading = degrees(step.theta)
    print(f"{name:<6} {step.x:8.3f} {step.y:8.3f} {heading:10.1f}")

times = np.arange(0.0, plan.schedule.duration, 0.01)
samples = plan.sample(times)
sway = np.ptp(samples.com[:, 1])
print(f"over {times[-1]:.1f} s the CoM sways by {1e3 * sway:.0f} mm;")
margin = plan.margin(plan.schedule.duration)
print(f"the ZMP stays {1e3 * margin:.0f} mm inside the feet")
