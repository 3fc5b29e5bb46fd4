"""A search for the steadiest way to walk, over short walks.

From the description on, every single change is tried, a few at a time; the
best one stays, and the search goes on from there until nothing is better, or
good enough. A candidate walks to all sides, the hardest first, and stops at
its first fall, or where it can be no better than the best.
"""

import json
from collections.abc import Callable, Iterable
from concurrent.futures import Executor, as_completed
from dataclasses import asdict, replace
from hashlib import sha256
from pathlib import Path
from typing import Any, NamedTuple

from ..robots.description import RobotDescription
from ..robots.tree_cache import digest_of
from ..studies.code_version import code_version, library_versions
from ..studies.record_store import RecordStore
from .gait_candidates import Candidate
from .walk_trials import FALLEN, WAYS, WalkTrialResult, walk_trial

ROUNDS = 6
GOOD = 0.2  # unsteadiness that is not worth bettering
BETTER = 0.02  # by which a change must better it to stay
TOGETHER = 4  # candidates at a time: the same whatever walks them
FARTHER = 0.9 / len(WAYS)  # of who walks one way more before it falls
STEADY = 1.0  # unsteadiness below which a robot walks
ROOMS = ("fitting/walk_trials", "fitting/gait_candidates")
IMPOSSIBLE = FALLEN + 2.0  # of changes that are too much


class RatedCandidate(NamedTuple):
    """A candidate and how it walks.

    Attributes:
        candidate: The changes.
        unsteadiness: Of its worst walk; after a fall, less the more it had
            walked before.
        walks: How each went, in words and numbers, up to the one that ended
            it.
    """

    candidate: Candidate
    unsteadiness: float
    walks: tuple[dict[str, Any], ...]

    @property
    def score(self) -> float:
        """What is made small."""
        return self.unsteadiness + self.candidate.cost


class SearchResult(NamedTuple):
    """What a search found.

    Attributes:
        before: The description as it was.
        best: What walks best.
        tried: Candidates that were walked.
    """

    before: RatedCandidate
    best: RatedCandidate
    tried: int


class GaitSearch:
    """A search for one robot, whose results are kept."""

    def __init__(
        self,
        description: RobotDescription,
        executor: Executor,
        kept: Path | None,
        report: Callable[[int, int, float], None] | None = None,
    ) -> None:
        """Take up what an earlier search of the same robot left.

        Args:
            description: The robot.
            executor: Where walks are walked.
            kept: File of results; nowhere by default.
            report: Called with how many candidates were tried, how many it
                will be by the end of this round, and the least unsteadiness
                so far.
        """
        self._own, self._executor = description, executor
        self._report = report
        self._file = None if kept is None else RecordStore(kept)
        self._stamp = _stamp_of(description)
        self._known = {} if self._file is None else self._file.read(["walks"])
        self._judged: dict[Candidate, RatedCandidate] = {}
        self._goal = 1

    def run(self) -> SearchResult:
        """Search to the end."""
        feedback = float(bool(self._own.control.get("feedback", False)))
        start = Candidate(feedback)
        self._judge([start], IMPOSSIBLE)
        before = best = self._judged[start]
        for _ in range(ROUNDS):
            if best.unsteadiness < GOOD:
                break
            found = self._best_around(best)
            if found.score > best.score - BETTER:
                break
            best = found
        return SearchResult(before, best, len(self._judged))

    def _best_around(self, best: RatedCandidate) -> RatedCandidate:
        """The best of a candidate and its neighbours.

        Where the candidate falls, the first neighbours that get on by a walk
        are enough: the search goes on from there.
        """
        enough = best.score - FARTHER if best.unsteadiness >= STEADY else 0.0
        around = [
            each
            for each in best.candidate.neighbours()
            if each not in self._judged
        ]
        self._goal = len(self._judged) + len(around)
        for first in range(0, len(around), TOGETHER):
            some = around[first : first + TOGETHER]
            self._judge(some, best.score)
            judged = [best, *(self._judged[each] for each in some)]
            best = min(judged, key=lambda each: each.score)
            if best.score <= enough:
                break
        return best

    def _judge(self, candidates: Iterable[Candidate], bound: float) -> None:
        """Walk candidates, each until its score is beyond a bound."""
        waiting = {}
        for candidate in candidates:
            key = self._key(candidate)
            record = self._known.get(key)
            if record is not None:
                self._note(candidate, record["walks"])
                continue
            waiting[
                self._executor.submit(_walk_all, candidate, self._own, bound)
            ] = candidate
        for future in as_completed(waiting):
            candidate, walks = waiting[future], future.result()
            if self._file is not None:
                self._file.append(self._key(candidate), {"walks": walks})
            self._note(candidate, walks)

    def _note(self, candidate: Candidate, walks: list[dict[str, Any]]) -> None:
        judged = RatedCandidate(candidate, _unsteadiness(walks), tuple(walks))
        self._judged[candidate] = judged
        if self._report is not None:
            least = min(j.unsteadiness for j in self._judged.values())
            tried = len(self._judged)
            self._report(tried, max(tried, self._goal), least)

    def _key(self, candidate: Candidate) -> str:
        return json.dumps([self._stamp, candidate.to_json()], sort_keys=True)


def _walk_all(
    candidate: Candidate, own: RobotDescription, bound: float
) -> list[dict[str, Any]]:
    """Walk to all sides, until a fall or a score beyond a bound."""
    walks: list[dict[str, Any]] = []
    for trial in candidate.trials(own):
        walked = walk_trial(trial)
        walks.append(_plain(walked))
        score = walked.unsteadiness + candidate.cost
        if not walked.completed or score > bound:
            break
    return walks


def _unsteadiness(walks: list[dict[str, Any]]) -> float:
    """Of the worst walk; a fall counts by how much was walked until it."""
    if not walks:
        return IMPOSSIBLE
    last = walks[-1]
    if last["completed"]:
        return float(max(walk["unsteadiness"] for walk in walks))
    walked = (len(walks) - 1 + float(last["lasted"])) / len(WAYS)
    return FALLEN + 1.0 - walked


def _plain(walked: WalkTrialResult) -> dict[str, Any]:
    plain = walked._asdict()
    strain = walked.strain
    plain["strain"] = None if strain is None else strain._asdict()
    return plain | {"unsteadiness": walked.unsteadiness}


def _stamp_of(description: RobotDescription) -> str:
    """Digest of all that a walk of this robot depends on."""
    # Wherever it lies and whatever it is called, it walks the same.
    plain = replace(description, folder=Path(), name="", game={})
    said = (
        *(digest_of(description), asdict(plain)),
        *(code_version(ROOMS), library_versions()),
    )
    return sha256(repr(said).encode()).hexdigest()[:16]
