"""Verification of a robot: static requirements and walk trials."""

from collections.abc import Callable, Iterable
from concurrent.futures import Executor
from typing import Any, NamedTuple

from ..robots.description import RobotDescription
from .joint_strain import JointStrain
from .requirements import RequirementCheck, check_requirements
from .walk_trials import WalkTrialResult, trials_of, walk_trial

GREATEST_SAG = 0.02  # of the CoM while standing, in [m]
# Unsteadiness up to which the circle is within 5 % of theory.
ACCURATE = 0.35
GREATEST_LOAD = 0.9  # of a torque limit


class VerificationReport(NamedTuple):
    """Result of a verification.

    Attributes:
        findings: Results of the checks.
        walks: Walk trials, open loop and with feedback; empty if the robot
            cannot stand.
        feedback: Whether the description uses feedback.
    """

    findings: tuple[RequirementCheck, ...]
    walks: tuple[WalkTrialResult, ...]
    feedback: bool

    @property
    def passes(self) -> bool:
        """Whether no check failed and the described walks are steady."""
        own = [w for w in self.walks if w.feedback == self.feedback]
        return (
            all(f.verdict != "fail" for f in self.findings)
            and bool(own)
            and all(walk.is_steady for walk in own)
        )

    def to_json(self) -> dict[str, Any]:
        """Return the report as values for JSON."""
        return {
            "passes": self.passes,
            "feedback": self.feedback,
            "findings": [finding._asdict() for finding in self.findings],
            "walks": [
                walk._asdict()
                | {
                    "steady": walk.is_steady,
                    "unsteadiness": walk.unsteadiness,
                    "strain": None
                    if walk.strain is None
                    else walk.strain._asdict(),
                }
                for walk in self.walks
            ],
        }


def check_robot(
    description: RobotDescription,
    executor: Executor,
    report: Callable[[int, int], None] | None = None,
) -> VerificationReport:
    """Check the requirements of a robot and run its walk trials.

    Args:
        description: Robot description.
        executor: Executor of the walks.
        report: Called with the number of finished walks and of all walks.
    """
    found = check_requirements(description)
    if any(finding.verdict == "fail" for finding in found):
        return VerificationReport(tuple(found), (), False)
    own = trials_of(description, feedback=False)
    trials = (*own, *trials_of(description, feedback=True))
    walks: list[WalkTrialResult] = []
    for walk in executor.map(walk_trial, trials):
        walks.append(walk)
        if report is not None:
            report(len(walks), len(trials))
    feedback = bool(description.control.get("feedback", False))
    found += _strains([w for w in walks if w.feedback == feedback])
    found += _walks(walks, feedback)
    return VerificationReport(tuple(found), tuple(walks), feedback)


def _strains(walks: Iterable[WalkTrialResult]) -> list[RequirementCheck]:
    """Check torques while standing and walking, and the sag of the CoM."""
    strains = [walk.strain for walk in walks if walk.strain is not None]
    if not strains:
        return []
    standing = max(strains, key=lambda s: s.standing)
    walking = max(strains, key=lambda s: s.walking)
    return [
        _torque(
            "torque, standing", standing.standing, standing.standing_joint
        ),
        _torque("torque, walking", walking.walking, walking.walking_joint),
        _sag(standing),
    ]


def _torque(name: str, load: float, joint: str) -> RequirementCheck:
    high = load > GREATEST_LOAD
    return RequirementCheck(
        name,
        "warn" if high else "pass",
        f"{100.0 * load:.0f} % of the limit of {joint}",
        f"see the torque limit of {joint}, or reduce gait.stride and "
        "gait.speed"
        if high
        else "",
    )


def _sag(strain: JointStrain) -> RequirementCheck:
    high = strain.sag > GREATEST_SAG
    return RequirementCheck(
        "sag",
        "warn" if high else "pass",
        f"{1e3 * strain.sag:.1f} mm",
        "raise the stiffness of the leg servos" if high else "",
    )


def _walks(
    walks: Iterable[WalkTrialResult], feedback: bool
) -> list[RequirementCheck]:
    """Check the walks with and without feedback, the described ones first."""
    results = []
    for with_feedback in (feedback, not feedback):
        described = with_feedback is feedback
        own = [walk for walk in walks if walk.feedback is with_feedback]
        failed = [walk for walk in own if not walk.is_steady]
        name = "walks with feedback" if with_feedback else "walks open loop"
        if not failed:
            worst = max(own, key=lambda walk: walk.unsteadiness)
            text = f"all steady, at worst {worst.unsteadiness:.2f} of 1"
            inaccurate = described and worst.unsteadiness > ACCURATE
            hint = "`stepaside robot tune` searches for a more accurate gait"
            verdict = "warn" if inaccurate else "pass"
            results.append(
                RequirementCheck(
                    name, verdict, text, hint if inaccurate else ""
                )
            )
            continue
        worst = max(failed, key=lambda walk: walk.unsteadiness)
        verdict = "fail" if described else "warn"
        hint = "`stepaside robot tune` searches for a gait that walks"
        if not described:
            hint = "the description does not use it"
        text = f"{len(failed)} of {len(own)} unsteady, worst {worst.way}: "
        if worst.completed:
            text += f"{worst.unsteadiness:.2f} of 1"
        else:
            text += worst.message
        results.append(RequirementCheck(name, verdict, text, hint))
    return results
