r"""Play games from inside and outside the certified set of the shield.

For each robot 1,000 starts of a standing robot from which the shield excludes
contact, and 1,000 from which it does not, at template level, against people
who steer at the robot, feint, or turn at random within their bounds. The
robot's own strategy stands still or walks at random. A robot and a network,
measured by ``robot legs measure``, add a robot on learned legs::

    python tools/benchmarks/shield_map.py --robot runs/g1 --network g1.onnx

A robot without a certified start is reported as such. After Ctrl-C the same
command continues.

Writes ``docs/results/shield-map.json`` for docs/shield.md.
"""

from dataclasses import dataclass
from math import atan2, ceil, cos, pi, sin
from pathlib import Path
from typing import Any

import numpy as np
from benchmark_options import ask, machine
from result_files import header, write_result
from resumable_jobs import Row, finished, gather

from stepaside.core.poses import Pose, wrap_angle
from stepaside.core.random_streams import named_generator
from stepaside.games.floor_games import play_floor
from stepaside.games.floor_world import (
    FloorAgent,
    FloorMotion,
    FloorPoint,
    FloorWalk,
    FloorWorld,
)
from stepaside.games.game import GameRules
from stepaside.games.game_settings import duel
from stepaside.games.people import FloorPerson
from stepaside.locomotion.control_settings import LegsSettings
from stepaside.locomotion.policy.policy_legs import load_legs
from stepaside.planning import Direction, GaitSettings
from stepaside.planning.gait_settings import PRESETS
from stepaside.robots.description import load_robot
from stepaside.strategies import ShieldedStrategy, ShieldSettings
from stepaside.strategies.knowledge import Intent, Knowledge, limits_of
from stepaside.strategies.shield import ShieldModel, shield_model
from stepaside.strategies.velocity_set import BodyVelocity, VelocitySet

MODULES = ("theory/value", "strategies/shield", "games/floor_games")
STEP = 0.04  # of the integration, in [s]; a part of a step
SLOW_STEP = 0.547 / 7  # likewise, for the paper's gait
LEGS_GAIT = GaitSettings(speed=0.5, gain=0.4, stride=0.2)
PEOPLE = ("steers", "feints", "weaves")
BATCH = 25  # games of a job
SEED = 1  # of the starts
DRAWN = 2_000  # starts, of which suitable ones are taken


@dataclass(frozen=True)
class RandomWalk:
    """Strategy that walks at random, for the shield to correct.

    Attributes:
        legs: Whether it decides on body velocities.
        seed: Seed of its decisions.
        begins: Time before which it stands, in [s].
    """

    legs: bool
    seed: int
    begins: float
    direction: Direction = Direction.BACKWARD
    saturated: bool = False

    def begin(self) -> int:
        """Return the number of decisions."""
        return 0

    def decide(self, knowledge: Knowledge, memory: int) -> tuple[Intent, int]:
        """Decide at random; hold a decision for about a second."""
        drawn = np.random.default_rng((self.seed, int(knowledge.time)))
        stands = self.seed % 4 == 0 or knowledge.time < self.begins - 1e-9
        if stands or drawn.random() < 0.3:
            return Intent(speed_factor=0.0), memory + 1
        if self.legs:
            velocity = BodyVelocity(*drawn.uniform(-0.5, 0.5, 3).tolist())
            return Intent(velocity=velocity), memory + 1
        return Intent(float(drawn.uniform(-pi, pi))), memory + 1


class Chaser:
    """Person who chases within a turning rate.

    Attributes:
        pose: Present pose.
    """

    def __init__(
        self,
        kind: str,
        settings: ShieldSettings,
        start: Pose,
        seed: int,
        straight: float,
    ) -> None:
        """Begin at a pose, and walk straight for a time [s]."""
        self.pose, self._kind, self._settings = start, kind, settings
        self._straight = straight
        self._random = np.random.default_rng(seed)
        self._until, self._rate, self._pace = 0.0, 0.0, 1.0

    def advance(
        self, time: float, duration: float, evader: tuple[float, float]
    ) -> None:
        """Walk for a while, towards the robot or as it is drawn."""
        x, y, theta = self.pose
        speed = self._settings.speed
        most = speed / self._settings.turning_radius
        aim = wrap_angle(atan2(evader[1] - y, evader[0] - x) - theta)
        rate = min(max(aim / duration, -most), most)
        if self._kind != "steers":
            if time >= max(self._until, self._straight):
                self._until = time + self._random.uniform(0.2, 1.5)
                feints = self._random.random() < 0.4
                self._rate = np.sign(self._random.normal()) * most
                self._feints = feints
                slow = self._kind == "weaves" and self._random.random() < 0.2
                self._pace = self._random.random() if slow else 1.0
            if time > self._straight + 1e-9 and self._feints:
                rate = float(self._rate)
        if time <= self._straight + 1e-9:
            rate = 0.0
        way, half = self._pace * speed * duration, 0.5 * rate * duration
        way *= float(np.sinc(half / pi))
        self.pose = Pose(
            x + way * cos(theta + half),
            y + way * sin(theta + half),
            wrap_angle(theta + 2.0 * half),
        )


