r"""Duels in physics of robots with a shield, against people within its bounds.

For each robot duels from starts that are drawn within 3 m of the person, who
steers at it, feints, stops, turns on the spot or comes back; and the first
command of docs/shield.md. A robot, a network, its contract ("" for that of the
robot) and the speed of the person add a robot on learned legs::

    python tools/benchmarks/shield_duels.py \
        --robot g1 --network g1.onnx --contract "" --speed 0.4

A start is certified from the first instant on at which the shield excludes
contact and knows the heading of the person. The track of each person is
compared with its greatest speed and turning rate afterwards. After Ctrl-C the
same command continues.

Writes ``docs/results/shield-duels.json`` for docs/results/shield.md.
"""

from dataclasses import dataclass
from math import atan2, cos, inf, pi, sin
from pathlib import Path
from typing import Any

import numpy as np
from benchmark_options import ask, machine
from result_files import header, write_result
from resumable_jobs import Row, finished, gather

from stepaside.core.poses import Pose, wrap_angle
from stepaside.core.random_streams import named_generator
from stepaside.games.floor_games import floor_of, rules_of
from stepaside.games.floor_world import PERIOD
from stepaside.games.game import GameInPlay
from stepaside.games.game_settings import GameSettings, duel
from stepaside.games.game_starts import with_starts
from stepaside.games.people import FloorPerson
from stepaside.games.recorded_game import RecordedGame
from stepaside.locomotion.policy.policy_legs import load_legs
from stepaside.planning import Direction
from stepaside.robots.description import load_robot
from stepaside.strategies import ShieldSettings, StandStill
from stepaside.strategies.knowledge import Intent, Knowledge
from stepaside.strategies.velocity_set import BodyVelocity

PEOPLE = ("steers", "feints", "weaves", "stops", "pivots", "returns")
FARTHEST = 3.0  # of a start, in [m]
FACING = 1.0  # greatest angle from which a person walks at the robot, in [rad]
SAMPLE = 0.1  # of the track of a person, in [s]
ROUND = 1.02  # by which the track of a person may exceed its bounds


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


class Visitor:
    """Person who walks at any pace up to a speed, and turns up to a rate.

    Attributes:
        pose: Present pose.
    """

    def __init__(
        self, kind: str, settings: ShieldSettings, start: Pose, seed: int
    ) -> None:
        """Begin at a pose."""
        self.pose, self._kind, self._settings = start, kind, settings
        self._random = named_generator(seed, "visitor")
        self._until, self._rate, self._pace = 0.0, 0.0, 1.0
        self._feints = False

    def advance(
        self, time: float, duration: float, evader: tuple[float, float]
    ) -> None:
        """Walk for a while, towards the robot or as its kind does."""
        kind, (x, y, theta) = self._kind, self.pose
        speed = self._settings.speed
        most = speed / self._settings.turning_radius
        walked, pace = time * speed, 1.0
        aim = atan2(evader[1] - y, evader[0] - x) - theta
        if kind == "returns" and walked % 6.0 > 3.0:
            aim += pi  # turns away, and back again
        rate = min(max(wrap_angle(aim) / duration, -most), most)
        if kind in ("stops", "pivots") and walked % 1.6 > 1.0:
            pace, rate = 0.0, rate * (kind == "pivots")
        if kind in ("feints", "weaves"):
            if time >= self._until:
                self._until = time + self._random.uniform(0.2, 1.5)
                self._feints = bool(self._random.random() < 0.4)
                self._rate = float(self._random.choice([-most, most]))
                slow = kind == "weaves" and self._random.random() < 0.2
                self._pace = float(self._random.random()) if slow else 1.0
            rate = self._rate if self._feints else rate
            pace = self._pace
        half = 0.5 * rate * duration
        way = pace * speed * duration * float(np.sinc(half / pi))
        self.pose = Pose(
            x + way * cos(theta + half),
            y + way * sin(theta + half),
            wrap_angle(theta + 2.0 * half),
        )


