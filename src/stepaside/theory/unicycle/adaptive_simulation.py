"""Adaptive simulation of one game, smooth piece by smooth piece.

The integrator is SciPy's DOP853 with dense output. The end of each smooth
piece (see :mod:`.piecewise_dynamics`), the capture and the closest approach
are located on the dense output. A saturated evader that slides on zero error
turns with the line of sight, by Filippov's rule, so there is no chattering.
"""

from collections.abc import Callable
from dataclasses import dataclass, field
from functools import partial
from math import cos, sin
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ...core.brief_repr import brief_repr
from ...core.errors import StepAsideError, check_positive
from ...core.poses import Pose
from .event_location import EDGES, Event, StateView, cross, margin
from .game_parameters import FlatParameters, flat_parameters
from .piecewise_dynamics import (
    Branch,
    Mode,
    SmoothPiece,
    initial_mode,
    piece_of,
)
from .relative_coordinates import RelativeStart, world_poses
from .relative_motion import (
    RelativeState,
    derivative,
    geometry_of,
    geometry_of_arrays,
)
from .unicycle_game import Game, check_side

Array = NDArray[np.float64]
_EVENTS = (Event.CAPTURE, *EDGES)
_PROBES = np.linspace(0.0, 1.0, 9)  # fractions of a step probed for events
# Fractions of an interval at which a positive margin is searched.
_FRACTIONS = (0.0, *(0.5**k for k in range(1, 49)))
_SLACK = 1e-12  # margin below which an edge has been crossed


@dataclass(frozen=True)
class PlayedGame:
    """Simulated game with dense output.

    Attributes:
        game: Parameters of the game.
        times: Knots of the integration, increasing, in [s]. Shape (n + 1,).
        captured: Whether the distance fell to the capture distance.
        end_time: Time of capture or end of the game, in [s].
        closest_distance: Closest approach, in [m].
        closest_time: Time of the closest approach, in [s].
        switches: Times of transitions between smooth pieces, in [s].
        sides: Side at the start and after each switch.
    """

    __repr__ = brief_repr

    game: Game
    times: Array
    captured: bool
    end_time: float
    closest_distance: float
    closest_time: float
    switches: tuple[float, ...]
    sides: tuple[int, ...]
    _pieces: tuple[Callable[[float], Array], ...] = field(repr=False)

    def states(self, times: ArrayLike) -> Array:
        """Evaluate the states.

        Args:
            times: Times between 0 and ``end_time``, in [s]. Shape (n,).

        Returns:
            Columns r [m], a, psi, direction of the line of sight [rad], x, y
            of the pursuer [m]. Shape (n, 6). The bearing psi may lie outside
            [-pi, pi] by less than a turn.
        """
        queries = np.atleast_1d(np.asarray(times, dtype=np.float64))
        last = len(self._pieces) - 1
        index = np.searchsorted(self.times, queries, side="right") - 1
        index = np.clip(index, 0, last)
        pairs = zip(queries, index, strict=True)
        return np.array([self._pieces[i](t) for t, i in pairs])

    def poses(self, times: ArrayLike) -> tuple[Array, Array]:
        """Evaluate the poses of pursuer and evader.

        Args:
            times: Times between 0 and ``end_time``, in [s]. Shape (n,).

        Returns:
            Poses (x [m], y [m], theta [rad]) in the world. Shape (n, 3) each.
        """
        return world_poses(self.states(times))


@dataclass
class _PiecewiseGame:
    """Game on its current smooth piece."""

    rules: FlatParameters
    mode: Mode
    piece: SmoothPiece

    def rates(self, _: float, state: Array) -> list[float]:
        """Return the rates of (r, a, psi, line of sight, x, y)."""
        r, a, psi, sight, _x, _y = state.tolist()
        here = RelativeState(r, a, psi)
        geometry = geometry_of(here, self.rules)
        heading, speed = sight - a, self.rules.pursuer_speed
        return [
            *derivative(here, geometry, self.piece, self.rules),
            geometry.sight,
            speed * cos(heading),
            speed * sin(heading),
        ]

    def margins(self, states: Array) -> Array:
        """Return the margins of states to each event, in order of _EVENTS."""
        here = RelativeState(*states[:3])
        now = StateView(here, geometry_of_arrays(here, self.rules))
        found = [margin(e, now, self.piece, self.rules) for e in _EVENTS]
        if self.mode.branch != Branch.SLIDING:
            found[_EVENTS.index(Event.RELEASE)] = np.full_like(here.r, np.inf)
        return np.stack(found)

    def first_event(
        self, dense: Any, begin: float, end: float
    ) -> tuple[Event, float]:
        """Return the first event of a step and its time, or none and end."""
        from scipy.optimize import brentq

        probes = begin + (end - begin) * _PROBES
        margins = self.margins(dense(probes))
        left = margins < -_SLACK
        event = Event.NONE
        if not left.any():
            return event, end
        i = int(np.argmax(left.any(axis=0)))
        for e in np.flatnonzero(left[:, i]).tolist():
            hit, out = float(probes[max(i - 1, 0)]), float(probes[i])

            def margin_at(time: float, e: int = e) -> float:
                return float(self.margins(dense(time))[e])

            # A game that starts on an edge may enter the piece and leave it.
            trials = (hit + (out - hit) * part for part in _FRACTIONS)
            inside = next((t for t in trials if margin_at(t) > 0.0), None)
            if inside is not None:
                xtol = 1e-14 * max(1.0, end)
                hit = brentq(margin_at, inside, out, xtol=xtol)
            if event == Event.NONE or hit < end:
                event, end = _EVENTS[e], hit
        return event, end

    def closest(
        self, dense: Any, begin: float, step_end: float, end: float
    ) -> tuple[float, float]:
        """Return the closest approach of a step before end, and its time."""
        from scipy.optimize import brentq

        def opening(times: Any) -> Any:
            return geometry_of_arrays(
                RelativeState(*dense(times)[:3]), self.rules
            ).opening

        probes = begin + (step_end - begin) * _PROBES
        times = np.append(probes[probes < end], end)
        best = (float(dense(times)[0, -1]), float(end))
        speeds = opening(times)
        turns = (speeds[:-1] < 0.0) & (speeds[1:] > 0.0)
        for i in np.flatnonzero(turns).tolist():
            when = brentq(opening, times[i], times[i + 1])
            best = min(best, (float(dense(when)[0]), float(when)))
        return best

    def switch(self, state: Array, event: Event) -> Array:
        """Cross an edge; return the state on the next piece."""
        here = RelativeState(*state[:3].tolist())
        here, self.mode = cross(event, here, self.mode, self.rules)
        self.piece = piece_of(self.mode, self.rules)
        return np.array([*here, *state[3:]])


