"""Test ``serve`` and ``play`` of robots that walk by themselves, in words."""

import subprocess
import sys

import pytest

from stepaside.cli.main import main

PLAY = "from stepaside.cli.main import main; main()"
TICK = 0.012


def refused(capsys: pytest.CaptureFixture[str], *words: str) -> str:
    """Return the message for invalid arguments."""
    with pytest.raises(SystemExit) as left:
        main(list(words))
    assert left.value.code == 2
    said = capsys.readouterr().err.strip().splitlines()[-1]
    assert said.startswith("stepaside: ")
    return said


@pytest.mark.parametrize(
    ("words", "said"),
    [
        ("play nao:x --role evader", "rcss:, or be FILE.py:CLASS"),
        ("play ros2:/na-o --role evader", "namespace must be"),
        ("play naoqi:x:0 --role evader", "naoqi:tcp://HOST:PORT"),
        (
            "play ros2:/e --set max_lateral=0.3 --set max_speed=0.4",
            "max_lateral requires max_speed and max_turn",
        ),
        (
            "play naoqi:tcp://127.0.0.1:1 --set max_lateral=0.3",
            "requires a robot at ros2:",
        ),
        ("serve", "--lola PLAYER=PATH or --ros2"),
        ("serve --lola referee=E", "each player once"),
        (
            "serve --ros2 evader",
            "pursuer or evader=/NAMESPACE",
        ),
        ("serve --ros2 evader=/e --ros2 evader=/f", "each player once"),
        ("serve --lola evader=E --ros2 evader=/f", "each player once"),
    ],
)
def test_errors_are_reported_in_one_line(
    words: str, said: str, capsys: pytest.CaptureFixture[str]
) -> None:
    pytest.importorskip("cyclonedds")
    assert said in refused(capsys, *words.split())


LOCALHOST = "ROS_AUTOMATIC_DISCOVERY_RANGE=LOCALHOST"


@pytest.mark.parametrize(
    "words",
    [
        "serve --ros2 evader=/alone",
        "play ros2:/alone --role evader",
        "play ros2:/alone --role evader --dry-run",
    ],
)
def test_local_topics_name_the_setting_that_ros_needs(words: str) -> None:
    pytest.importorskip("cyclonedds")
    process = subprocess.Popen(
        [sys.executable, "-c", PLAY, *words.split(), "--domain", "73"],
        stdout=subprocess.DEVNULL,
        stderr=subprocess.PIPE,
        text=True,
    )
    try:
        assert process.stderr is not None
        said = next(line for line in process.stderr if LOCALHOST in line)
        assert "opens its UDP ports on all interfaces" in said
    finally:
        process.kill()
        process.communicate(timeout=20.0)
