r"""Play games from inside and outside the certified set of the shield.

For each robot 1,000 starts of a standing robot from which the shield excludes
contact, and 1,000 from which it does not, at template level, against people
who steer at the robot, feint, or turn at random within their bounds. The
robot's own strategy stands still or walks at random. A robot and a network,
measured by ``legs measure``, add a robot on learned legs::

    python tools/benchmarks/shield_map.py --robot runs/g1 --network g1.onnx

Writes ``docs/results/shield-map.json`` for docs/shield.md.
"""

from collections.abc import Callable
from dataclasses import dataclass
from math import atan2, cos, hypot, pi, sin
from pathlib import Path
from typing import Any

import numpy as np
from benchmark_options import ask, machine
from tqdm import tqdm

from stepaside.core.poses import Pose, wrap_angle
from stepaside.games.template_game import play_point, play_template
from stepaside.locomotion.policy.legs_loader import load_legs
from stepaside.locomotion.policy.legs_settings import LegsSettings
from stepaside.planning import Direction, GaitSettings
from stepaside.planning.gait_settings import PRESETS
from stepaside.robots.description import load_robot
from stepaside.strategies.knowledge import Intent, Knowledge, limits_of
from stepaside.strategies.shield import ShieldedStrategy
from stepaside.strategies.shield_model import ShieldModel
from stepaside.strategies.shield_settings import ShieldSettings
from stepaside.strategies.velocity_set import BodyVelocity, VelocitySet
from stepaside.studies.result_files import header, write_result

MODULES = ("theory/shield", "strategies/shield", "games/template_game")
STEP = 0.04  # of the integration, in [s]
LEGS_GAIT = GaitSettings(speed=0.5, gain=0.4, stride=0.2)
PEOPLE = ("steers", "feints", "weaves")
FARTHEST = 4.0  # of a start, in required distances


@dataclass(frozen=True)
class RandomWalk:
    """Strategy that walks at random, for the shield to correct.

    Attributes:
        legs: Whether it decides on body velocities.
        seed: Seed of its decisions.
    """

    legs: bool
    seed: int
    direction: Direction = Direction.BACKWARD
    saturated: bool = False

    def begin(self) -> int:
        """Return the number of decisions."""
        return 0

    def decide(self, knowledge: Knowledge, memory: int) -> tuple[Intent, int]:
        """Decide at random; hold a decision for about a second."""
        drawn = np.random.default_rng((self.seed, int(knowledge.time)))
        if drawn.random() < 0.3:
            return Intent(moving=False), memory + 1
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
        self, kind: str, settings: ShieldSettings, start: Pose, seed: int
    ) -> None:
        """Begin at a pose."""
        self.pose, self._kind, self._settings = start, kind, settings
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
            if time >= self._until:
                self._until = time + self._random.uniform(0.2, 1.5)
                feints = self._random.random() < 0.4
                self._rate = np.sign(self._random.normal()) * most
                self._feints = feints
                slow = self._kind == "weaves" and self._random.random() < 0.2
                self._pace = self._random.random() if slow else 1.0
            if self._feints:
                rate = float(self._rate)
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
    """

    gait: GaitSettings
    legs: VelocitySet | None
    shield: ShieldSettings
    duration: float

    @property
    def model(self) -> ShieldModel:
        """Model of the shield."""
        limits = limits_of(self.gait, self.legs)
        return ShieldModel(limits, self.shield, Direction.BACKWARD, False)


def paper_robots() -> dict[str, MappedRobot]:
    """Return NAO on the paper's legs, and with the fast gait."""
    slow = ShieldSettings(True, 0.12, 6.0, 0.35)
    fast = ShieldSettings(True, 0.4, 8.0, 0.35)
    return {
        "NAO, the paper's gait": MappedRobot(GaitSettings(), None, slow, 60.0),
        "NAO, fast gait": MappedRobot(PRESETS["fast"], None, fast, 30.0),
    }