@dataclass(frozen=True)
class MappedRobot:
    """Robot and person of one map.

    Attributes:
        gait: Gait, or template of legs.
        legs: Velocities of the legs; None for the paper's walk.
        shield: Person that is expected.
        duration: Duration of a game, in [s].
        step: Step of the integration, in [s].
    """

    gait: GaitSettings
    legs: VelocitySet | None
    shield: ShieldSettings
    duration: float
    step: float = STEP

    @property
    def model(self) -> ShieldModel:
        """Model of the shield."""
        limits = limits_of(self.gait, self.legs)
        return shield_model(limits, self.shield)


def paper_robots() -> dict[str, MappedRobot]:
    """Return NAO on the paper's legs, and with the fast gait."""
    slow = ShieldSettings(True, 0.09, 6.0, 0.35)
    fast = ShieldSettings(True, 0.35, 8.0, 0.35)
    return {
        "NAO, the paper's gait": MappedRobot(
            GaitSettings(), None, slow, 60.0, SLOW_STEP
        ),
        "NAO, fast gait": MappedRobot(PRESETS["fast"], None, fast, 20.0),
    }


def draw_starts(
    robot: MappedRobot, count: int, *, certified: bool
) -> list[Pose]:
    """Draw poses of a robot at rest in the frame of the person.

    Returns:
        The poses; fewer than asked for where there are few.
    """
    model, table = robot.model, robot.model.table()
    if certified and not model.certifies(table):
        return []
    random = named_generator(SEED, f"starts {certified}")
    x, y, _ = table.grid.axes()
    low, high = [x[0], -y[-1], -pi], [x[-1], y[-1], pi]
    if not certified:  # within the box of unsafe nodes
        unsafe = np.nonzero(table.standing < model.required)
        low[0], high[0] = x[unsafe[0].min()], x[unsafe[0].max()]
        high[1] = y[unsafe[1].max()]
        low[1] = -high[1]
    found: list[Any] = []
    for _ in range(count):
        rows = random.uniform(low, high, (DRAWN, 3))
        safe = table.standing_value(rows) >= model.required
        far = np.hypot(rows[:, 0], rows[:, 1]) > robot.shield.contact + 0.05
        found += rows[far & (safe == certified)].tolist()
        if len(found) >= count:
            break
    return [Pose(*row) for row in found[:count]]


@dataclass(frozen=True)
class GameBatch:
    """Games of one robot.

    Attributes:
        robot: Robot and person.
        starts: Poses of the robot in the frame of the person.
        first: Seed of the first game.
    """

    robot: MappedRobot
    starts: tuple[Pose, ...]
    first: int

    def play(self) -> Row:
        """Return closest approaches [m] by kind of the person."""
        found: Row = {kind: [] for kind in PEOPLE}
        for seed, start in enumerate(self.starts, self.first):
            kind = PEOPLE[seed % len(PEOPLE)]
            found[kind].append(play(self.robot, kind, start, seed))
        return found