@dataclass
class _GameRecord:
    """Record of a running game; see :class:`PlayedGame`."""

    best: tuple[float, float]
    times: list[float]
    sides: list[int]
    switches: list[float] = field(default_factory=list)
    pieces: list[Callable[[float], Array]] = field(default_factory=list)

    def run(self, game: Game, state: Array, captured: bool) -> PlayedGame:
        """Return the finished game."""
        times, pieces = list(self.times), list(self.pieces)
        if not pieces:
            pieces.append(lambda _: state)
            times.append(times[-1])
        return PlayedGame(
            game,
            np.array(times),
            captured,
            times[-1],
            *self.best,
            tuple(self.switches),
            tuple(self.sides),
            tuple(pieces),
        )


def simulate(
    game: Game,
    start: RelativeStart,
    duration: float,
    *,
    side: int | None = None,
    capture_distance: float = 1e-6,
    pursuer: Pose = Pose(0.0, 0.0, 0.0),  # noqa: B008 (immutable)
    tolerance: float = 1e-11,
) -> PlayedGame:
    """Simulate one game.

    Args:
        game: Parameters of the game.
        start: Initial relative coordinates.
        duration: Time after which the game ends, in [s].
        side: Initial side, +1 or -1; the one behind the evader if None.
        capture_distance: Distance at which the game ends, in [m].
        pursuer: Initial pose of the pursuer in the world.
        tolerance: Relative tolerance of a step; the absolute tolerance is a
            tenth of it.

    Returns:
        The game, with dense output.

    Raises:
        PlanError: If a value is out of range.
        StepAsideError: If the integrator fails.
    """
    check_positive(duration, "duration", "s")
    check_positive(capture_distance, "capture_distance", "m")
    check_side(side or 0)
    rules = flat_parameters(game, capture_distance)
    r, a, psi = start.wrapped()
    sight = geometry_of(RelativeState(r, a, psi), rules).sight
    psi, mode = initial_mode(psi, sight, side or 0, rules)
    play = _PiecewiseGame(rules, mode, piece_of(mode, rules))
    state = np.array([r, a, psi, pursuer.theta + a, pursuer.x, pursuer.y])
    return _integrate(play, game, state, duration, tolerance)


def _integrate(
    play: _PiecewiseGame,
    game: Game,
    state: Array,
    duration: float,
    tolerance: float,
) -> PlayedGame:
    """Integrate a game from a state, piece by piece, until it ends."""
    from scipy.integrate import DOP853

    solve = partial(
        DOP853,
        play.rates,
        t_bound=duration,
        rtol=tolerance,
        atol=0.1 * tolerance,
        max_step=4.0 / max(game.pursuer.gain, game.evader.gain),
    )
    time, distance = 0.0, float(state[0])
    record = _GameRecord((distance, time), [time], [play.mode.side])
    captured = distance <= play.rules.capture_distance
    steps = solve(time, state)
    while not captured and time < duration:
        message = steps.step()
        if message:
            raise StepAsideError(f"integration stopped at {time} s: {message}")
        dense = steps.dense_output()
        event, end = play.first_event(dense, time, steps.t)
        state = steps.y if event == Event.NONE else dense(end)
        record.best = min(record.best, play.closest(dense, time, steps.t, end))
        time = end
        record.times.append(time)
        record.pieces.append(dense)
        captured = event == Event.CAPTURE
        if event in EDGES:
            state = play.switch(state, event)
            record.switches.append(time)
            record.sides.append(play.mode.side)
            steps = solve(time, state)
    return record.run(game, state, captured)
