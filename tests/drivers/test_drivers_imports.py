"""Test that drivers load without a simulator."""

import subprocess
import sys
from importlib.util import find_spec

DRIVERS = "stepaside.drivers"
ABSENT = ("mujoco", "scipy", "matplotlib", "cv2")
VENDORS = {
    "msgpack": ["lola"],
    "cyclonedds": ["ros2", "ros2_server"],
    "qi": ["naoqi"],
}


def loads(code: str) -> None:
    """Run code in a process without the simulator's libraries."""
    absent = f"import sys; sys.modules.update(dict.fromkeys({ABSENT!r}));"
    subprocess.run([sys.executable, "-c", absent + code], check=True)


def test_drivers_load_without_a_simulator() -> None:
    """The run folder is written on board the robot, too."""
    names = ["joint_loop", "velocity_loop", "play_log", "rcss"]
    for library, modules in VENDORS.items():
        names += modules if find_spec(library) else []
    modules = ["stepaside.cli.play_recording", "stepaside.games.run_archive"]
    modules += [f"{DRIVERS}.{name}" for name in names]
    loads(f"import {', '.join(modules)}")
