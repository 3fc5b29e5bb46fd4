"""Check our LoLA client against a robot's side that we did not write.

The peer is the controller of github.com/Bembelbots/WebotsLoLaController
(Apache-2.0), unmodified. Fetch it yourself; nothing of it is kept here:

    git clone https://github.com/Bembelbots/WebotsLoLaController /tmp/peer
    python tools/checks/lola_peer.py /tmp/peer

It needs opencv-python and this package with msgpack. Webots itself is
not needed: this file stands in for its ``controller`` module, with motors
that reach their targets at once, and a user who presses C, the
chest button, when our client is ready. Prints what happened, as JSON;
``tools/checks/README.md`` holds what came out.
"""

import argparse
import json
import math
import os
import runpy
import subprocess
import sys
import tempfile
import time
import types
from pathlib import Path
from typing import Any

CONTROLLER = Path("controllers/nao_lola_python/nao_lola_python.py")
TICK = 0.012
WALKED = 250  # ticks of moving by control
SWING = 0.2  # of the head, in [rad]


class Device:
    """Any device of Webots: what was set is what is measured."""

    def __init__(self, name: str) -> None:
        """Begin at rest."""
        self.name = name
        self.angle = 0.0

    def enable(self, *_: Any) -> None:
        """Nothing to do."""

    def set(self, *_: Any) -> None:
        """Light up, unseen."""

    def setPosition(self, angle: float) -> None:  # noqa: N802
        """Be there."""
        self.angle = angle

    def getMaxPosition(self) -> float:  # noqa: N802
        """Of a finger."""
        return 1.0

    def getMinPosition(self) -> float:  # noqa: N802
        """Of a finger."""
        return 0.0

    def getValues(self) -> list[float]:  # noqa: N802
        """Of accelerometer, gyro and foot: upright, and at rest."""
        if self.name == "accelerometer":
            return [0.0, 0.0, -9.81]
        return [0.0, 0.0, 26.0 if self.name.endswith("Fsr") else 0.0]

    def getRollPitchYaw(self) -> list[float]:  # noqa: N802
        """Upright."""
        return [0.0, 0.0, 0.0]


class Sensor(Device):
    """Sensor of a motor or of anything else."""

    def __init__(self, name: str, motor: Device | None) -> None:
        """Watch a motor."""
        super().__init__(name)
        self._motor = motor

    def getValue(self) -> float:  # noqa: N802
        """Angle of the motor, or nothing."""
        return 0.0 if self._motor is None else self._motor.angle


class Robot:
    """Webots' robot, without Webots."""

    def __init__(self) -> None:
        """Own no device yet."""
        self._devices: dict[str, Device] = {}
        self._ticks = 0
        self._due = time.monotonic()

    def getBasicTimeStep(self) -> float:  # noqa: N802
        """LoLA's cycle, in [ms]."""
        return 12.0

    def getDevice(self, name: str) -> Device:  # noqa: N802
        """Any device that is asked for."""
        if name not in self._devices:
            motor = self._devices.get(name.removesuffix("S"))
            if name.endswith("S"):
                motor = self.getDevice(name.removesuffix("S"))
            sensed = motor is not None or "/" in name
            self._devices[name] = (
                Sensor(name, motor) if sensed else Device(name)
            )
        return self._devices[name]

    def getKeyboard(self) -> "Robot":  # noqa: N802
        """User at the keyboard."""
        return self

    def enable(self, *_: Any) -> None:
        """Nothing to do."""

    def getKey(self) -> int:  # noqa: N802
        """Press C when a file says so."""
        return ord("C") if Path(os.environ["CHEST"]).exists() else -1

    def stepBegin(self, *_: Any) -> int:  # noqa: N802
        """Advance the clock."""
        self._due = max(self._due + TICK, time.monotonic() - TICK)
        time.sleep(max(0.0, self._due - time.monotonic()))
        return 0

    def stepEnd(self) -> int:  # noqa: N802
        """Go on."""
        return 0