@dataclass(frozen=True)
class ShieldDuel:
    """One duel, of a body in physics or of its template.

    Attributes:
        settings: Settings, with a shield of the evader.
        kind: Kind of the person; empty for that of the settings.
        body: Whether it is one in physics.
    """

    settings: GameSettings
    kind: str
    body: bool

    def play(self) -> Row:
        """Return what happened after the start was certified."""
        settings = with_starts(self.settings.resolved())
        seed = settings.seed
        own, other = settings.player("evader"), settings.player("pursuer")
        legs = None
        if own.legs.network:
            legs = load_legs(own.legs, load_robot(own.robot), tick=0.02)
        inner: Any = StandStill()
        if self.kind and seed % 2:
            inner = RandomWalk(legs is not None, seed // 2, 0.0)
        world: Any
        if self.body:
            game: GameInPlay = RecordedGame(
                settings, strategies={"evader": inner}, recorded=False
            )
            world = game.world
            person, robot = world.player("pursuer"), world.player("evader")
            agent = robot.scheme.decisions
        else:
            given = {"evader": inner}
            velocities = None if legs is None else legs.velocities
            world = floor_of(settings, given, velocities=velocities)
            game = GameInPlay(world, rules_of(settings))
            person, agent = None, world.motions["evader"].agent
        if self.kind:
            assert other.pose is not None
            walk = Visitor(self.kind, own.shield, other.pose, seed)
            motion = FloorPerson(walk, lambda seen: seen["evader"][:2], PERIOD)
            if person is None:
                world.motions["pursuer"] = motion
            else:
                person.follow(motion)
        certified, least, track = None, inf, []
        while game.ended is None:
            game.tick()
            track.append((world.time, *world.states()["pursuer"]))
            if certified is None and agent.memory.certified:
                certified = world.time
            if certified is not None:
                least = min(least, world.apart("pursuer", "evader"))
        world.close()
        assert game.outcome is not None
        return {
            "kind": self.kind or "steers",
            "seed": seed,
            "outcome": game.outcome.value,
            "ended_s": world.time,
            "certified_s": certified,
            "least_m": None if certified is None else least,
            "within": is_within(np.array(track), own.shield),
        }


def is_within(track: Any, bounds: ShieldSettings) -> bool:
    """Return whether rows of time [s] and pose keep to the bounds."""
    begins = np.diff(np.floor(track[:, 0] / SAMPLE + 1e-6), prepend=-1.0) > 0.0
    passed, *moved = np.diff(track[begins], axis=0).T
    x, y, turned = moved
    fastest = (np.hypot(x, y) / passed).max()
    turned = np.abs((turned + pi) % (2.0 * pi) - pi)
    sharpest = (turned / passed).max() * bounds.turning_radius
    return bool(max(fastest, sharpest) < ROUND * bounds.speed)


def first_command(seed: int) -> GameSettings:
    """Return the duel of the first command of the page."""
    return case("", 0.06, 6.0, 30.0).changed(
        seed=seed, start={"distance": 1.3, "pursuer_offset": 0.0}
    )


def case(
    gait: str, speed: float, radius: float, duration: float, **own: Any
) -> GameSettings:
    """Return a duel against a person of a speed [m/s] and a radius [m]."""
    shield = {"enabled": True, "speed": speed, "turning_radius": radius}
    person = {"speed": speed, "gain": 10.0, "turning_radius": radius}
    return duel(
        duration=duration,
        pursuer={"body": "person", "person": person},
        evader={"strategy": "stand", "shield": shield, **own},
        **({"gait": gait} if gait else {}),
    )


def drawn(settings: GameSettings, seed: int) -> GameSettings:
    """Return the same from a drawn start."""
    random = named_generator(seed, "shield duel")
    own = settings.resolved().player("evader")
    assert own.shield.contact is not None
    nearest = max(own.shield.contact + 0.05, settings.start.least)
    # Uniform over the ring around the robot.
    away = float(np.sqrt(random.uniform(nearest**2, FARTHEST**2)))
    course = float(random.uniform(-FACING, FACING))
    facing = float(random.uniform(-pi, pi))
    start = {"pursuer_offset": course, "evader_offset": facing}
    return settings.changed(seed=seed, start=start | {"distance": away})


def robots(given: Any) -> dict[str, GameSettings]:
    """Return the duels of each robot, without its start."""
    found = {
        "NAO, the paper's gait": case("", 0.06, 6.0, 30.0),
        "NAO, fast gait": case("fast", 0.25, 8.0, 20.0),
    }
    learned = given.robot, given.network, given.contract, given.speed
    for robot, network, contract, speed in zip(*learned, strict=True):
        legs = {"network": network, "contract": contract}
        found[f"{robot.name.upper()}, learned legs"] = case(
            *("", speed, 8.0, 20.0),
            robot=str(robot),
            legs=legs,
        )
    return found


def main() -> None:
    """Play, and write the results."""
    asked = ask(__doc__, "shield-duels.json")
    asked.add_argument("--only", default="", help="part of a robot's name")
    asked.add_argument("--games", type=int, default=60)
    asked.add_argument("--robot", type=Path, action="append", default=[])
    asked.add_argument("--network", action="append", default=[])
    asked.add_argument("--contract", action="append", default=[])
    asked.add_argument("--speed", type=float, action="append", default=[])
    asked.add_argument("--workers", type=int, default=0)
    given = asked.parse_args()
    head = header({"games": given.games})
    duels: dict[tuple[str, str], list[ShieldDuel]] = {}
    for level in ("template", "body"):
        body = level == "body"
        duels["NAO, first command", level] = [
            ShieldDuel(first_command(seed), "", body)
            for seed in range(1, (100 if body else 10) + 1)
        ]
        for name, settings in robots(given).items():
            duels[name, level] = [
                ShieldDuel(
                    drawn(settings, seed), PEOPLE[seed % len(PEOPLE)], body
                )
                for seed in range(1, given.games + 1)
            ]
    duels = {k: v for k, v in duels.items() if given.only in " ".join(k)}
    jobs = {
        f"{name}, {level} {duel.settings.seed}": duel
        for (name, level), each in duels.items()
        for duel in each
    }
    rows = gather(given.output, head, jobs, ShieldDuel.play, given.workers)
    found: list[Row] = []
    for (name, level), each in duels.items():
        shield = each[0].settings.resolved().player("evader").shield
        played = [rows[f"{name}, {level} {d.settings.seed}"] for d in each]
        found.append(
            {
                "robot": name,
                "level": level,
                "person_speed_m_s": shield.speed,
                "turning_radius_m": shield.turning_radius,
                "contact_m": shield.contact,
                "duels": played,
            }
        )
    write_result(given.output, head, machine=machine(), rows=found)
    finished(given.output)


if __name__ == "__main__":
    main()
