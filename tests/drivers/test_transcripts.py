"""Test that plays of ``tests/data/plays.toml`` go as those that are stored."""

import tomllib
from collections.abc import Iterator
from typing import Any

import numpy as np
import pytest

from joint_fakes import STANCE, TICK, FakeRobot, FakeSession, Game, status
from stepaside.core.errors import ReachError, StrategyError
from stepaside.drivers.method_thread import SessionLost
from stepaside.drivers.play_log import PlayTick
from stepaside.drivers.robot import REST, CameraImage, VelocityLimits
from stepaside.drivers.velocity_loop import TemplateController, VelocityLoop
from stepaside.drivers.watchdog import Watchdog
from stepaside.locomotion.locomotion import Phase
from stepaside.perception.images import LidarScan
from stepaside.perception.measurement import RobotState, Sighting
from stepaside.planning import GaitSettings
from stepaside.strategies import Pursuit
from stored_values import DATA, compare_stored, summed

from velocity_fakes import PERIOD, FakeWalker, report  # isort: skip

PLAYS = tomllib.loads((DATA / "plays.toml").read_text())
MEASURED = "tilt gyro accelerometer foot_forces joint_velocities".split()
LEAVING = 150  # ticks after the begin of a walk


class Script(dict[str, Any]):
    """Entries of a play at a share of its time, from 0 to 1."""

    share = 0.0

    def at(self, name: str, default: Any = 0.0) -> Any:
        """Return a value between two, as an array if they are."""
        low, high = self.get(name, (default, default))
        value = np.array(low) + self.share * np.subtract(high, low)
        return value if value.ndim else float(value)

    def within(self, name: str) -> bool:
        """Return whether this is the time of an entry."""
        low, high = self.get(name, (2.0, 2.0))
        return bool(low < self.share < high)

    def after(self, name: str) -> bool:
        """Return whether an entry has begun."""
        return bool(self.share > self.get(name, 2.0))

    def parts(self, prefix: str, names: Any) -> dict[str, Any]:
        """Return the values of some fields."""
        known = {name: prefix + name for name in names}
        return {n: self.at(path) for n, path in known.items() if path in self}

    def sighting(self, now: float) -> Sighting | None:
        """Return the sighting of a report."""
        if self.after("seen") or self.within("unseen"):
            return None
        taken = now - self.at("age")
        return Sighting(
            taken, self.at("bearing", 0.4), self.at("distance", 0.7)
        )


def reported(script: Script, game: Game) -> None:
    """Change the next report, and what is beside it."""
    session, scheme = game.session, game.schemes[-1]
    now = session.time + TICK
    told = script.parts("status.", status()._fields)
    for name in ("stiffness", "temperature", "heat", "current"):
        told = told | {name: np.full(4, told[name])} if name in told else told
    told["pressed"] = (script.share % 0.2 < 0.04) and "pressed" in script
    session.changes |= script.parts("", MEASURED) | {
        "status": status(**told) if script.get("button", True) else None,
        "sighting": script.sighting(now),
        "hindrance": "tired" * script.within("hindrance"),
    }
    if "scan" in script:
        taken = LidarScan(now - script.at("scan"), np.zeros((0, 3)))
        session.changes["percepts"] = (taken,)
    if "away" in script:
        session.angles = session.angles + script.at("away") ** 2
    if script.after("nan_forces"):
        session.changes["foot_forces"] = np.full(8, np.nan)
    session.now += script.at("gap") + script.at("now")
    session.time += script.at("gap")
    session.hold = "released" * script.within("hold")
    if "learned" in script:
        scheme.maneuvers = None
    if script.after("fall"):
        scheme.phase = Phase.FALLEN
    slips = ReachError("too short") if script.after("slip") else None
    scheme.fails = StrategyError("why") if script.after("doubt") else slips


def of_ticks(ticks: list[PlayTick]) -> Iterator[str | float]:
    """Yield when states change and how, and sums over all ticks."""
    before: Any = None
    for number, tick in enumerate(ticks):
        if tick.state is not before:
            yield from (float(number), tick.words)
        before = tick.state
    rows = [(t.time, t.sighting, t.row, t.walked) for t in ticks]
    yield from [*summed(rows)][1:]


class Eyes:
    """Camera with an image at every other tick; at first it has none."""

    def __init__(self, script: Script) -> None:
        self.script, self.taken = script, 0
        if "no_camera" in script:
            raise SessionLost("no camera")

    @property
    def hindrance(self) -> str:
        """Why there is no sighting."""
        return "" if self.script.share else "no image yet"

    def take(self, now: float) -> CameraImage | None:
        """Return a new image."""
        self.taken += 1
        pixels = np.full((2, 4, 3), self.taken % 99, np.uint8)
        image = CameraImage(now - 0.02, pixels, 5.0, 7.0)
        return image if self.taken % 2 else None

    def see(self, report: RobotState) -> RobotState:
        """Replace the sighting."""
        return report._replace(sighting=Sighting(report.time, 0.1, 0.9))

    def close(self) -> None:
        """Note it."""
        self.script["closed"] = True


