"""Test the driver of the RoboCup simulator, with the real one if installed."""

import importlib.util
import socket
import subprocess
import sys
from collections.abc import Iterator
from math import cos, pi, radians, sin
from pathlib import Path
from threading import Thread
from time import monotonic, sleep

import numpy as np
import pytest

from stepaside import load_run
from stepaside.core.errors import ConfigurationError, ModelError
from stepaside.drivers.rcss import (
    MODELS,
    STEP,
    LeagueRobot,
    make_robot,
    nearest_opponent,
    parse_expressions,
)
from stepaside.drivers.robot import JointTargets
from stepaside.drivers.robot_loader import RobotRequest
from stepaside.games.play_settings import PlaySettings
from stored_values import compare_stored, summed, words_of

LONGEST = 60.0  # for what takes seconds on an idle machine, in [s]
STANDING = {
    f"{side}_{name}": angle
    for side in ("Left", "Right")
    for name, angle in (
        *(("Hip_Pitch", -0.2), ("Knee_Pitch", 0.4)),
        ("Ankle_Pitch", -0.2),
    )
} | {"Left_Shoulder_Roll": -1.3, "Right_Shoulder_Roll": 1.3}
SEEN = (
    b"(See (B (pol 3 1 2))(P (team a)(id 1)(head (pol 1 0 0)))"
    b"(P (team b)(id 2)(head (pol 4 10 -5))(lfoot (pol 4.1 11 -20)))"
    b"(P (team b)(id 3)(lfoot (pol 2 -20 -30))(rfoot (pol 2.2 -22 -30))))"
)


def quaternion(roll: float, pitch: float, yaw: float) -> str:
    """A rotation, the real part first."""
    cr, sr, cp, sp, cy, sy = (
        f(0.5 * a) for a in (roll, pitch, yaw) for f in (cos, sin)
    )
    parts = (
        cr * cp * cy + sr * sp * sy,
        sr * cp * cy - cr * sp * sy,
        cr * sp * cy + sr * cp * sy,
        cr * cp * sy - sr * sp * cy,
    )
    return " ".join(map(str, parts))


def message(now: float, head: float = 0.0) -> bytes:
    """A message of the simulator, with angles in degrees."""
    joints = "".join(
        f"(HJ (n q_{motor.replace('e', 'j')})"
        f"(ax {head if motor == 'he1' else 0.5})(vx 90))"
        for motor in MODELS["K1"][0].values()
    )
    return (
        f"(time (now {now}))(GS (t 0) (pm BeforeKickOff))"
        "(GYR (n torso_gyro) (rt 180 0 -90))(ACC (n torso_acc) (a 0 0 9.8))"
        f"(quat (n torso_quat) (q {quaternion(0.2, -0.1, 3.0)}))"
        "(pos (n torso_pos) (p 1 2 0.5))"
        f"{joints}(See (P (team b)(id 1)(head (pol 2 30 0))))"
    ).encode()


class FakeLeague:
    """Server of one agent with messages of a test."""

    def __init__(self) -> None:
        self.listener = socket.create_server(("127.0.0.1", 0))
        self.address = self.listener.getsockname()
        self.received: list[str] = []
        self.messages = [message(0.02 * i) for i in range(200)]
        self.thread = Thread(target=self.serve, daemon=True)
        self.thread.start()

    def serve(self) -> None:
        """Answer each message of the agent with the next one."""
        agent, _ = self.listener.accept()
        with agent, agent.makefile("rb") as stream:
            for answer in self.messages:
                size = int.from_bytes(stream.read(4), "big")
                if not size:
                    return
                self.received.append(stream.read(size).decode())
                agent.sendall(len(answer).to_bytes(4, "big") + answer)


@pytest.mark.parametrize("text", [b"(a", b"(a))", b")"])
def test_unbalanced_messages_are_refused(text: bytes) -> None:
    with pytest.raises(ConnectionError):
        parse_expressions(text)
    assert parse_expressions(b"a (b (c) 1) () d") == [["b", ["c"], "1"]]


def test_the_nearest_player_of_another_team_is_the_opponent() -> None:
    (_, *seen), = parse_expressions(SEEN)  # fmt: skip
    found = nearest_opponent(seen, "a")  # no head in sight: both feet
    assert np.hypot(*found[:2]) == pytest.approx(2.1 * cos(radians(30.0)))
    assert np.arctan2(found[1], found[0]) == pytest.approx(radians(-21.0))
    assert nearest_opponent(seen, "b").tolist() == [1.0, 0.0, 0.0]
    assert nearest_opponent(seen[:1], "a") is None


@pytest.mark.parametrize("address", ["", "h", "h:0", "h:70000", "h:p"])
def test_an_invalid_address_is_refused(address: str) -> None:
    with pytest.raises(ConfigurationError, match="rcss:HOST:PORT"):
        make_robot(RobotRequest(address))


def test_the_model_follows_from_the_joints() -> None:
    with pytest.raises(ModelError, match="K1 and T1, got .* HeadYaw"):
        make_robot(RobotRequest(":60000"))


