"""Test that a robot rests when the process that drove it cannot say so."""

import signal
import subprocess
import sys
from pathlib import Path
from time import monotonic, sleep

import pytest

# Control whose robot rests by writing a file.
CONTROL = """
import sys, time
from pathlib import Path
from stepaside.drivers.guardian_process import Guardian
silence = 0.5 if sys.argv[3] == "freezes" else 60.0
guardian = Guardian(lambda: Path(sys.argv[1]).touch, silence)
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
        assert appears(word, 60.0 if rests else 0.3) == rests
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
from stepaside.drivers.guardian_process import Guardian
from stepaside.drivers.method_thread import SessionLost
folder = Path(sys.argv[1])
def join():
    late = (folder / "tried").exists()
    (folder / "tried").touch()
    if sys.argv[2] == "late" and not late:
        raise SessionLost("no robot yet")
    (folder / "joined").touch()
    return (folder / "rest").touch
guardian = Guardian(join, 0.5)
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
