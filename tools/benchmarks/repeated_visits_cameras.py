"""Count contacts and falls while a person walks around a robot with cameras.

The robot has the hardware body, the fast gait and cameras. A contact or a
fall ends a game, and the next seed follows; resident memory is recorded
every minute::

    python tools/benchmarks/repeated_visits_cameras.py --minutes 30
"""

from math import inf
from pathlib import Path
from time import perf_counter

from benchmark_options import ask, machine
from camera_people import CAMERAS

from stepaside.games.duel import Duel
from stepaside.games.duel_settings import DuelSettings, StartSettings
from stepaside.games.floor_player import FloorPlayer, PathSteering
from stepaside.games.match import Match, play
from stepaside.games.outcome import Outcome
from stepaside.games.pair_match import PairMatch
from stepaside.locomotion.zmp.control_settings import STABILISED
from stepaside.planning import PRESETS
from stepaside.sim.body_settings import BODIES
from stepaside.sim.camera_settings import SceneSettings
from stepaside.sim.person_crossings import RepeatedCrossings
from stepaside.sim.person_settings import PersonSettings
from stepaside.strategies import Evasion
from stepaside.studies.person_encounters import PASSING
from stepaside.studies.result_files import header, write_result

MINUTE = 60.0  # between two memory measurements, in [s]


def game(seed: int, speed: float, duration: float) -> DuelSettings:
    """Return a game with a walking person; speed in [m/s], duration in [s]."""
    return DuelSettings(
        seed=seed,
        duration=duration,
        gait=PRESETS["fast"],
        body=BODIES["hardware"],
        control=STABILISED,
        strategy=Evasion(trigger="time"),
        sensing="cameras",
        cameras=CAMERAS,
        room=SceneSettings(walls=0.0),
        pursuer="person",
        person=PersonSettings("visits", speed),
        start=StartSettings(4.5, 0.0),
    )


class Counts:
    """Observer that counts events.

    Attributes:
        crossings: Number of paths of the person begun.
        triggers: Number of times that the robot began to move.
        false: Number of triggers without a person approaching within the
            lateral offset of a passing pedestrian.
        closest: Closest approach of the torsos, in [m].
        memory: Resident memory at each minute, in [MB].
    """

    def __init__(self) -> None:
        self.crossings = self.triggers = self.false = 0
        self.closest = inf
        self.memory = [resident()]
        self._before, self._moved = 0.0, False

    def before(self, match: Match) -> None:
        """Update the counts at each tick."""
        robot, visits = match.players[1], visits_of(match)
        if robot.is_moving and not self._moved:
            self.triggers += 1
            passes = abs(visits.miss) >= PASSING
            self.false += passes or not visits.crossing
        self._moved = robot.is_moving
        played = self._before + match.world.time
        if played >= MINUTE * len(self.memory):
            self.memory.append(resident())

    def acted(self, match: Match) -> None:
        """Do nothing: no event happens between ticks."""

    def ended(self, match: Match, outcome: Outcome) -> None:
        """Add the counts of a game to the total."""
        self.crossings += visits_of(match).number
        assert isinstance(match, PairMatch)
        self.closest = min(self.closest, match.min_distance)
        self._before, self._moved = self._before + match.world.time, False


def visits_of(match: Match) -> RepeatedCrossings:
    """Return the visits of the person in a match."""
    person = match.players[0]
    assert isinstance(person, FloorPlayer)
    assert isinstance(person.steering, PathSteering)
    return person.steering.motion.visits


def resident() -> float:
    """Return the resident memory of this process, in [MB]."""
    pages = int(Path("/proc/self/statm").read_text("utf-8").split()[1])
    return pages * 4096 / 1e6


def main() -> None:
    """Simulate the games and write the results."""
    asked = ask(__doc__, "repeated-visits.json")
    asked.add_argument("--minutes", type=float, default=30.0)
    asked.add_argument("--speed", type=float, default=0.5)
    asked.add_argument("--seed", type=int, default=1)
    given = asked.parse_args()
    left, seed, counts = 60.0 * given.minutes, given.seed, Counts()
    outcomes, began = [], perf_counter()
    while left > 1.0:
        duel = Duel(game(seed, given.speed, left), (counts,), recorded=False)
        outcome, _ = play(duel, left)
        print(seed, outcome.value, duel.message, flush=True)
        outcomes.append(outcome.value)
        left, seed = left - duel.world.time, seed + 1
    settings = {"minutes": given.minutes, "speed_m_s": given.speed}
    libraries = ["mujoco", "numpy", "opencv-python-headless"]
    played = 60.0 * given.minutes - max(left, 0.0)
    write_result(
        given.output,
        header(
            settings,
            modules=("studies/person_encounters",),
            libraries=libraries,
        ),
        machine=machine(),
        played_s=played,
        wall_s=perf_counter() - began,
        crossings=counts.crossings,
        contacts=outcomes.count("contact"),
        falls=outcomes.count("fall"),
        triggers=counts.triggers,
        false_triggers=counts.false,
        false_triggers_per_hour=3600.0 * counts.false / played,
        closest_m=counts.closest,
        memory_mb=counts.memory,
    )


if __name__ == "__main__":
    main()
