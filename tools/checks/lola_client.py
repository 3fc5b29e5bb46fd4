"""Check our simulated robot against LoLA clients that we did not write.

The peer is the Python client of Berlin United's robots, as it stands in
github.com/coders-group-eu/nao_logs (no licence is stated), unmodified, and a
program on top of it that walks in open loop. Fetch it yourself; nothing of
it is kept here:

    git clone https://github.com/coders-group-eu/nao_logs /tmp/peer
    python tools/checks/lola_client.py /tmp/peer

It needs this package with msgpack, and ``/tmp/robocup`` for itself,
which is the only place where that client looks for a robot. The world runs
in lock step, so a machine may be busy, and the client's clock is told by the
frames. Prints what happened, as JSON; ``tools/checks/README.md`` holds what
came out.
"""

import argparse
import json
import os
import runpy
import subprocess
import sys
import tempfile
from importlib import import_module
from math import sin
from pathlib import Path
from time import sleep
from typing import Any

CLIENT = Path("coders_logs/lola-scripts")
SCRIPTS = Path("coders_logs/Scripts")
SOCKET = "/tmp/robocup"  # written into the client
TICK = 0.012  # of LoLA, in [s]
SWING = 0.5  # of the head, in [rad]
HOLD = "hold"  # our program on their client: stand, and swing the head
PROGRAMS = (HOLD, "move_head", "walking_official", "walking_stable")
DURATION = 10.0  # of a game, in [s]
WAIT = 20.0  # of the world for who leaves the legs limp, in [s]


def be_the_client(checkout: Path, program: str, told: Path) -> None:
    """Run a program on the unmodified client, except for its clock.

    Args:
        checkout: Checkout of the peer.
        program: Key of ``PROGRAMS``.
        told: File for the observations.
    """
    sys.path.insert(0, str(checkout / CLIENT))
    peer: Any = import_module("Nao")
    heads: list[tuple[float, float]] = []
    seen: dict[str, Any] = {"frames": 0}

    class Watched(peer.Nao):  # type: ignore[misc]
        """LoLA client that counts frames as its clock."""

        def getTime(self) -> float:  # noqa: N802
            """Return the time of the frames, in [s]."""
            return TICK * seen["frames"]

        def update(self) -> bool:
            """Exchange a frame, and record both directions."""
            asked = self.jointMotorData["HeadYaw"]
            going: bool = super().update()
            seen["frames"] += 1
            seen["upward_m_s2"] = self.accelerometerData[2]
            seen["tilt_rad"] = self.imuData[:2]
            heads.append((asked, self.jointSensorData["HeadYaw"]))
            return going

    peer.Nao = Watched
    try:
        if program == HOLD:
            _hold(Watched())
        else:
            script = checkout / SCRIPTS / f"{program}.py"
            runpy.run_path(str(script), run_name="__main__")
    except (ValueError, OSError) as error:
        seen["ended"] = f"{type(error).__name__}: {error}"
    seen["head_asked_rad"] = max(abs(asked) for asked, _ in heads)
    seen["head_seen_rad"] = max(abs(angle) for _, angle in heads)
    told.write_text(json.dumps(seen), encoding="utf-8")


def _hold(nao: Any) -> None:
    """Hold the current posture, and swing the head."""
    for name in nao.joint_names:
        nao.jointMotorData[name] = nao.jointSensorData[name]
    while nao.update():
        nao.jointMotorData["HeadYaw"] = SWING * sin(nao.getTime())


def serve(folder: Path) -> "subprocess.Popen[str]":
    """Serve a duel whose evader is the client's robot."""
    words = ["serve", f"--lola=evader={SOCKET}", "--lockstep", "--sight=none"]
    words += [f"--duration={DURATION:g}", "--distance=3", "--json"]
    words += [f"--output={folder / 'run'}", f"--wait={WAIT:g}"]
    return subprocess.Popen(
        [sys.executable, "-m", "stepaside", *words],
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
    )


def tried(checkout: Path, program: str) -> dict[str, Any]:
    """Outcome of one program."""
    from stepaside.games.run_archive import load_run

    with tempfile.TemporaryDirectory() as place:
        folder = Path(place)
        told = folder / "told.json"
        world = serve(folder)
        while not os.path.exists(SOCKET) and world.poll() is None:
            sleep(0.05)
        client = subprocess.Popen(
            [sys.executable, __file__, checkout, "--be", program, told],
            stdout=subprocess.DEVNULL,
        )
        out, said = world.communicate()
        client.wait(timeout=60.0)
        found: dict[str, Any] = json.loads(told.read_text(encoding="utf-8"))
        if world.returncode:
            found["world"] = said.splitlines()[-1]
            return found
        summary = json.loads(out)
        com = load_run(folder / "run").tracks["evader"].com
        found["outcome"] = f"{summary['outcome']}: {summary['message']}"
        found["unanswered_frames"] = summary["unanswered_frames"]
        found["com_moved_m"] = (com[-1] - com[0]).tolist()
        return found


def main() -> None:
    """Try every program."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("checkout", type=Path)
    parser.add_argument("--be", nargs=2, help=argparse.SUPPRESS)
    options = parser.parse_args()
    checkout = options.checkout.resolve()
    if options.be:
        be_the_client(checkout, options.be[0], Path(options.be[1]))
        return
    if not (checkout / CLIENT / "Nao.py").is_file():
        parser.error(f"{checkout} holds no {CLIENT}/Nao.py")
    if os.path.exists(SOCKET):
        parser.error(f"{SOCKET} is taken")
    results = {program: tried(checkout, program) for program in PROGRAMS}
    print(json.dumps(results, indent=1))


if __name__ == "__main__":
    main()
