"""Test that what drives a robot can be loaded on the robot."""

import subprocess
import sys

import pytest

ABSENT = ("mujoco", "scipy", "matplotlib", "cv2")


def loads(code: str) -> None:
    """Run code where nothing of a simulator can be imported."""
    absent = f"import sys; sys.modules.update(dict.fromkeys({ABSENT!r}));"
    subprocess.run([sys.executable, "-c", absent + code], check=True)


@pytest.mark.parametrize(
    "module", ["body", "opening", "server", "guardian", "sight_offer"]
)
def test_lola_is_spoken_without_a_simulator(module: str) -> None:
    loads(f"import stepaside.drivers.lola.{module}")


@pytest.mark.parametrize(
    "module",
    [
        "velocity.playing",
        "guardian",
        "velocity.guardian",
        "ros2.body",
        "naoqi.body",
        "naoqi.stepping",
        "naoqi.joint_line",
        "log",
    ],
)
def test_velocities_are_given_without_a_simulator(module: str) -> None:
    if module.startswith(("ros2", "naoqi")):
        needed = {"ros2": "cyclonedds", "naoqi": "qi"}
        pytest.importorskip(needed[module.partition(".")[0]])
    loads(f"import stepaside.drivers.{module}")


@pytest.mark.parametrize("language", ["cyclonedds", "qi", "msgpack"])
def test_who_drives_by_one_language_needs_no_other(language: str) -> None:
    others = {"cyclonedds", "qi", "msgpack"} - {language}
    door = {
        "cyclonedds": "stepaside.drivers.ros2.ros2_body",
        "qi": "stepaside.drivers.naoqi.naoqi_body",
        "msgpack": "stepaside.drivers.joint.joint_body",
    }
    pytest.importorskip(language)
    loads(
        f"sys.modules.update(dict.fromkeys({sorted(others)!r}));"
        f"import stepaside.cli.play, {door[language]}"
    )


def test_what_was_played_is_kept_without_a_simulator() -> None:
    """A run folder is made on the robot, whatever cannot be drawn there."""
    loads("import stepaside.cli.play_record, stepaside.games.run_archive")


def test_help_on_playing_loads_no_simulator() -> None:
    """It shows the defaults of gait and control: numbers, no physics."""
    loads(
        "from stepaside.cli.main import main\n"
        "try: main(['play', '--help'])\n"
        "except SystemExit as e: assert not e.code\n"
        "assert 'stepaside.sim.world' not in sys.modules"
    )