def draw_starts(
    robot: MappedRobot, count: int, *, certified: bool, seed: int
) -> list[tuple[Pose, Pose]]:
    """Draw poses of person and robot, with the robot at rest.

    The person has walked straight for a window before the robot decides.
    """
    model, table = robot.model, robot.model.table()
    random = np.random.default_rng(seed)
    x, y, _ = table.grid.axes()
    starts: list[tuple[Pose, Pose]] = []
    while len(starts) < count:
        row = random.uniform([x[0], -y[-1], -pi], [x[-1], y[-1], pi])
        value = float(table.standing_value(row[None])[0])
        near = hypot(row[0], row[1]) < robot.shield.contact + 0.05
        if near or (value >= model.required) != certified:
            continue
        before = robot.shield.speed * (model.delay + 0.5 * model.window)
        starts.append((Pose(-before * 0.5, 0.0, 0.0), Pose(*row.tolist())))
    return starts


def play(
    robot: MappedRobot, start: tuple[Pose, Pose], seed: int
) -> tuple[str, float, float]:
    """Return kind of the person, closest approach [m] and share replaced."""
    kind = PEOPLE[seed % len(PEOPLE)]
    inner = RandomWalk(robot.legs is not None, seed)
    strategy = ShieldedStrategy(inner, robot.shield)

    def motion(pose: Pose, evader: tuple[float, float]) -> Any:
        return Chaser(kind, robot.shield, pose, seed)

    if robot.legs is None:
        game = play_template(
            motion, *start, strategy, robot.gait,
            duration=robot.duration, step=STEP,
        )  # fmt: skip
    else:
        game = play_point(
            motion, *start, strategy, robot.gait, robot.legs,
            duration=robot.duration, step=STEP,
        )  # fmt: skip
    return kind, game.closest_m, game.times[-1]


def map_of(
    robot: MappedRobot, count: int, report: Callable[[], object]
) -> dict[str, Any]:
    """Return the table of a robot and its games."""
    model, table = robot.model, robot.model.table()
    x, y, _ = table.grid.axes()
    unsafe = table.standing < model.required
    found: dict[str, Any] = {
        "person_speed_m_s": robot.shield.speed,
        "turning_radius_m": robot.shield.turning_radius,
        "contact_m": robot.shield.contact,
        "required_m": model.required,
        "loss_m": model.loss,
        "period_s": model.period,
        "solved_s": table.seconds,
        "winnable": bool(table.outside >= model.required),
        "start_ahead_m": float(x[unsafe.any(axis=(1, 2))].max()),
        "start_aside_m": float(y[unsafe.any(axis=(0, 2))].max()),
    }
    for name, certified in (("certified", True), ("outside", False)):
        starts = draw_starts(robot, count, certified=certified, seed=count)
        closest: dict[str, list[float]] = {kind: [] for kind in PEOPLE}
        for seed, start in enumerate(starts):
            kind, least, _ = play(robot, start, seed)
            closest[kind].append(least)
            report()
        found[name] = {
            kind: {
                "games": len(values),
                "contacts": sum(v < robot.shield.contact for v in values),
                "closest_m": min(values),
                "median_m": float(np.median(values)),
            }
            for kind, values in closest.items()
        }
    return found


def main() -> None:
    """Solve, play, and write the results."""
    asked = ask(__doc__, "shield-map.json")
    asked.add_argument("--robot", type=Path)
    asked.add_argument("--network", default="")
    asked.add_argument("--games", type=int, default=1000)
    asked.add_argument("--only", default="")
    arguments = asked.parse_args()
    robots = paper_robots()
    if arguments.network:
        policy = load_legs(
            LegsSettings(arguments.network),
            load_robot(arguments.robot),
            tick=0.02,
        )
        person = ShieldSettings(True, 1.0, 8.0, 0.45)
        robots["learned legs"] = MappedRobot(
            LEGS_GAIT, policy.velocities, person, 25.0
        )
    robots = {n: r for n, r in robots.items() if arguments.only in n}
    maps = {}
    for name, robot in robots.items():
        with tqdm(total=2 * arguments.games, desc=name, disable=None) as bar:
            maps[name] = map_of(robot, arguments.games, bar.update)
        print(name, maps[name], flush=True)
    head = header(
        {"games": arguments.games},
        modules=MODULES,
        libraries=("numpy", "numba"),
    )
    write_result(arguments.output, head, machine=machine(), maps=maps)


if __name__ == "__main__":
    main()