def of_joints(script: Script) -> Iterator[str | float]:
    """Play until the robot is released; yield changes, then all commands."""
    how = script.get("how", {})
    traits = {k: v for k, v in how.items() if hasattr(FakeRobot, k)}
    options: dict[str, Any] = {
        k: np.array(v) for k, v in how.items() if k not in traits
    }
    session, ticks, shown, given_up = FakeSession(**traits), [], [], ""
    if "eyes" in script:
        options["open_eyes"] = lambda robot: Eyes(script)
    try:
        game = Game(session, **options)
    except SessionLost as error:
        yield from (str(error), float(session.closed))
        return
    session.robot.show = lambda state, *, sees: shown.append((state, sees))
    for i in range(-70, 1200):
        script.share = min(max(0.01 * i, 0.0), 1.0)
        reported(script, game)
        if (told := session.changes["status"]) is not None and i == -10:
            session.changes["status"] = told._replace(pressed=True)
        if i == script.get("leaves", LEAVING):
            game.loop.leave("asked")
        wanted = STANCE + 0.3 * np.sin(0.2 * i) * (i > 0)
        wanted[2] = np.nan if script.after("nan") else wanted[2]
        try:
            ticks.append(game.play(1, wanted))
        except SessionLost as error:
            yield str(error)
            break
        given_up = given_up or game.loop.given_up
        if game.loop.ended:
            break
    game.loop.close()
    assert session.closed and session.sent[-1] is None, "it must end limp"
    commands = [each for each in session.sent if each is not None]
    assert all(np.isfinite(each.angles).all() for each in commands)
    yield from (given_up, float(session.closed), str(script.get("closed")))
    yield str([(state.value, sees) for state, sees in shown])
    yield from of_ticks(ticks)
    for each in session.sent, [s.read for s in game.schemes]:
        yield from [*summed(each)][1:]


class Walker(FakeWalker):
    """Robot with a switch."""

    hold, closed = "", False

    def close(self) -> None:
        """Note it."""
        self.closed = True

    def released(self) -> str:
        """Return the reason of the switch."""
        return self.hold


def of_velocities(script: Script) -> Iterator[str | float]:
    """Play for a time; yield changes, then all commands."""

    def reports() -> Iterator[Any]:
        for i in range(400):
            time, now = PERIOD * i + script.at("time"), PERIOD * i
            x = script.at("x") * script.share + 1e-6 * (now % 1.0)
            pose = {"x": x if "x" not in script or script["x"][1] else 0.0}
            pose["theta"] = script.at("theta") * script.share
            told = report(time)
            yield (
                None
                if script.within("silent")
                else told._replace(
                    pose=told.pose._replace(**pose),
                    sighting=script.sighting(time),
                    hindrance="tired" * script.within("hindrance"),
                )
            )

    robot, ticks, controllers = Walker(reports()), [], []

    def controller() -> TemplateController:
        controllers.append(1.0)
        return TemplateController(Pursuit(), GaitSettings())

    eyes: Any = Eyes(script) if "eyes" in script else None
    loop = VelocityLoop(
        robot,  # type: ignore[arg-type]
        controller,
        VelocityLimits(),
        watchdog=Watchdog(paced=script.get("paced", True)),
        eyes=eyes,
        clock=robot.clock,
        pause=robot.pause,
    )
    for i in range(400):
        script.share = min(max(0.01 * (i - 20), 0.0), 1.0)
        robot.hold = "released" * script.within("hold")
        if script.after("leaves"):
            loop.leave("asked")
        try:
            ticks.append(loop.tick())
        except SessionLost as error:
            yield str(error)
            break
        if loop.ended:
            break
    loop.close()
    assert robot.closed and (robot.asked[-1] == REST or not loop.ended)
    yield from (sum(controllers), str((robot.closed, script.get("closed"))))
    yield from of_ticks(ticks)
    yield from [*summed(robot.asked)][1:]


@pytest.mark.parametrize(
    ("kind", "name"), [(kind, n) for kind, each in PLAYS.items() for n in each]
)
def test_a_play_goes_as_stored(kind: str, name: str) -> None:
    play = of_joints if kind == "joints" else of_velocities
    found = play(Script(PLAYS[kind][name]))
    compare_stored("plays.json", f"{kind}, {name}", found, 1e-5)
