"""Import and play what runs on a robot, where no simulator is installed.

Run by a test in a process of its own; prints what happened as JSON.
"""

import json
import pkgutil
from importlib import import_module

from fake_body import FakeBody
from fake_robot import FakeStrategy
from stepaside.control.scheme import ControlScheme, build_walk
from stepaside.locomotion.control_settings import ControlSettings
from stepaside.planning import GaitSettings
from stepaside.robots.description import load_robot
from stepaside.robots.forward_kinematics import ForwardKinematics

ROOMS = ("robots", "perception", "strategies", "locomotion", "control")
TICK = 0.004

# Where models are read, changed, compiled and written as URDF.
WITH_MUJOCO = [
    f"stepaside.robots.{name}"
    for name in (
        *("geom_points", "tree_compiler", "model_overlay"),
        *("model_reader", "outdated_model", "urdf_writer"),
    )
]


def import_rooms() -> int:
    """Import every module of the rooms that need no simulator."""
    count = 0
    for room in (*ROOMS, "planning"):
        package = import_module(f"stepaside.{room}")
        found = pkgutil.walk_packages(package.__path__, f"{package.__name__}.")
        for module in found:
            if module.name not in WITH_MUJOCO:
                import_module(module.name)
                count += 1
    return count


def play(feedback: bool) -> dict[str, object]:
    """Stand, walk towards the other until it is gone, and halt."""
    nao, gait = load_robot("nao"), GaitSettings()
    forward = ForwardKinematics(nao)
    control = ControlSettings()
    if feedback:
        control = ControlSettings(method="measured", feedback=True)
    walk = build_walk(nao, gait, control, tick=TICK)
    scheme = ControlScheme(FakeStrategy(), walk)
    body = FakeBody(scheme.joint_targets, 9.81 * forward.mass, TICK)
    phases = [scheme.phase.value]
    for tick in range(2200):
        body.distance = 1.0 if tick < 1000 else 9.0
        body.write(scheme.update(body.read()))
        body.step()
        if scheme.phase.value != phases[-1]:
            phases.append(scheme.phase.value)
    posture = forward.posture(body.joints)
    return {
        "phases": phases,
        "walked": scheme.walk.left_foot.x,
        "apart": float(
            abs(
                posture.positions_feet_in_torso[0]
                - posture.positions_feet_in_torso[1]
            )[1]
        ),
    }


def main() -> None:
    """Import, play and print."""
    print(
        json.dumps(
            {
                "modules": import_rooms(),
                "without": play(False),
                "with": play(True),
            }
        )
    )
