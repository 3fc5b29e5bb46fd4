"""One game by an adaptive integrator, piece by piece.

The integrator is SciPy's DOP853 with dense output. The end of each smooth
piece (see :mod:`.modes`), the capture and the closest approach are located
on the dense output; the saturated evader that slides on zero error turns
with the line of sight, as Filippov's rule says, so nothing chatters.
"""

from collections.abc import Callable
from dataclasses import dataclass, field
from math import cos, pi, sin
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ..errors import StepAsideError, check_positive
from ..poses import Pose
from .laws import Game
from .modes import SLIDING, enter, leave, piece
from .relative import Start, world_poses

Array = NDArray[np.float64]
_PROBES = np.linspace(0.0, 1.0, 9)  # of each step, where edges are looked for
_SLACK = 1e-12  # how far beyond an edge counts as left


@dataclass(frozen=True)
class Run:
    """A game that was played.

    Attributes:
        game: Parameters of the game.
        times: Knots of the integration, rising, in [s]. Shape (n + 1,).
        captured: Whether the distance fell to the capture distance.
        end_time: Time of capture or end of the game, in [s].
        closest_distance: Least distance reached, in [m].
        closest_time: When that was, in [s].
        switches: Times at which a law changed its piece, in [s].
        sides: Side at the start and after each switch.
    """

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
        """Evaluate r [m], a, psi, line of sight [rad], pursuer x, y [m].

        Args:
            times: Times between 0 and ``end_time``, in [s]. Shape (n,).

        Returns:
            States. Shape (n, 6). The bearing psi may lie outside
            [-pi, pi] by less than a turn.
        """
        asked = np.atleast_1d(np.asarray(times, dtype=np.float64))
        last = len(self._pieces) - 1
        index = np.searchsorted(self.times, asked, side="right") - 1
        index = np.clip(index, 0, last)
        pairs = zip(asked, index, strict=True)
        return np.array([self._pieces[i](t) for t, i in pairs])

    def poses(self, times: ArrayLike) -> tuple[Array, Array]:
        """Evaluate the poses of pursuer and evader; shape (n, 3) each."""
        return world_poses(self.states(times))


@dataclass
class _Play:
    """State of a game under way."""

    game: Game
    capture: float
    side: int = 0
    branch: int = 0
    numbers: tuple[float, float, float, float, float] = (0, 0, 0, 0, 0)

    def set_piece(self, side: int, branch: int) -> None:
        game = self.game
        self.side, self.branch = side, branch
        self.numbers = piece(
            side,
            branch,
            game.angle,
            game.hysteresis,
            game.keeps_side,
            game.evader.gain,
        )

    def sight_rate(self, state: Array) -> Any:
        vp, ve = self.game.pursuer.speed, self.game.evader.speed
        return (vp * np.sin(state[1]) - ve * np.sin(state[2])) / state[0]

    def closing(self, state: Array) -> Any:
        """Rate of the distance, in [m/s]."""
        vp, ve = self.game.pursuer.speed, self.game.evader.speed
        return ve * np.cos(state[2]) - vp * np.cos(state[1])

    def rates(self, _: float, state: Array) -> list[float]:
        """Rates of (r, a, psi, line of sight, x, y)."""
        r, a, psi, sight, _x, _y = state.tolist()
        vp, ve = self.game.pursuer.speed, self.game.evader.speed
        _, _, c0, c1, c2 = self.numbers
        omega = (vp * sin(a) - ve * sin(psi)) / r
        heading = sight - a
        return [
            ve * cos(psi) - vp * cos(a),
            omega - self.game.pursuer.gain * a,
            (1.0 - c2) * omega - c1 * psi - c0,
            omega,
            vp * cos(heading),
            vp * sin(heading),
        ]

    def margins(self, state: Array) -> Array:
        """Distances to the edges: capture, a, low, high, end of sliding."""
        r, a, psi = state[0], state[1], state[2]
        low, high = self.numbers[:2]
        free = np.full_like(r, np.inf)
        if self.branch == SLIDING:
            free = self.game.evader.gain - np.abs(self.sight_rate(state))
        edges = [r - self.capture, pi - np.abs(a), psi - low, high - psi]
        return np.stack([*edges, free])

    def switch(self, state: Array, edge: int) -> Array:
        """Pass an edge; return the state on the other side."""
        state = state.copy()
        if edge == 1:
            state[1] -= 2.0 * pi * np.sign(state[1])
            return state
        bearing, side, branch = leave(
            float(state[2]),
            float(self.sight_rate(state)),
            self.side,
            self.branch,
            -1 if edge == 2 else 1,
            self.game.angle,
            self.game.keeps_side,
            self.game.evader.gain,
        )
        state[2] = bearing
        self.set_piece(side, branch)
        return state


