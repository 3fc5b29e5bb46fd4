"""Limit circle of pursuer and evader, from the equilibrium equations."""

from dataclasses import dataclass
from math import acos, atan2, cos, nan, pi, sin

from ...core.poses import wrap_angle
from .root_finding import sign_changes
from .stability import jacobian, sorted_eigenvalues, time_constant
from .unicycle_game import Game, make_game, with_values


@dataclass(frozen=True, slots=True)
class Circle:
    """Limit set of the game: concentric circles of the two players.

    Given for side +1; side -1 has the mirror image. Quantities are NaN and
    ``eigenvalues`` is empty if no circle exists.

    Attributes:
        exists: Whether the circle exists.
        radius_pursuer_m: Radius of the pursuer's circle, in [m].
        radius_evader_m: Radius of the evader's circle, in [m].
        distance_m: Distance between the two, in [m].
        turning_rate_rad_s: Common turning rate, in [rad/s].
        headings_apart_rad: Angle between the headings, in [rad].
        motions_apart_rad: Angle between the directions of motion, in [rad].
        eigenvalues: Eigenvalues of the linearisation, slowest first, in
            [1/s].
        stable: Whether all of them have negative real part.
        time_constant_s: Time constant of the slowest mode, in [s]; inf if
            unstable.
        pursuer_error_rad: Error of the pursuer on the circle, in [rad].
        evader_error_rad: Error of the evader on the circle, in [rad].
        bearing_rad: Bearing of the pursuer in the evader's frame, not
            wrapped: the evader's error minus the angle, in [rad].
        sliding: Whether the saturated evader slides on zero error.
    """

    exists: bool
    radius_pursuer_m: float = nan
    radius_evader_m: float = nan
    distance_m: float = nan
    turning_rate_rad_s: float = nan
    headings_apart_rad: float = nan
    motions_apart_rad: float = nan
    eigenvalues: tuple[complex, ...] = ()
    stable: bool = False
    time_constant_s: float = nan
    pursuer_error_rad: float = nan
    evader_error_rad: float = nan
    bearing_rad: float = nan
    sliding: bool = False

    @property
    def direction(self) -> int:
        """Sign of the turning rate: +1 for the main sense, 0 for none."""
        return (self.turning_rate_rad_s > 0) - (self.turning_rate_rad_s < 0)

    @property
    def behind(self) -> bool:
        """Whether side +1 is the one behind the evader on the circle.

        If not, only an evader that keeps its side can stay on the circle.
        """
        return -pi < self.bearing_rad < 0.0


def circle_of(game: Game) -> Circle:
    r"""Find the main circle: the slowest with a positive rate at side +1.

    The rate solves :math:`v_e \cos(\alpha - b) = v_p \cos a` with
    :math:`a = \omega / k_p` and :math:`b = \omega / k_e` (4), or
    :math:`\omega = k_e` or :math:`b = 0` (6). The side rule ``BEHIND``
    requires :math:`b < \alpha`, ``LATCHED`` only :math:`b \le \pi`.
    """
    find = _saturated_errors if game.saturated else _proportional_errors
    errors = find(game)
    if errors is None:
        return Circle(exists=False)
    turning = game.pursuer.gain * errors[0]
    # Beyond rounding: an evader that turns at its full rate does not slide.
    sliding = game.saturated and turning < game.evader.gain * (1.0 - 1e-12)
    return describe_circle(game, turning, *errors, sliding=sliding)


find_circle = with_values("find_circle", make_game, circle_of)
"""Variant of :func:`circle_of` with the parameters of ``make_game``."""


