"""How far a walking body departs from the template that stands for it."""

from typing import NamedTuple


class BodyDeparture(NamedTuple):
    """Departure of a body from its template, measured in physics, in [m].

    A template decides at each step, or in each interval on learned legs.
    """

    # radius around the torso that contains all of it, arms and feet in motion
    reach: float
    # distance of the torso from its template point between two decisions
    tube: float
    # change, from one decision to the next, of where the body is and somebody
    # near it is seen, by what its odometry does not know
    loss: float
    drift: float  # by which that grows with each further decision

    def loss_in(self, decisions: float) -> float:
        """Return the greatest change over a number of decisions, in [m]."""
        return self.loss + self.drift * max(0.0, decisions - 1.0)

    def enlarged(self, other: "BodyDeparture") -> "BodyDeparture":
        """Return the larger of two departures, value by value."""
        return BodyDeparture(*map(max, self, other))
