"""Test ``serve`` and ``play`` of robots that walk by themselves, in words."""

import json
import subprocess
import sys
from pathlib import Path
from time import monotonic, sleep

import pytest

from stepaside.cli.main import main
from stepaside.core.errors import ConfigurationError
from stepaside.drivers.row_file import RowWriter, read_rows
from stepaside.perception.measurement import Sighting

from velocity_fakes import SimulatedUnicycle  # isort: skip

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
        ("play --role evader --robot nao:x", "rcss:, or be FILE.py:CLASS"),
        ("play --role evader --robot ros2:/na-o", "namespace must be"),
        ("play --role evader --robot naoqi:x:0", "naoqi:tcp://HOST:PORT"),
        (
            "play --role evader --robot lola:E --interface velocity",
            "--interface requires",
        ),
        (
            "play --role evader --robot ros2:/e --interface footsteps",
            "--interface requires",
        ),
        (
            "play --robot ros2:/e --max-lateral 0.3 --max-speed 0.4",
            "--max-lateral requires --max-speed and --max-turn",
        ),
        (
            "play --robot naoqi:tcp://127.0.0.1:1 --max-lateral 0.3",
            "requires a robot at ros2:",
        ),
        ("serve", "--lola PLAYER=ADDRESS or --naoqi"),
        (
            "serve --ros2 evader",
            "pursuer or evader=/NAMESPACE",
        ),
        ("serve --ros2 evader=/e --ros2 evader=/f", "each player once"),
        ("serve --lola evader=E --ros2 evader=/f", "each player once"),
        ("serve --naoqi referee=127.0.0.1:5", "each player once"),
        ("serve --naoqi-joints evader", "tcp://HOST:PORT, each player once"),
        (
            "serve --naoqi evader=a:1 --naoqi-joints evader=b:1",
            "each player once",
        ),
        ("serve --naoqi evader=127.0.0.1:0", "naoqi:tcp://HOST:PORT"),
    ],
)
def test_errors_are_reported_in_one_line(
    words: str, said: str, capsys: pytest.CaptureFixture[str]
) -> None:
    pytest.importorskip("cyclonedds")
    assert said in refused(capsys, *words.split())


def test_naoqi_is_not_played_in_lock_step(
    capsys: pytest.CaptureFixture[str],
) -> None:
    pytest.importorskip("qi")
    words = "serve --naoqi evader=127.0.0.1:29777 --lockstep".split()
    assert "lock step" in refused(capsys, *words)


def test_a_robot_on_naoqi_that_is_not_there_is_said(
    capsys: pytest.CaptureFixture[str],
) -> None:
    pytest.importorskip("qi")
    line = "play --role evader --robot naoqi:127.0.0.1:1 --dry-run --wait 0"
    words = line.split()
    assert "no robot answers" in refused(capsys, *words)
    assert "no robot answers" in refused(
        capsys, *words, "--interface", "joints"
    )


LOCALHOST = "ROS_AUTOMATIC_DISCOVERY_RANGE=LOCALHOST"


@pytest.mark.parametrize(
    "words",
    [
        "serve --ros2 evader=/alone",
        "play --role evader --robot ros2:/alone",
        "play --role evader --robot ros2:/alone --dry-run",
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


@pytest.mark.parametrize("way", ["velocity", "footsteps"])
def test_the_guardian_stops_the_robot_when_play_is_killed(
    way: str, tmp_path: Path
) -> None:
    """The guardian calls in a session of its own; the log can be read."""
    pytest.importorskip("qi")
    from stepaside.drivers.naoqi.naoqi_server import NaoqiServer
    from stepaside.drivers.velocity.velocity_body import REST, VelocityCommand

    walker = SimulatedUnicycle()
    url = "tcp://127.0.0.1:0"
    server = NaoqiServer(
        url, walker, ["a", "b"], VelocityCommand(1, 1), tick=TICK
    )
    log = tmp_path / "log"
    robot = f"naoqi:{server.url}"
    words = ["play", "--role", "pursuer", "--robot", robot, "--interface", way]
    process = subprocess.Popen(
        [sys.executable, "-c", PLAY, *words, "--record", str(log)],
        stderr=subprocess.DEVNULL,
    )

    def tick() -> bool:
        """Let the world go on without ``act``, which watches over it."""
        walker.time += TICK
        walker.sighting = Sighting(walker.time, 0.3, 2.0)
        server.speak()
        sleep(0.005)
        return server.robot.asked != REST or bool(server.robot.steps)

    def wait(moves: bool) -> None:
        end = monotonic() + 30.0
        while tick() != moves:
            assert monotonic() < end

    try:
        wait(moves=True)
        walked = monotonic()
        while monotonic() < walked + 1.0:  # the log reaches the disk
            tick()
        assert tick()  # before the kill: the guardian may react at once
        process.kill()
        process.wait(20.0)
        wait(moves=False)
    finally:
        process.kill()
        process.wait(20.0)
        server.close()
    rows = read_rows(log)
    assert rows["velocity"].max() > 0.0
    assert json.loads((log / "play.json").read_text())["role"] == "pursuer"


def test_rows_keep_their_columns(tmp_path: Path) -> None:
    with pytest.raises(ConfigurationError, match="no rows in"):
        read_rows(tmp_path)
    rows = RowWriter(tmp_path)
    rows.add({"a": 1.0})
    with pytest.raises(ValueError, match="must be {'a': 1}"):
        rows.add({"b": 1.0})
    rows.close()
    assert read_rows(tmp_path)["a"].tolist() == [1.0]
    with pytest.raises(ConfigurationError, match="must be empty"):
        RowWriter(tmp_path)