def describe_circle(
    game: Game,
    turning_rate: float,
    pursuer_error: float,
    evader_error: float,
    *,
    sliding: bool = False,
) -> Circle:
    """Compute every quantity of a circle from its rate and errors.

    Args:
        game: Parameters of the game.
        turning_rate: Common turning rate, in [rad/s].
        pursuer_error: Error of the pursuer, in [rad].
        evader_error: Error of the evader, in [rad].
        sliding: Whether the saturated evader slides on zero error.
    """
    vp, ve = game.pursuer.speed, game.evader.speed
    bearing = evader_error - game.angle
    distance = (vp * sin(pursuer_error) - ve * sin(bearing)) / turning_rate
    if not distance > 0.0:
        return Circle(exists=False)
    matrix = jacobian(game, distance, pursuer_error, bearing, sliding=sliding)
    eigenvalues = sorted_eigenvalues(matrix)
    motions = game.angle + pursuer_error - evader_error
    return Circle(
        exists=True,
        radius_pursuer_m=vp / abs(turning_rate),
        radius_evader_m=ve / abs(turning_rate),
        distance_m=distance,
        turning_rate_rad_s=turning_rate,
        headings_apart_rad=abs(wrap_angle(motions - pi)),
        motions_apart_rad=abs(wrap_angle(motions)),
        eigenvalues=eigenvalues,
        stable=eigenvalues[0].real < 0.0,
        time_constant_s=time_constant(eigenvalues),
        pursuer_error_rad=pursuer_error,
        evader_error_rad=evader_error,
        bearing_rad=bearing,
        sliding=sliding,
    )


def imbalance(game: Game, turning_rate: float) -> float:
    """Return the rate of the distance at a turning rate under (2), (4).

    The form avoids cancellation for equal speeds. The rate is in [m/s].
    """
    vp, ve = game.pursuer.speed, game.evader.speed
    a = turning_rate / game.pursuer.gain
    u = game.angle - turning_rate / game.evader.gain
    difference = -2.0 * sin(0.5 * (u + a)) * sin(0.5 * (u - a))
    return (ve - vp) * cos(a) + ve * difference


def _proportional_errors(game: Game) -> tuple[float, float] | None:
    """Return the errors (a, b) on the circle under (2) and (4), in [rad]."""
    kp, ke, alpha = game.pursuer.gain, game.evader.gain, game.angle
    vp, ve = game.pursuer.speed, game.evader.speed
    reach = pi if game.keeps_side else alpha
    if vp == ve and alpha > 0.0:
        turning = alpha / (1.0 / kp + 1.0 / ke)
    elif vp == ve and kp == ke:
        return None  # move back: both move along a straight line
    elif kp == ke and 0.0 < alpha < pi:
        excess = vp - ve + 2.0 * ve * sin(0.5 * alpha) ** 2
        turning = kp * atan2(excess, ve * sin(alpha))
    else:
        high = min(ke * reach, kp * pi)
        rates = sign_changes(lambda w: imbalance(game, w), 0.0, high)
        turning = next((w for w in rates if _is_distant(game, w)), nan)
    a, b = turning / kp, turning / ke
    if not (turning > 0.0 and a <= pi and b <= reach):
        return None
    if b == reach and not game.keeps_side:
        return None
    return a, b


def _is_distant(game: Game, turning_rate: float) -> bool:
    """Return whether the distance is positive at a turning rate."""
    a = turning_rate / game.pursuer.gain
    u = game.angle - turning_rate / game.evader.gain
    across = game.pursuer.speed * sin(a) + game.evader.speed * sin(u)
    return turning_rate > 0.0 and across > 1e-12 * game.pursuer.speed


def _saturated_errors(game: Game) -> tuple[float, float] | None:
    """Return the errors (a, b) on the circle under (2) and (6), in [rad].

    The evader either turns at its full rate, or slides on zero error at a
    lower rate; never both.
    """
    kp, ke, alpha = game.pursuer.gain, game.evader.gain, game.angle
    ratio = game.pursuer.speed / game.evader.speed
    full = ke / kp  # error of a pursuer that turns at the evader's full rate
    if full <= pi and abs(ratio * cos(full)) <= 1.0:
        error = alpha - acos(ratio * cos(full))
        if error >= 0.0 and full > 0.0:
            return full, error
    if abs(cos(alpha)) < ratio:
        sliding = alpha if ratio == 1.0 else acos(cos(alpha) / ratio)
        if 0.0 < sliding <= full:
            return sliding, 0.0
    return None