def be_the_robot(checkout: Path, listen: str) -> None:
    """Run the peer as it is, with a stand-in for Webots."""
    module: Any = types.ModuleType("controller")
    module.Robot, module.Keyboard = Robot, object

    class Colours:
        def __getattr__(self, name: str) -> str:
            return ""

    module.AnsiCodes = Colours()
    sys.modules["controller"] = module
    sys.path.insert(0, str((checkout / CONTROLLER).parent))
    sys.argv = [str(CONTROLLER), "--no-camera", "--listen=", listen]
    runpy.run_path(str(checkout / CONTROLLER), run_name="__main__")


class HeadSwing:
    """Control that swings the head, from a stance of straight joints."""

    sighting = begun = state = maneuvers = None
    pose = (0.0, 0.0, 0.0)

    def __init__(self, motors: Any) -> None:
        """Begin at rest."""
        import numpy as np

        from stepaside.locomotion.locomotion import Phase

        self.decisions = self.locomotion = self
        self.joint_targets = np.clip(0.0, motors.low + 0.02, motors.high)
        self.phase, self._head = Phase.STANDING, motors.names.index("HeadYaw")
        self.walked = 0
        self.errors: list[float] = []
        self._asked = [0.0]

    def adopt(self, strategy: Any) -> None:
        """Stand already."""

    def update(self, measured: Any) -> Any:
        """Move the head; an answer acts on this report or on the next."""
        angle = measured.joint_positions[self._head]
        if self.walked > 2:
            self.errors.append(min(abs(angle - each) for each in self._asked))
        self.walked += 1
        targets = self.joint_targets.copy()
        targets[self._head] = SWING * math.sin(0.05 * self.walked)
        self._asked = [*self._asked[-2:], float(targets[self._head])]
        return targets


def play_against(listen: str, chest: Path) -> dict[str, Any]:
    """Stand up, be pressed, move the head by control, rest."""
    from stepaside.drivers.joint_loop import JointLoop
    from stepaside.drivers.joint_motion import motors_of
    from stepaside.drivers.lola import LolaRobot
    from stepaside.drivers.robot_session import RobotSession
    from stepaside.drivers.safety import SafetyState
    from stepaside.robots.description import load_robot
    from stepaside.strategies import Pursuit

    robot = LolaRobot(listen)
    motors = motors_of(robot, load_robot("nao"))
    swing: Any = HeadSwing(motors)
    loop = JointLoop(
        lambda: RobotSession(robot), motors, Pursuit(), lambda _: swing
    )
    states: list[str] = []
    began, frames, stood = time.monotonic(), 0, 0
    while not loop.ended:
        tick = loop.tick()
        frames += 1
        if not states or states[-1] != tick.state.value:
            states.append(tick.state.value)
        if tick.state is SafetyState.READY:
            stood += 1  # press for ten ticks; the button acts when let go
            if stood == 10:
                chest.touch()
            elif stood == 20:
                chest.unlink()
        if swing.walked == WALKED:
            loop.leave("the check is over")
    rate = frames / (time.monotonic() - began)
    force: Any = tick.row["accelerometer"]
    loop.close()
    return {
        "states": states,
        "frames": frames,
        "refused": loop.refused,
        "rate_hz": round(rate, 1),
        "head_error_rad": max(swing.errors),
        "upright": float(force[2]) > 9.0,
    }


def main() -> None:
    """Run both sides."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("checkout", type=Path)
    parser.add_argument("--robot", help=argparse.SUPPRESS)
    options = parser.parse_args()
    if options.robot:
        be_the_robot(options.checkout.resolve(), options.robot)
        return
    if not (options.checkout / CONTROLLER).is_file():
        parser.error(f"{options.checkout} holds no {CONTROLLER}")
    with tempfile.TemporaryDirectory() as folder:
        listen, chest = f"{folder}/robot", Path(folder) / "pressed"
        peer = subprocess.Popen(
            [
                sys.executable,
                "-u",
                __file__,
                options.checkout,
                "--robot",
                listen,
            ],
            env=os.environ | {"CHEST": str(chest)},
            stdout=subprocess.PIPE,
            text=True,
        )
        assert peer.stdout is not None
        try:
            while "LoLa controller listening" not in peer.stdout.readline():
                if peer.poll() is not None:
                    raise SystemExit("the peer did not start")
            print(json.dumps(play_against(listen, chest), indent=1))
        finally:
            peer.kill()
            peer.wait()


if __name__ == "__main__":
    main()
