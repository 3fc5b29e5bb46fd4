"""A duel that was played, as a value."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from math import degrees
from typing import TYPE_CHECKING

import numpy as np

from ..poses import Array
from .circle import angle_between, distance_between, theory_of
from .figures import DuelSummary
from .outcome import Outcome
from .settings import DuelSettings
from .track import Track

if TYPE_CHECKING:
    from .judge import Still


@dataclass(frozen=True, slots=True, eq=False)
class Run:
    """A duel that was played: what decided it, how it went, its figures.

    Attributes:
        name: What it is called; that of its folder if it came from one.
        settings: What decided it, with the start that was drawn.
        outcome: How it ended.
        message: What ended it, in words.
        duration: Simulated time, in [s].
        times: Times of the samples, in [s]. Shape (n,).
        tracks: Record of each player, by name.
        summary: Its figures.
        stills: Some of what robots with cameras saw, by robot and camera;
            not kept on disk.
    """

    name: str
    settings: DuelSettings
    outcome: Outcome
    message: str
    duration: float
    times: Array
    tracks: Mapping[str, Track]
    summary: DuelSummary
    stills: "Mapping[str, Mapping[str, list[Still]]]" = field(
        default_factory=dict
    )

    @property
    def pursuer(self) -> Track:
        """Record of the pursuer."""
        return self.tracks["pursuer"]

    @property
    def evader(self) -> Track:
        """Record of the evader."""
        return self.tracks["evader"]

    @property
    def distance(self) -> Array:
        """Distance between the places, in [m]. Shape (n,)."""
        return distance_between(self.pursuer.unicycle, self.evader.unicycle)

    @property
    def orientation(self) -> Array:
        """Angle between the headings, in [deg]. Shape (n,)."""
        angle = angle_between(self.pursuer.unicycle, self.evader.unicycle)
        degs: Array = np.degrees(angle)
        return degs

    @property
    def theory(self) -> tuple[float, float, float] | None:
        """Radius [m], distance [m] and angle [deg] of theory's circle."""
        circle = theory_of(self.settings)
        if not circle.exists:
            return None
        return (
            circle.radius_evader_m,
            circle.distance_m,
            degrees(circle.headings_apart_rad),
        )

    @property
    def circle(self) -> tuple[float, float, float] | None:
        """Theory's circle, round where the players went in the end.

        Returns:
            Center (x, y) in the world and radius, in [m]; None if they were
            never on it.
        """
        theory, since = self.theory, self.summary.converged_at_s
        if theory is None or since is None:
            return None
        tail = self.times >= since
        middles = [
            track.unicycle[tail, :2].mean(axis=0)
            for track in self.tracks.values()
        ]
        x, y = np.mean(middles, axis=0).tolist()
        return x, y, theory[0]

    def words(self, index: int) -> str:
        """What goes on at a sample."""
        time = float(self.times[index])
        triggered = self.summary.triggered_at_s
        converged = self.summary.converged_at_s
        last = index >= len(self.times) - 1
        goes_on = (Outcome.COMPLETED, Outcome.INTERRUPTED)
        if last and self.outcome not in goes_on:
            return self.message
        if triggered is None or time < triggered:
            return "the pursuer comes; the evader stands"
        if time < triggered + 1.0:
            return "the evader is triggered"
        if converged is not None and time >= converged:
            return "both robots are on the circle"
        return "the evader is evading"

    def arrays(self) -> dict[str, Array]:
        """Record as arrays by name: ``times_s``, ``pursuer_com``, ..."""
        found = {"times_s": self.times}
        for name, track in self.tracks.items():
            found |= track.arrays(name)
        return found
