"""A search for the steadiest way to walk, over short walks.

From the description on, every single change is tried; the best one stays,
and the search goes on from there until nothing is better, or good enough.
"""

import json
from collections.abc import Callable, Iterable
from concurrent.futures import Executor, as_completed
from hashlib import sha256
from pathlib import Path
from typing import Any, NamedTuple

from ..robots.description import RobotDescription
from ..robots.stored import digest_of
from ..studies.records import RecordFile
from ..studies.version import PHYSICS, code_version, library_versions
from .candidates import Candidate
from .trials import FALLEN, Walked, walk_trial

ROUNDS = 5
GOOD = 0.2  # unsteadiness that is not worth bettering
BETTER = 0.02  # by which a change must better it to stay
ROOMS = (*PHYSICS, "fitting/trials", "fitting/strain", "fitting/candidates")
IMPOSSIBLE = FALLEN + 2.0  # of changes that are too much


class Judged(NamedTuple):
    """A candidate and how it walks.

    Attributes:
        candidate: The changes.
        unsteadiness: Of its worst walk.
        walks: How each went, in words and numbers.
    """

    candidate: Candidate
    unsteadiness: float
    walks: tuple[dict[str, Any], ...]

    @property
    def score(self) -> float:
        """What is made small."""
        return self.unsteadiness + self.candidate.cost


class Tuned(NamedTuple):
    """What a search found.

    Attributes:
        before: The description as it was.
        best: What walks best.
        tried: Candidates that were walked.
    """

    before: Judged
    best: Judged
    tried: int


class Search:
    """A search for one robot, whose results are kept."""

    def __init__(
        self,
        description: RobotDescription,
        executor: Executor,
        kept: Path | None,
        report: Callable[[int, float], None] | None = None,
    ) -> None:
        """Take up what an earlier search of the same robot left.

        Args:
            description: The robot.
            executor: Where walks are walked.
            kept: File of results; nowhere by default.
            report: Called with how many candidates were tried, and the least
                unsteadiness so far.
        """
        self._own, self._executor = description, executor
        self._report = report
        self._file = None if kept is None else RecordFile(kept)
        self._stamp = _stamp_of(description)
        self._known = {} if self._file is None else self._file.read()
        self._judged: dict[Candidate, Judged] = {}

    def run(self) -> Tuned:
        """Search to the end."""
        feedback = float(bool(self._own.control.get("feedback", False)))
        start = Candidate(feedback)
        self._judge([start])
        before = best = self._judged[start]
        for _ in range(ROUNDS):
            if best.unsteadiness < GOOD:
                break
            around = list(best.candidate.neighbours())
            self._judge(around)
            found = min(
                (self._judged[each] for each in around),
                key=lambda judged: judged.score,
            )
            if found.score > best.score - BETTER:
                break
            best = found
        return Tuned(before, best, len(self._judged))

    def _judge(self, candidates: Iterable[Candidate]) -> None:
        """Walk those that were not walked yet."""
        waiting = {}
        for candidate in candidates:
            if candidate in self._judged:
                continue
            key = self._key(candidate)
            record = self._known.get(key)
            if record is not None:
                self._note(candidate, record["walks"])
                continue
            waiting[self._executor.submit(_walk_all, candidate, self._own)] = (
                candidate
            )
        for future in as_completed(waiting):
            candidate, walks = waiting[future], future.result()
            if self._file is not None:
                self._file.append(self._key(candidate), {"walks": walks})
            self._note(candidate, walks)

    def _note(self, candidate: Candidate, walks: list[dict[str, Any]]) -> None:
        worst = max((w["unsteadiness"] for w in walks), default=IMPOSSIBLE)
        self._judged[candidate] = Judged(candidate, worst, tuple(walks))
        if self._report is not None:
            least = min(j.unsteadiness for j in self._judged.values())
            self._report(len(self._judged), least)

    def _key(self, candidate: Candidate) -> str:
        return json.dumps([self._stamp, candidate.to_json()], sort_keys=True)


def _walk_all(
    candidate: Candidate, own: RobotDescription
) -> list[dict[str, Any]]:
    """Walk to all sides; one that falls early ends it."""
    walks: list[dict[str, Any]] = []
    for trial in candidate.trials(own):
        walked = walk_trial(trial)
        walks.append(_plain(walked))
        if not walked.completed and walked.lasted < 0.5:
            break
    return walks


def _plain(walked: Walked) -> dict[str, Any]:
    plain = walked._asdict()
    strain = walked.strain
    plain["strain"] = None if strain is None else strain._asdict()
    return plain | {"unsteadiness": walked.unsteadiness}


def _stamp_of(description: RobotDescription) -> str:
    """Digest of all that a walk of this robot depends on."""
    said = (
        digest_of(description),
        *(description.gait, description.sole, description.control),
        *(description.standing, description.working_limits),
        *(description.speed_limits, code_version(ROOMS), library_versions()),
    )
    return sha256(repr(said).encode()).hexdigest()[:16]
