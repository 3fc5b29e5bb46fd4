"""Local search for a steady gait, rated by short walks in simulation.

Every single change to the description is tried, a few at a time; the best
one is adopted, and the search continues from there until no change improves
the walk, or it is good enough. A candidate walks along all paths, the hardest
first, until its first fall or until it cannot beat the best one.
"""

import json
from collections.abc import Callable, Sequence
from concurrent.futures import Executor
from dataclasses import asdict, replace
from functools import partial
from hashlib import sha256
from pathlib import Path
from typing import Any, NamedTuple

from ..robots.description import RobotDescription
from ..robots.tree_cache import digest_of
from ..studies.study import Study, StudyProgress, run_study
from ..studies.tabulation import Record
from .gait_candidates import Candidate
from .walk_trials import FALLEN, PATHS, WalkTrialResult, walk_trial

ROUNDS = 6
GOOD = 0.2  # unsteadiness at which the search stops
LEAST_IMPROVEMENT = 0.02  # of the score, for a change to be adopted
BATCH = 4  # candidates at a time, independent of the number of workers
ONE_PATH_MORE = 0.9 / len(PATHS)  # score of one more path before a fall
STEADY = 1.0  # unsteadiness below which a robot walks
INFEASIBLE = FALLEN + 2.0  # unsteadiness of changes that are not feasible


class RatedCandidate(NamedTuple):
    """A candidate with the results of its walks.

    Attributes:
        candidate: Changes to the description.
        unsteadiness: Of the worst walk; after a fall, the lower the farther
            it walked before.
        walks: Results of the walks, up to the one that ended the rating.
    """

    candidate: Candidate
    unsteadiness: float
    walks: tuple[dict[str, Any], ...]

    @property
    def score(self) -> float:
        """Objective of the search, to be minimised."""
        return self.unsteadiness + self.candidate.cost


class SearchResult(NamedTuple):
    """Result of a gait search.

    Attributes:
        before: Rating of the description without changes.
        best: Best candidate.
        tried: Number of candidates that were rated.
    """

    before: RatedCandidate
    best: RatedCandidate
    tried: int


class GaitSearch:
    """Search for one robot, with results stored on disk."""

    def __init__(
        self,
        description: RobotDescription,
        executor: Executor | None,
        file: Path | None,
        report: Callable[[int, int, float], None] | None = None,
    ) -> None:
        """Load the results of an earlier search for the same robot.

        Args:
            description: Robot description.
            executor: Executor of the walks.
            file: SQLite file of the ratings; None to store nothing.
            report: Called with the number of candidates that are rated, the
                number by the end of the round, and the least unsteadiness so
                far.
        """
        self._own, self._executor = description, executor
        self._report = report
        self._file = file
        self._digest = _digest_of(description)
        self._rated: dict[Candidate, RatedCandidate] = {}
        self._expected = 1

    def run(self) -> SearchResult:
        """Search until no change improves the walk."""
        feedback = float(bool(self._own.control.get("feedback", False)))
        start = Candidate(feedback)
        self._rate([start], INFEASIBLE)
        before = best = self._rated[start]
        for _ in range(ROUNDS):
            if best.unsteadiness < GOOD:
                break
            neighbour = self._best_neighbour(best)
            if neighbour.score > best.score - LEAST_IMPROVEMENT:
                break
            best = neighbour
        return SearchResult(before, best, len(self._rated))

    def _best_neighbour(self, best: RatedCandidate) -> RatedCandidate:
        """Return the best of a candidate and its neighbours.

        If the candidate falls, the first batch with a neighbour that walks
        one path more ends the round.
        """
        enough = 0.0
        if best.unsteadiness >= STEADY:
            enough = best.score - ONE_PATH_MORE
        neighbours = [
            each
            for each in best.candidate.neighbours()
            if each not in self._rated
        ]
        self._expected = len(self._rated) + len(neighbours)
        for first in range(0, len(neighbours), BATCH):
            batch = neighbours[first : first + BATCH]
            self._rate(batch, best.score)
            rated = [best, *(self._rated[each] for each in batch)]
            best = min(rated, key=lambda each: each.score)
            if best.score <= enough:
                break
        return best

    def _rate(self, candidates: Sequence[Candidate], bound: float) -> None:
        """Rate candidates, each until its score exceeds a bound.

        Raises:
            OutputError: If a rating cannot be stored.
            KeyboardInterrupt: After Ctrl-C.
        """
        study = Study(
            "tune",
            candidates,
            partial(_walk_all, self._own, bound),
            self._key,
        )
        run = run_study(
            study, self._file, executor=self._executor, report=_say_nothing
        )
        for candidate, record in run.items():
            self._add(candidate, record["walks"])
        if run.failure is not None:
            raise run.failure
        if run.interrupted:
            raise KeyboardInterrupt

    def _add(self, candidate: Candidate, walks: list[dict[str, Any]]) -> None:
        rated = RatedCandidate(candidate, _unsteadiness(walks), tuple(walks))
        self._rated[candidate] = rated
        if self._report is not None:
            least = min(r.unsteadiness for r in self._rated.values())
            number = len(self._rated)
            self._report(number, max(number, self._expected), least)

    def _key(self, candidate: Candidate) -> str:
        return json.dumps([self._digest, candidate.to_json()], sort_keys=True)


def _say_nothing(progress: StudyProgress) -> None:
    """Leave the progress to the search."""


def _walk_all(
    own: RobotDescription, bound: float, candidate: Candidate
) -> Record:
    """Walk along all paths, until a fall or a score beyond a bound."""
    walks: list[dict[str, Any]] = []
    for trial in candidate.trials(own):
        result = walk_trial(trial)
        walks.append(_record(result))
        score = result.unsteadiness + candidate.cost
        if not result.completed or score > bound:
            break
    return {"walks": walks}


def _unsteadiness(walks: list[dict[str, Any]]) -> float:
    """Return that of the worst walk; after a fall, by the time walked."""
    if not walks:
        return INFEASIBLE
    last = walks[-1]
    if last["completed"]:
        return float(max(walk["unsteadiness"] for walk in walks))
    fraction = (len(walks) - 1 + float(last["lasted"])) / len(PATHS)
    return FALLEN + 1.0 - fraction


def _record(result: WalkTrialResult) -> dict[str, Any]:
    record = result._asdict()
    strain = result.strain
    record["strain"] = None if strain is None else strain._asdict()
    return record | {"unsteadiness": result.unsteadiness}


def _digest_of(description: RobotDescription) -> str:
    """Return a digest of all that the walks of a robot depend on."""
    # Folder and name of a robot do not influence its walks.
    plain = replace(description, folder=Path(), name="", game={})
    # In full: the text of a description is abridged.
    inputs = digest_of(description), asdict(plain)
    return sha256(repr(inputs).encode()).hexdigest()[:16]
