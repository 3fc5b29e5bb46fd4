"""What a campaign found, as tables."""

from typing import Any

from .terminal import echo


def words_of_done(answer: dict[str, Any]) -> str:
    """How far a campaign came."""
    done, planned = answer["done"], answer["planned"]
    return (
        f"{done['trials']} of {planned['trials']} trials and "
        f"{done['push_limits']} of {planned['push_limits']} limits of pushes"
    )


def print_campaign(answer: dict[str, Any]) -> None:
    """Print survival, then the largest pushes."""
    from ..studies.robustness import UNITS

    head = ("method", "disturbance", "strength", "survived", "95 %")
    echo("{:<12} {:<16} {:>10} {:>9}  {}".format(*head))
    for row in answer["survival"]:
        kind = f"{row['kind']} {row['direction']}".strip()
        echo(
            f"{row['method']:<12} {kind:<16} {row['strength']:>10g} "
            f"{row['survived']:>4}/{row['trials']:<4}  "
            f"{100 * row['low']:.0f}-{100 * row['high']:.0f} %"
            f"   [{UNITS[row['kind']]}]"
        )
    if answer["limits"]:
        _print_limits(answer["limits"], answer["limits_by_method"])


def _print_limits(
    limits: list[dict[str, Any]], by_method: dict[str, Any]
) -> None:
    echo("\nlargest push survived / pendulum's bound [N s], by phase")
    for method in dict.fromkeys(r["method"] for r in limits):
        for direction in dict.fromkeys(r["direction"] for r in limits):
            cells = " ".join(
                f"{r['limit_n_s']:.1f}/{r['bound_n_s']:.1f}"
                for r in limits
                if (r["method"], r["direction"]) == (method, direction)
            )
            echo(f"{method:<12} {direction:<9} {cells}")
    echo("\nmeasured over the pendulum's bound: median, least, most; above it")
    for method, found in by_method.items():
        echo(
            f"{method:<12} {found['median_of_bound']:.2f} "
            f"{found['least_of_bound']:.2f} {found['most_of_bound']:.2f}  "
            f"{found['above_bound']} of {found['cases']}"
        )