def play(robot: MappedRobot, kind: str, start: Pose, seed: int) -> float:
    """Return the closest approach in a game, in [m].

    The person walks straight to the origin before the shield decides.
    """
    straight = robot.step * ceil(robot.model.window / robot.step - 1e-9)
    inner = RandomWalk(robot.legs is not None, seed, straight)
    strategy = ShieldedStrategy(inner, robot.shield)
    person = Pose(-robot.shield.speed * straight, 0.0, 0.0)
    chaser = Chaser(kind, robot.shield, person, seed, straight)
    limits = limits_of(robot.gait, robot.legs)
    pair = duel().identities
    agent = FloorAgent(strategy, limits, pair["evader"], list(pair.values()))
    own: FloorMotion
    if robot.legs is not None:
        own = FloorPoint(agent, start, robot.gait, robot.step)
    else:
        late = robot.gait.start_support
        own = FloorWalk(agent, start, delay=late, alert=robot.step)
    other = FloorPerson(chaser, lambda seen: seen["evader"][:2], robot.step)
    world = FloorWorld({"pursuer": other, "evader": own})
    rules = GameRules(robot.duration, identities=pair)
    game, _ = play_floor(world, rules)
    return game.closest["evader", "pursuer"]


def describe(robot: MappedRobot) -> Row:
    """Return the numbers of a robot's table."""
    model, table = robot.model, robot.model.table()
    x, y, _ = table.grid.axes()
    unsafe = table.standing < model.required
    winnable = model.certifies(table)
    ahead = float(x[unsafe.any(axis=(1, 2))].max())
    aside = float(y[unsafe.any(axis=(0, 2))].max())
    return {
        "person_speed_m_s": robot.shield.speed,
        "turning_radius_m": robot.shield.turning_radius,
        "contact_m": robot.shield.contact,
        "required_m": model.required,
        "loss_m": model.displacement,
        "period_s": model.period,
        "winnable": winnable,
        "start_ahead_m": ahead if winnable else None,
        "start_aside_m": aside if winnable else None,
    }


def batches_of(
    name: str, robot: MappedRobot, count: int
) -> dict[str, GameBatch]:
    """Return the games of a robot by the name of the job."""
    found = {}
    for starts, certified in (("certified", True), ("outside", False)):
        poses = draw_starts(robot, count, certified=certified)
        if len(poses) < count:
            print(f"{name}: {len(poses)} starts {starts} of {count}")
        for i in range(0, len(poses), BATCH):
            some = tuple(poses[i : i + BATCH])
            found[f"{name} {starts} {i}"] = GameBatch(robot, some, i)
    return found


def summary_of(rows: list[Row], contact: float) -> Row:
    """Count games and contacts by kind of the person."""
    found = {}
    for kind in PEOPLE if rows else ():
        values = [value for row in rows for value in row[kind]]
        found[kind] = {
            "games": len(values),
            "contacts": sum(value < contact for value in values),
            "closest_m": min(values),
            "median_m": float(np.median(values)),
        }
    return found


def learned_legs(arguments: Any) -> dict[str, MappedRobot]:
    """Return the robot on learned legs that the command names."""
    if not arguments.network:
        return {}
    network = LegsSettings(arguments.network)
    robot = load_robot(arguments.robot)
    legs = load_legs(network, robot, tick=0.02).velocities
    person = ShieldSettings(
        True, arguments.legs_speed, arguments.legs_radius, 0.45
    )
    name = f"{arguments.robot.name.upper()}, learned legs"
    return {name: MappedRobot(LEGS_GAIT, legs, person, 20.0)}


def main() -> None:
    """Solve, play, and write the results."""
    asked = ask(__doc__, "shield-map.json")
    asked.add_argument("--robot", type=Path)
    asked.add_argument("--network", default="")
    asked.add_argument("--legs-speed", type=float, default=1.0)
    asked.add_argument("--legs-radius", type=float, default=8.0)
    asked.add_argument("--games", type=int, default=1000)
    asked.add_argument("--workers", type=int, default=0)
    arguments = asked.parse_args()
    robots = paper_robots() | learned_legs(arguments)
    head = header({"games": arguments.games})
    batches: dict[str, GameBatch] = {}
    for name, robot in robots.items():
        batches |= batches_of(name, robot, arguments.games)
    rows = gather(
        arguments.output, head, batches, GameBatch.play, arguments.workers
    )
    maps = {}
    for name, robot in robots.items():
        maps[name] = describe(robot)
        for starts in ("certified", "outside"):
            played = [
                row
                for job, row in rows.items()
                if job.startswith(f"{name} {starts} ")
            ]
            maps[name][starts] = summary_of(played, robot.shield.contact)
    write_result(arguments.output, head, machine=machine(), maps=maps)
    finished(arguments.output)


if __name__ == "__main__":
    main()