def test_messages_become_reports_and_commands_motors() -> None:
    league = FakeLeague()
    robot = LeagueRobot(league.address, "K1", "a", STANDING)
    robot.open()
    assert league.received[0] == "(init K1 a 1)"
    assert league.received[1].startswith("(beam -2 3 0)")
    report, knee = robot.listen(), robot.joints.index("Left_Knee_Pitch")
    assert report.gyro == pytest.approx((pi, 0.0, -0.5 * pi))
    assert report.joint_velocities is not None
    assert report.joint_velocities[knee] == pytest.approx(0.5 * pi)
    assert report.joint_positions[knee] == pytest.approx(radians(0.5))
    assert report.tilt == pytest.approx((0.2, -0.1), abs=1e-6)
    assert report.time / STEP == pytest.approx(round(report.time / STEP))
    seen = report.sighting
    assert seen is not None  # 2 m from the camera, 0.066 m ahead of the torso
    assert seen.bearing == pytest.approx(radians(30.0), abs=0.05)
    values = np.outer((0.1, 80.0, 2.0), np.ones(len(robot.joints)))
    robot.command(JointTargets(*values))
    robot.listen()
    sent = league.received[-1]
    assert "(lle4 5.7296 0 80.0000 2.0000 0)" in sent
    assert sent.endswith("(syn)") and sent.count("(") == 23
    head = parse_expressions(sent.encode())[0]
    assert head[0] == "he1"  # the head turns toward the opponent
    assert float(head[1]) == pytest.approx(np.degrees(seen.bearing), abs=0.01)
    robot.listen()
    assert league.received[-1] == "(syn)"  # nothing was commanded
    reports = [robot.listen() for _ in range(3)]
    robot.close()
    text = " ".join([*league.received[:5], *league.received[-6:]])
    found = [*words_of(text), float(len(league.received))]
    compare_stored("plays.json", "league", [*found, *summed(reports)])


@pytest.fixture
def league(tmp_path: Path) -> Iterator[str]:
    """Address of the real simulator."""
    if importlib.util.find_spec("rcsssmj") is None:
        pytest.skip("rcsssmj is not installed")
    with socket.create_server(("127.0.0.1", 0)) as free:
        port = free.getsockname()[1]
    words = "--sync --no-realtime --no-render --host 127.0.0.1".split()
    ports = ["--aport", str(port), "--mport", str(port - 1)]
    server = subprocess.Popen(
        [sys.executable, "-m", "rcsssmj", *words, *ports],
        cwd=tmp_path,
        stderr=subprocess.DEVNULL,
    )
    deadline = monotonic() + LONGEST
    while True:
        try:
            socket.create_connection(("127.0.0.1", port)).close()
            break
        except OSError:
            assert server.poll() is None and monotonic() < deadline
            sleep(0.1)
    yield f"rcss:127.0.0.1:{port}"
    server.kill()
    server.communicate()


@pytest.fixture
def described_k1(tmp_path: Path) -> Path:
    """The simulator's K1, with a network that holds its posture."""
    pytest.importorskip("onnxruntime")
    pytest.importorskip("onnx")
    from rcsssmj import resources

    from small_policies import write_policy
    from stepaside.cli.main import main

    model = Path(next(iter(resources.__path__))) / "robots" / "K1"
    folder = tmp_path / "k1"
    arguments = ["robot", "init", str(model / "robot.xml")]
    arguments += ["--output", str(folder)]
    with pytest.raises(SystemExit) as ended:
        main(arguments)
    assert not ended.value.code
    legs = [name for name, motor in MODELS["K1"][0].items() if "le" in motor]
    contract = {
        "joints": legs,
        "terms": ["base_ang_vel", "projected_gravity", "command"],
        "default_posture": [STANDING.get(name, 0.0) for name in legs],
        "stiffness": 200.0,
        "damping": 5.0,
        "action_scale": 1.0,
    }
    write_policy(
        folder / "stands.onnx",
        np.zeros((len(legs), 9)),
        np.zeros(len(legs)),
        {"stepaside_contract": contract},
    )
    return folder


def test_a_k1_is_played_in_the_real_simulator(
    league: str, described_k1: Path, tmp_path: Path
) -> None:
    """The evader sees its pursuer 4 m ahead, is walked, and recorded."""
    play = "from stepaside.cli.main import main; main()"
    words = [sys.executable, "-c", play, "play", league]
    words += ["--robot", str(described_k1)]
    words += ["--set", f"legs.network={described_k1}/stands.onnx"]
    run = tmp_path / "run"
    pursuer = subprocess.Popen(
        [*words, "--role", "pursuer"], stderr=subprocess.DEVNULL
    )
    try:
        evader = subprocess.run(
            [*words, "--role", "evader", "--set", "evasion.safety_radius=5"]
            + ["--duration", "3", "--record", str(run)],
            stderr=subprocess.PIPE,
            text=True,
            timeout=LONGEST,
            check=False,
        )
    finally:
        pursuer.kill()
        pursuer.communicate()
    assert evader.returncode == 0, evader.stderr
    assert "walking" in evader.stderr
    found = load_run(run)
    assert isinstance(found.settings, PlaySettings)
    assert found.summary.play is not None
    assert found.settings.language == "rcss"
    assert found.summary.play.walking_s == pytest.approx(3.0, abs=0.1)
    closest = found.summary.min_distance_m
    assert closest is not None and 3.5 < closest < 4.5
