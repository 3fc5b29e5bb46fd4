"""Test ``serve`` and ``play`` of robots that walk by themselves, in words."""

from pathlib import Path

import pytest

from stepaside.cli.main import main

ADAPTERS = Path(__file__).parents[2] / "examples" / "adapters"
WALKER = f"{ADAPTERS / 'walker_robot.py'}:WalkerRobot"


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
        (
            f"play {WALKER} --sensing cameras --set wait=0",
            "requires the method image() of WalkerRobot",
        ),
        ("play lola:none --set wait=0.3", "no robot listens at"),
        ("play lola:x --set legs.network=x.onnx", "a robot that takes gains"),
        ("serve", "issing option '--ros2'"),
        ("serve --ros2 referee=/e", "each player once"),
        ("play nowhere.py:Robot", "/nowhere.py"),
        ("play ros2:/x --check", "--check requires the address FILE.py"),
        ("play ros2:/x --json", "--json requires --check"),
        (
            "play x.py:X --check --record run",
            "record requires a play without --check",
        ),
        (
            "serve --ros2 evader",
            "pursuer or evader=/NAMESPACE",
        ),
        ("serve --ros2 evader=/e --ros2 evader=/f", "each player once"),
    ],
)
def test_errors_are_reported_in_one_line(
    words: str, said: str, capsys: pytest.CaptureFixture[str]
) -> None:
    pytest.importorskip("cyclonedds")
    assert said in refused(capsys, *words.split())
