"""Test that drivers load without a simulator or another driver's library."""

import subprocess
import sys

import pytest

ABSENT = ("mujoco", "scipy", "matplotlib", "cv2")


def loads(code: str) -> None:
    """Run code in a process without the simulator's libraries."""
    absent = f"import sys; sys.modules.update(dict.fromkeys({ABSENT!r}));"
    subprocess.run([sys.executable, "-c", absent + code], check=True)


@pytest.mark.parametrize(
    "module", ["lola_connection", "lola_server", "sight_socket"]
)
def test_lola_loads_without_a_simulator(module: str) -> None:
    loads(f"import stepaside.drivers.lola.{module}")


@pytest.mark.parametrize(
    "module",
    [
        "velocity.velocity_loop",
        "guardian_process",
        "velocity.velocity_guardian",
        "ros2.ros2_body",
        "naoqi.naoqi_body",
        "naoqi.footstep_mover",
        "naoqi.joint_transport",
        "play_log",
    ],
)
def test_other_drivers_load_without_a_simulator(module: str) -> None:
    if module.startswith(("ros2", "naoqi")):
        needed = {"ros2": "cyclonedds", "naoqi": "qi"}
        pytest.importorskip(needed[module.partition(".")[0]])
    loads(f"import stepaside.drivers.{module}")


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


def test_a_run_is_recorded_without_a_simulator() -> None:
    """The run folder is written on board the robot."""
    loads("import stepaside.cli.play_recording, stepaside.games.run_archive")


def test_help_of_play_loads_no_simulator() -> None:
    """The defaults of gait and control need no physics."""
    loads(
        "from stepaside.cli.main import main\n"
        "try: main(['play', '--help'])\n"
        "except SystemExit as e: assert not e.code\n"
        "assert 'stepaside.sim.world' not in sys.modules"
    )
