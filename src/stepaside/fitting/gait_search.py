"""Local search for a steady gait, rated by short walks in simulation.

Every single change to the description is tried, a few at a time; the best
one is adopted, and the search continues from there until no change improves
the walk, or it is good enough. A candidate walks along all paths, the hardest
first, until its first fall or until it cannot beat the best one.
"""

import json
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import Executor
from dataclasses import asdict, replace
from functools import partial
from hashlib import sha256
from math import hypot, log
from pathlib import Path
from typing import Any, NamedTuple

from ..games.player_settings import settings_from_description
from ..robots.description import LEAN_LIMIT, RobotDescription
from ..robots.description_types import RobotGames
from ..robots.tree_cache import digest_of
from ..studies.study import Study, run_study
from ..studies.tabulation import Record
from .derivation import LEAST_SPACING
from .gait_feasibility import rounded
from .robot_verification import (
    FALLEN,
    PATHS,
    control_with,
    walk_trial,
)

ROUNDS = 6
GOOD = 0.2  # unsteadiness at which the search stops
LEAST_IMPROVEMENT = 0.02  # of the score, for a change to be adopted
BATCH = 4  # candidates at a time, independent of the number of workers
ONE_PATH_MORE = 0.9 / len(PATHS)  # score of one more path before a fall
STEADY = 1.0  # unsteadiness below which a robot walks
INFEASIBLE = FALLEN + 2.0  # unsteadiness of changes that are not feasible

# Values of each change beside its neutral one. The order is that of how often
# a change helped published robots.
CHOICES: dict[str, tuple[float, ...]] = {
    "times": (0.8, 0.65, 1.25),
    "spacing": (0.85, 0.7, 1.12),
    "lean": (0.06, 0.12),
    "feedback": (0.0, 1.0),
    "zmp": (-0.1, 0.1, -0.2),
    "stride": (0.75, 0.5),
    "stiffness": (1.6, 0.6, 2.5),
    "height": (0.98, 0.95),
    "even": (0.0, 1.0),
}
# Greatest distance of the ZMP reference from the middle of the sole, by its
# length.
GREATEST_ZMP_SHIFT = 0.35


class Candidate(NamedTuple):
    """Changes to a robot description."""

    feedback: float = 0.0  # 1 with feedback, 0 without
    stiffness: float = 1.0  # factor on the gains of all servos
    times: float = 1.0  # factor on single and double support durations
    stride: float = 1.0  # factor on stride and speed
    spacing: float = 1.0  # factor on the distance between the feet
    # forward shift of the ZMP reference, by the length of the sole
    zmp: float = 0.0
    height: float = 1.0  # factor on the CoM height
    # additional lean of the torso over the stance foot [rad]
    lean: float = 0.0
    even: float = 0.0  # 1 for swing feet with even velocity

    @property
    def cost(self) -> float:
        """Penalty of the distance from the description; small."""
        factors = (self.stiffness, self.times, self.spacing, self.height)
        distance = hypot(
            *(log(factor) for factor in factors), self.zmp, self.lean
        )
        return 0.02 * distance + 0.2 * max(0.0, 1.0 - self.stride)

    def neighbours(self) -> Iterator["Candidate"]:
        """Yield the candidates that differ in one change."""
        for name, values in CHOICES.items():
            for value in dict.fromkeys((*values, getattr(UNCHANGED, name))):
                if value != getattr(self, name):
                    yield self._replace(**{name: value})

    def applied(self, own: RobotDescription) -> RobotDescription | None:
        """Return the changed description; None if it is not feasible."""
        settings = settings_from_description(own)
        gait, sole = settings.gait, settings.gait.sole
        length = sole.front - sole.back
        spacing = self.spacing * gait.foot_spacing
        zmp_forward = gait.zmp_forward + self.zmp * length
        middle = 0.5 * (sole.front + sole.back)
        if spacing < 2.0 * LEAST_SPACING * sole.inner and self.spacing < 1.0:
            return None
        if abs(zmp_forward - middle) > GREATEST_ZMP_SHIFT * length:
            return None
        if own.lean + self.lean > LEAN_LIMIT:
            return None
        values = {
            "speed": self.stride * gait.speed,
            "stride": self.stride * gait.stride,
            "foot_spacing": spacing,
            "single_support": self.times * gait.single_support,
            "double_support": self.times * gait.double_support,
            "com_height": self.height * gait.com_height,
            "zmp_forward": zmp_forward,
        }
        changed: dict[str, float | str] = {
            name: rounded(v, 4) for name, v in values.items()
        }
        if self.even:
            changed["swing_profile"] = "even"
        control = control_with(settings.control, bool(self.feedback))
        servos = {
            name: replace(
                gains,
                stiffness=rounded(self.stiffness * gains.stiffness),
                damping=rounded(self.stiffness * gains.damping),
            )
            for name, gains in own.overlay.servos.items()
        }
        method = {"method": control.method, "feedback": control.feedback}
        return replace(
            own,
            lean=own.lean + self.lean,
            gait=own.gait | changed,
            control=own.control | method,
            overlay=replace(own.overlay, servos=servos),
        )


