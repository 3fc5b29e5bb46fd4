"""Test that drivers load without a simulator or another driver's library."""

import subprocess
import sys
from importlib.util import find_spec

import pytest

DRIVERS = "stepaside.drivers"
LOLA = ("lola_connection", "lola_server", "sight_socket")
NAOQI = ("naoqi_body", "video_client")
ABSENT = ("mujoco", "scipy", "matplotlib", "cv2")


def loads(code: str) -> None:
    """Run code in a process without the simulator's libraries."""
    absent = f"import sys; sys.modules.update(dict.fromkeys({ABSENT!r}));"
    subprocess.run([sys.executable, "-c", absent + code], check=True)


def test_drivers_load_without_a_simulator() -> None:
    """The run folder is written on board the robot, too."""
    modules = [
        "stepaside.cli.play_recording",
        "stepaside.games.run_archive",
        *(f"{DRIVERS}.lola.{name}" for name in LOLA),
        *(
            f"{DRIVERS}.velocity.velocity_{name}"
            for name in ("loop", "guardian")
        ),
        *(f"{DRIVERS}.{name}" for name in ("guardian_process", "play_log")),
    ]
    if find_spec("cyclonedds"):
        modules.append(f"{DRIVERS}.ros2.ros2_body")
    if find_spec("qi"):
        modules += [f"{DRIVERS}.naoqi.{name}" for name in NAOQI]
    loads(f"import {', '.join(modules)}")


@pytest.mark.parametrize("library", ["cyclonedds", "qi", "msgpack"])
def test_each_protocol_loads_without_the_libraries_of_others(
    library: str,
) -> None:
    others = {"cyclonedds", "qi", "msgpack"} - {library}
    entry = {
        "cyclonedds": "stepaside.drivers.ros2.ros2_body",
        "qi": "stepaside.drivers.naoqi.naoqi_body",
        "msgpack": "stepaside.drivers.lola.lola_connection",
    }
    pytest.importorskip(library)
    loads(
        f"sys.modules.update(dict.fromkeys({sorted(others)!r}));"
        f"import stepaside.cli.play, {entry[library]}"
    )


def test_help_of_play_loads_no_simulator() -> None:
    """The defaults of gait and control need no physics."""
    loads(
        "from stepaside.cli.main import main\n"
        "try: main(['play', '--help'])\n"
        "except SystemExit as e: assert not e.code\n"
        "assert 'stepaside.sim.world' not in sys.modules"
    )