def simulate(
    game: Game,
    start: Start,
    duration: float,
    *,
    side: int | None = None,
    capture_distance: float = 1e-6,
    pursuer: Pose = Pose(0.0, 0.0, 0.0),  # noqa: B008 (immutable)
    tolerance: float = 1e-11,
) -> Run:
    """Play one game.

    Args:
        game: Parameters of the game.
        start: Relative coordinates at the start.
        duration: Time after which the game ends, in [s].
        side: Side at the start, +1 or -1; the one behind the evader if None.
        capture_distance: Distance at which the game ends, in [m].
        pursuer: Pose of the pursuer at the start.
        tolerance: Relative error allowed to each step; the absolute one is
            a tenth of it.

    Returns:
        The game played, with dense output.

    Raises:
        PlanError: If a duration or distance is not finite and positive.
        StepAsideError: If the integrator gives up.
    """
    from scipy.integrate import DOP853
    from scipy.optimize import brentq

    check_positive(duration, "duration", "s")
    check_positive(capture_distance, "capture_distance", "m")
    play = _Play(game, capture_distance)
    r, a, psi = start.wrapped()
    state = np.array([r, a, psi, pursuer.theta + a, pursuer.x, pursuer.y])
    state[2], first, branch = enter(
        psi,
        float(play.sight_rate(state)),
        side or 0,
        game.angle,
        game.keeps_side,
        game.saturated,
        game.evader.gain,
    )
    play.set_piece(first, branch)
    times, pieces, switches, sides = [0.0], [], [], [first]
    best, captured = (r, 0.0), r <= capture_distance
    time = 0.0
    longest = 4.0 / max(game.pursuer.gain, game.evader.gain)

    def solver() -> Any:
        return DOP853(
            play.rates,
            time,
            state,
            duration,
            rtol=tolerance,
            atol=0.1 * tolerance,
            max_step=longest,
        )

    steps = solver()
    while not captured and time < duration:
        message = steps.step()
        if message:
            raise StepAsideError(f"integration stopped at {time} s: {message}")
        dense = steps.dense_output()
        end, state, edge = steps.t, steps.y, -1
        probes = time + (end - time) * _PROBES
        seen = dense(probes)
        margins = play.margins(seen)
        left = margins < -_SLACK
        if left.any():
            i = int(np.argmax(left.any(axis=0)))
            for e in np.flatnonzero(left[:, i]).tolist():
                hit = float(probes[i - 1])
                if margins[e, i - 1] > 0.0:
                    hit = brentq(
                        lambda t, e=e, d=dense: play.margins(d(t))[e],
                        probes[i - 1],
                        probes[i],
                        xtol=1e-14 * max(1.0, end),
                    )
                if edge < 0 or hit < end:
                    end, edge = hit, e
            state = dense(end)
        best = min(best, _closest(play, dense, probes, end, brentq))
        times.append(end)
        pieces.append(dense)
        time = end
        captured = edge == 0
        if edge > 0:
            state = play.switch(state, edge)
            switches.append(time)
            sides.append(play.side)
            steps = solver()
    if not pieces:
        constant = state.copy()
        pieces.append(lambda _: constant)
        times.append(time)
    return Run(
        game,
        np.array(times),
        captured,
        time,
        best[0],
        best[1],
        tuple(switches),
        tuple(sides),
        tuple(pieces),
    )


def _closest(
    play: _Play, dense: Any, probes: Array, end: float, solve: Any
) -> tuple[float, float]:
    """Least distance of one step and its time."""
    times = np.append(probes[probes < end], end)
    states = dense(times)
    best = (float(states[0, -1]), float(end))
    rates = play.closing(states)
    for i in np.flatnonzero((rates[:-1] < 0.0) & (rates[1:] > 0.0)).tolist():
        when = solve(lambda t: play.closing(dense(t)), times[i], times[i + 1])
        best = min(best, (float(dense(when)[0]), float(when)))
    return best
