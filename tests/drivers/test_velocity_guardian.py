"""Test that a robot rests when the process that drove it cannot say so."""

import os
import signal
import subprocess
import sys
from pathlib import Path
from time import monotonic, sleep

import pytest

from stepaside.drivers.guardian_process import SessionLost
from stepaside.drivers.velocity.velocity_body import REST, VelocityCommand
from stepaside.drivers.velocity.velocity_guardian import (
    GuardedBody,
    fork_velocity_guardian,
)

from velocity_fakes import FakeWalker  # isort: skip

# Control whose robot rests by writing a file.
CONTROL = """
import sys, time
from pathlib import Path
from stepaside.drivers.velocity.velocity_guardian import fork_velocity_guardian
guardian = fork_velocity_guardian(lambda: Path(sys.argv[1]).touch)
tell = guardian.hold if sys.argv[2] == "moves" else guardian.leave
for _ in range(10):
    tell()
    time.sleep(0.01)
print("told", flush=True)
if sys.argv[3] == "leaves":
    guardian.dismiss()
    sys.exit()
while sys.argv[3] != "freezes":
    tell()
    time.sleep(0.01)
time.sleep(60.0)
"""


def appears(file: Path, longest: float) -> bool:
    end = monotonic() + longest
    while not file.exists() and monotonic() < end:
        sleep(0.01)
    return file.exists()


@pytest.mark.parametrize(
    ("what", "fate", "rests"),
    [
        ("moves", "dies", True),
        ("moves", "freezes", True),
        ("rests", "dies", False),
        ("moves", "leaves", False),
    ],
)
def test_a_robot_that_moves_is_stopped_when_control_is_gone(
    what: str, fate: str, rests: bool, tmp_path: Path
) -> None:
    word = tmp_path / "rest"
    process = subprocess.Popen(
        [sys.executable, "-c", CONTROL, str(word), what, fate],
        stdout=subprocess.PIPE,
    )
    assert process.stdout is not None
    try:
        process.stdout.readline()
        if fate == "dies":
            process.kill()
        assert appears(word, 20.0 if rests else 0.8) == rests
        if fate != "leaves":
            process.wait(20.0) if rests or fate == "dies" else None
    finally:
        process.kill()
        process.wait(20.0)
        process.stdout.close()
    if fate == "freezes":
        assert process.returncode == -signal.SIGKILL


# Control whose guardian notes when it joined, and fails to do so at first.
JOINING = """
import sys, time
from pathlib import Path
from stepaside.drivers.guardian_process import SessionLost
from stepaside.drivers.velocity.velocity_guardian import fork_velocity_guardian
folder = Path(sys.argv[1])
def join():
    late = (folder / "tried").exists()
    (folder / "tried").touch()
    if sys.argv[2] == "late" and not late:
        raise SessionLost("no robot yet")
    (folder / "joined").touch()
    return (folder / "rest").touch
guardian = fork_velocity_guardian(join)
print("forked", flush=True)
sys.stdin.readline()
guardian.hold()
print("holds", flush=True)
time.sleep(60.0)
"""


@pytest.mark.parametrize("when", ["at once", "late"])
def test_a_guardian_joins_before_it_is_needed_or_tries_again(
    when: str, tmp_path: Path
) -> None:
    process = subprocess.Popen(
        [sys.executable, "-c", JOINING, str(tmp_path), when],
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
    )
    assert process.stdin is not None and process.stdout is not None
    try:
        process.stdout.readline()
        assert appears(tmp_path / "tried", 20.0)
        early = appears(tmp_path / "joined", 20.0 if when != "late" else 0.5)
        assert early == (when == "at once")
        assert not (tmp_path / "rest").exists()
        process.stdin.write(b"\n")
        process.stdin.flush()
        process.stdout.readline()
        process.kill()
        assert appears(tmp_path / "rest", 20.0)
        assert (tmp_path / "joined").exists()
    finally:
        process.kill()
        process.wait(20.0)
        process.stdout.close()
        process.stdin.close()


def test_a_guarded_robot_receives_the_same_commands(tmp_path: Path) -> None:
    robot = FakeWalker([])
    guardian = fork_velocity_guardian(lambda: (tmp_path / "rest").touch)
    body = GuardedBody(robot, guardian)
    body.command(VelocityCommand(0.1, 0.2))
    assert body.listen(0.0) is None
    body.command(REST)
    body.close()
    assert robot.asked == [VelocityCommand(0.1, 0.2), REST]
    assert not (tmp_path / "rest").exists()
    with pytest.raises(ChildProcessError):
        os.waitpid(guardian.pid, os.WNOHANG)


class UnstoppableRobot(FakeWalker):
    """Robot that control cannot stop."""

    def close(self) -> None:
        """Fail."""
        raise SessionLost("stop() did not return")


def test_the_guardian_stops_a_robot_that_control_cannot_stop(
    tmp_path: Path, caplog: pytest.LogCaptureFixture
) -> None:
    """Also one that was commanded zero; control goes on."""
    guardian = fork_velocity_guardian(lambda: (tmp_path / "rest").touch)
    body = GuardedBody(UnstoppableRobot([]), guardian)
    body.command(VelocityCommand(0.1, 0.2))
    body.command(REST)
    assert not (tmp_path / "rest").exists()
    body.close()
    assert (tmp_path / "rest").exists()
    assert "stop() did not return; the guardian stops" in caplog.text
    with pytest.raises(ChildProcessError):
        os.waitpid(guardian.pid, os.WNOHANG)
