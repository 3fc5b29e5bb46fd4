"""Independent oracle: two unicycles whose turning rates are held."""

from math import atan2, hypot, pi, sin

import numpy as np

from stepaside.theory.unicycle import RelativeStart, Unicycles


def wrap(angle: float) -> float:
    return (angle + pi) % (2.0 * pi) - pi


def drive(pose: np.ndarray, speed: float, turn: float, span: float) -> None:
    """Move a pose in place by the chord of an arc."""
    half = 0.5 * turn * span
    chord = speed * span * (sin(half) / half if half else 1.0)
    pose += (
        chord * np.cos(pose[2] + half),
        chord * np.sin(pose[2] + half),
        2.0 * half,
    )


def play_sampled(
    game: Unicycles,
    start: RelativeStart,
    duration: float,
    period: float,
    delay: float = 0.0,
) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    """Return states (n + 1, 3), rates (n, 2) and poses of both (n + 1, 3).

    The side is the one behind the evader. Rates take effect after the delay;
    until then both drive straight.
    """
    pursuer, evader = (np.array(pose, float) for pose in start.poses())
    whole = int(delay / period + 1e-12)
    late = max(0.0, delay - whole * period)
    queue = [(0.0, 0.0)] * (whole + 1)
    states, rates, paths = [], [], [(pursuer.copy(), evader.copy())]
    for n in range(round(duration / period) + 1):
        dx, dy = (evader - pursuer)[:2]
        sight = atan2(dy, dx)
        a, psi = wrap(sight - pursuer[2]), wrap(sight + pi - evader[2])
        states.append((hypot(dx, dy), a, psi))
        if n == round(duration / period):
            break
        b = wrap(psi + (-game.angle if psi > 0.0 else game.angle))
        rates.append((game.pursuer_gain * a, game.evader_gain * b))
        queue.append(rates[-1])
        for turns, span in ((queue[0], late), (queue[1], period - late)):
            drive(pursuer, game.pursuer_speed, turns[0], span)
            drive(evader, -game.evader_speed, turns[1], span)
        queue.pop(0)
        paths.append((pursuer.copy(), evader.copy()))
    return (
        np.array(states),
        np.array(rates),
        *np.swapaxes(np.array(paths), 0, 1),
    )
