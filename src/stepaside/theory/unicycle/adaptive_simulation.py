"""Adaptive simulation of one game, smooth piece by smooth piece.

SciPy's DOP853 integrates each piece (:mod:`.relative_motion`); its edges, the
capture and the closest approach are located on the dense output. A saturated
evader that slides on zero error turns with the line of sight, by Filippov's
rule, so there is no chattering.
"""

from collections.abc import Callable
from dataclasses import dataclass, field
from functools import partial
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ...core.brief_repr import brief_repr
from ...core.errors import StepAsideError, check_positive
from .relative_motion import (
    SLACK,
    Mode,
    Rates,
    RelativeState,
    Rules,
    cross,
    edge_margin,
    initial_mode,
    piece_of,
    rates_of,
    rules_of,
)
from .unicycle_game import Game, RelativeStart, check_side

Array = NDArray[np.float64]
TOLERANCE = 1e-11  # relative, of a step
_PROBES = np.linspace(0.0, 1.0, 9)[1:]  # of a step, at which events are seen


@dataclass(frozen=True)
class PlayedGame:
    """Simulated game with dense output."""

    __repr__ = brief_repr

    game: Game  # parameters of the game
    captured: bool  # whether the distance fell to the capture distance
    end_time: float  # time of capture or end of the game, in [s]
    closest_distance: float  # closest approach, in [m]
    closest_time: float  # time of the closest approach, in [s]
    # Times of transitions between smooth pieces, in [s].
    switches: tuple[float, ...]
    sides: tuple[int, ...]  # side at the start and after each switch
    _pieces: tuple[Callable[[Array], Array], ...] = field(repr=False)

    def states(self, times: ArrayLike) -> Array:
        """Evaluate the states at times between 0 and ``end_time``, in [s].

        Returns:
            Columns r [m], a, psi, direction of the line of sight [rad], x, y
            of the pursuer [m]. Shape (n, 6). The bearing psi may lie outside
            [-pi, pi] by less than a turn.
        """
        queries = np.atleast_1d(np.asarray(times, dtype=np.float64))
        index = np.searchsorted(self.switches, queries, side="right")
        found = np.empty((len(queries), 6))
        for i in np.unique(index).tolist():
            found[index == i] = self._pieces[i](queries[index == i]).T
        return found

    def poses(self, times: ArrayLike) -> tuple[Array, Array]:
        """Evaluate the poses of pursuer and evader, likewise.

        The frame is the initial one of the pursuer.

        Returns:
            Poses (x [m], y [m], theta [rad]). Shape (n, 3) each.
        """
        r, a, psi, sight, x, y = self.states(times).T
        ends = x + r * np.cos(sight), y + r * np.sin(sight)
        pursuer = np.column_stack([x, y, sight - a])
        return pursuer, np.column_stack([*ends, sight + np.pi - psi])


@dataclass(frozen=True)
class _Piece:
    """Integration of a game on one smooth piece."""

    rules: Rules
    mode: Mode

    def rates(self, states: Array) -> Rates:
        """Return the rates of one or many states."""
        piece = piece_of(self.mode, self.rules)
        return rates_of(RelativeState(*states[:3]), piece, self.rules)

    def derivative(self, _: float, state: Array) -> list[float]:
        """Return the rates of (r, a, psi, line of sight, x, y)."""
        heading, speed = state[3] - state[1], self.rules.pursuer_speed
        velocity = speed * np.cos(heading), speed * np.sin(heading)
        return [*self.rates(state), *velocity]

    def margin(self, _: Any, states: Array) -> Any:
        """Return the margin of states to an edge or to the capture."""
        here, rules = RelativeState(*states[:3]), self.rules
        piece = piece_of(self.mode, rules)
        edge = edge_margin(here, self.rates(states), piece, rules)
        return np.minimum(edge + SLACK, here.r - rules.capture_distance)

    def solve(
        self, begin: float, state: Array, end: float
    ) -> tuple[Any, Array, bool]:
        """Integrate until an edge, the capture or the end of the game.

        It returns the dense output, the times in [s] at which the distance was
        checked, and whether it ended early.
        """
        from scipy.integrate import solve_ivp
        from scipy.optimize import brentq

        leaves: Any = partial(self.margin)
        leaves.terminal, leaves.direction = True, -1.0
        gain = max(self.rules.pursuer_gain, self.rules.evader_gain)
        run = solve_ivp(
            self.derivative,
            (begin, end),
            state,
            method="DOP853",
            dense_output=True,
            events=leaves,
            rtol=TOLERANCE,
            atol=0.1 * TOLERANCE,
            max_step=4.0 / gain,
        )
        if run.status < 0:
            raise StepAsideError(
                f"integration stopped at {run.t[-1]} s: {run.message}"
            )
        parts = run.t[:-1, None] + np.diff(run.t)[:, None] * _PROBES
        times = np.concatenate([run.t[:1], parts.ravel()])
        # A step that left the piece and came back has no event.
        out = np.flatnonzero(self.margin(times, run.sol(times)) < 0.0)
        if len(out) == 0 or out[0] == len(times) - 1:
            return run.sol, times, run.status == 1
        first, found = int(out[0]), begin  # a given side may be forbidden
        if first > 0:
            between = times[first - 1], times[first]
            found = brentq(
                lambda t: self.margin(t, run.sol(t)), *between, xtol=1e-14
            )
        return run.sol, np.append(times[:first], found), True

    def closest(self, dense: Any, times: Array) -> tuple[float, float]:
        """Return the closest approach of a piece, and its time."""
        from scipy.optimize import brentq

        def opening(time: Any) -> Any:
            return self.rates(dense(time)).r

        speeds = opening(times)
        turns = np.flatnonzero((speeds[:-1] < 0.0) & (speeds[1:] > 0.0))
        found = [brentq(opening, times[i], times[i + 1]) for i in turns]
        return min((float(dense(t)[0]), t) for t in (*found, times[-1]))


def simulate(
    game: Game,
    start: RelativeStart,
    duration: float,
    *,
    side: int | None = None,
    capture_distance: float = 1e-6,
) -> PlayedGame:
    """Simulate one game.

    Args:
        game: Parameters of the game.
        start: Initial relative coordinates.
        duration: Time after which the game ends, in [s].
        side: Initial side, +1 or -1; the one behind the evader if None.
        capture_distance: Distance at which the game ends, in [m].

    Raises:
        StepAsideError: If a value is out of range or the integrator fails.
    """
    check_positive(duration, "duration", "s")
    check_positive(capture_distance, "capture_distance", "m")
    check_side(side or 0)
    rules = rules_of(game, capture_distance)
    here, mode = initial_mode(
        RelativeState(*start.wrapped()), side or 0, rules
    )
    state = np.array([*here, here.a, 0.0, 0.0])
    time, best = 0.0, (float(here.r), 0.0)
    captured = best[0] <= capture_distance
    switches, sides, pieces = [], [mode.side], []
    if captured:
        pieces.append(lambda times: np.tile(state[:, None], len(times)))
    while not captured and time < duration:
        piece = _Piece(rules, mode)
        dense, times, early = piece.solve(time, state, duration)
        pieces.append(dense)
        best = min(best, piece.closest(dense, times))
        time = float(times[-1])
        state = dense(time)
        captured = early and bool(state[0] - capture_distance < SLACK)
        if early and not captured:
            here, mode = cross(RelativeState(*state[:3]), mode, rules)
            state[:3] = here
            switches.append(time)
            sides.append(mode.side)
    return PlayedGame(
        game,
        captured,
        time,
        *best,
        tuple(switches),
        tuple(sides),
        tuple(pieces),
    )