UNCHANGED = Candidate()


class RatedCandidate(NamedTuple):
    """A candidate with the results of its walks."""

    candidate: Candidate  # changes to the description
    # of the worst walk; after a fall, the lower the farther it walked before
    unsteadiness: float
    # results of the walks, up to the one that ended the rating
    walks: tuple[dict[str, Any], ...]

    @property
    def score(self) -> float:
        """Objective of the search, to be minimised."""
        return self.unsteadiness + self.candidate.cost


class SearchResult(NamedTuple):
    """Result of a gait search."""

    before: RatedCandidate  # rating of the description without changes
    best: RatedCandidate
    tried: int  # number of candidates that were rated


def search_gait(
    own: RobotDescription,
    executor: Executor | None,
    file: Path | None,
    report: Callable[[int, int, float], None] = lambda *_: None,
) -> SearchResult:
    """Search until no change improves the walk."""
    rated: dict[Candidate, RatedCandidate] = {}
    digest = _digest_of(own)

    def key_of(candidate: Candidate) -> str:
        return json.dumps([digest, candidate._asdict()], sort_keys=True)

    def rate(candidates: Sequence[Candidate], bound: float, of: int) -> None:
        """Rate candidates, each until its score exceeds a bound."""
        measure = partial(_walk_all, own, bound)
        run = run_study(
            Study("tune", candidates, measure, key_of),
            file,
            executor=executor,
            report=lambda _: None,
        )
        for candidate, record in run.items():
            walks = tuple(record["walks"])
            rated[candidate] = RatedCandidate(
                candidate, _unsteadiness(walks), walks
            )
            least = min(each.unsteadiness for each in rated.values())
            report(len(rated), max(len(rated), of), least)
        if run.failure is not None:
            raise run.failure
        if run.interrupted:
            raise KeyboardInterrupt

    start = Candidate(float(bool(own.control.get("feedback", False))))
    rate([start], INFEASIBLE, 1)
    before = best = rated[start]
    for _ in range(ROUNDS):
        if best.unsteadiness < GOOD:
            break
        # If the candidate falls, the first batch with a neighbour that walks
        # one path more ends the round.
        falls = best.unsteadiness >= STEADY
        enough = best.score - ONE_PATH_MORE if falls else 0.0
        found = best
        neighbours = [n for n in best.candidate.neighbours() if n not in rated]
        of = len(rated) + len(neighbours)
        for first in range(0, len(neighbours), BATCH):
            batch = neighbours[first : first + BATCH]
            rate(batch, found.score, of)
            found = min(
                [found, *(rated[each] for each in batch)],
                key=lambda each: each.score,
            )
            if found.score <= enough:
                break
        if found.score > best.score - LEAST_IMPROVEMENT:
            break
        best = found
    return SearchResult(before, best, len(rated))


def _walk_all(
    own: RobotDescription, bound: float, candidate: Candidate
) -> Record:
    """Walk along all paths, until a fall or a score beyond a bound.

    The hardest path is the first; none is walked if the changes are not
    feasible.
    """
    walks: list[dict[str, Any]] = []
    changed = candidate.applied(own)
    if changed is None:
        return {"walks": walks}
    for path in reversed(PATHS):
        result = walk_trial(changed, path, bool(candidate.feedback))
        walks.append(result.to_json())
        score = result.unsteadiness + candidate.cost
        if not result.completed or score > bound:
            break
    return {"walks": walks}


def _unsteadiness(walks: Sequence[dict[str, Any]]) -> float:
    """Return that of the worst walk; after a fall, by the time walked."""
    if not walks:
        return INFEASIBLE
    last = walks[-1]
    if last["completed"]:
        return float(max(walk["unsteadiness"] for walk in walks))
    fraction = (len(walks) - 1 + float(last["lasted"])) / len(PATHS)
    return FALLEN + 1.0 - fraction


def _digest_of(description: RobotDescription) -> str:
    """Return a digest of all that the walks of a robot depend on."""
    # Folder and name of a robot do not influence its walks.
    plain = replace(description, folder=Path(), name="", game=RobotGames())
    # In full: the text of a description is abridged.
    inputs = digest_of(description), asdict(plain)
    return sha256(repr(inputs).encode()).hexdigest()[:16]
