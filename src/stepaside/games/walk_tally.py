"""What is counted while a robot walks."""

from ..control.balance.mpc import MpcResult
from .match import Match
from .outcome import Outcome
from .walker import Walker


class WalkTally:
    """Counts steps, and keeps what a solver answered.

    Attributes:
        steps: Steps begun so far.
        solved: Answers of the MPC so far, if there is one.
    """

    def __init__(self, walker: Walker, *, keeps_answers: bool = True) -> None:
        """Count for a robot that walks."""
        self._walker, self._keeps_answers = walker, keeps_answers
        self.steps = 0
        self.solved: list[MpcResult] = []

    def before(self, match: Match) -> None:
        """Nothing to do."""

    def acted(self, match: Match) -> None:
        """Note what began, and what a solver answered."""
        walker = self._walker
        if walker.begun is not None:
            self.steps += 1
        solved = walker.scheme.balance.solved
        if solved is not None and self._keeps_answers:
            self.solved.append(solved)

    def ended(self, match: Match, outcome: Outcome) -> None:
        """Nothing to do."""
