"""Whether a robot plays: what it has, and how it walks."""

from collections.abc import Callable, Iterable
from concurrent.futures import Executor
from typing import Any, NamedTuple

from ..robots.description import RobotDescription
from .joint_strain import JointStrain
from .requirements import RequirementCheck, findings_of
from .walk_trials import WalkTrialResult, trials_of, walk_trial

SAGS = 0.02  # of the CoM's height that is much
NARROW = 0.35  # unsteadiness of a walk whose circle is within 5 % of theory's
TORQUE = 0.9  # share of a torque limit that leaves little


class VerificationReport(NamedTuple):
    """What a check found.

    Attributes:
        findings: Of the robot as it stands.
        walks: Its short walks, open loop and with feedback; none if it
            cannot stand.
        feedback: Whether its description asks for feedback.
    """

    findings: tuple[RequirementCheck, ...]
    walks: tuple[WalkTrialResult, ...]
    feedback: bool

    @property
    def passes(self) -> bool:
        """Whether it plays: all it has is right, and it walks as described."""
        own = [w for w in self.walks if w.feedback == self.feedback]
        return (
            all(f.verdict != "fail" for f in self.findings)
            and bool(own)
            and all(walk.is_steady for walk in own)
        )

    def to_json(self) -> dict[str, Any]:
        """Plain values by name."""
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
    """Look at a robot, and let it walk.

    Args:
        description: The robot.
        executor: Where the walks are walked.
        report: Called with how many are done, and how many there are.
    """
    found = findings_of(description)
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
    """Torques while standing and walking, and what the joints sag."""
    strains = [walk.strain for walk in walks if walk.strain is not None]
    if not strains:
        return []
    stood = max(strains, key=lambda s: s.standing)
    walked = max(strains, key=lambda s: s.walking)
    return [
        _torque("torque, standing", stood.standing, stood.standing_joint),
        _torque("torque, walking", walked.walking, walked.walking_joint),
        _sag(stood),
    ]


def _torque(name: str, share: float, joint: str) -> RequirementCheck:
    much = share > TORQUE
    return RequirementCheck(
        name,
        "warn" if much else "pass",
        f"{100.0 * share:.0f} % of the limit of {joint}",
        f"see the torque of {joint}, or shorten gait.stride and gait.speed"
        if much
        else "",
    )


def _sag(strain: JointStrain) -> RequirementCheck:
    much = strain.sag > SAGS
    return RequirementCheck(
        "sag",
        "warn" if much else "pass",
        f"{1e3 * strain.sag:.1f} mm",
        "raise the stiffness of the legs' servos" if much else "",
    )


def _walks(
    walks: Iterable[WalkTrialResult], feedback: bool
) -> list[RequirementCheck]:
    """One finding for each way of control, the described one first."""
    found = []
    for way in (feedback, not feedback):
        own = [walk for walk in walks if walk.feedback is way]
        failed = [walk for walk in own if not walk.is_steady]
        name = "walks with feedback" if way else "walks open loop"
        if not failed:
            worst = max(own, key=lambda walk: walk.unsteadiness)
            text = f"all steady, at worst {worst.unsteadiness:.2f} of 1"
            wide = way is feedback and worst.unsteadiness > NARROW
            hint = "`stepaside robot tune` looks for what keeps to the plan"
            verdict = "warn" if wide else "pass"
            found.append(
                RequirementCheck(name, verdict, text, hint if wide else "")
            )
            continue
        worst = max(failed, key=lambda walk: walk.unsteadiness)
        verdict = "fail" if way is feedback else "warn"
        hint = "`stepaside robot tune` looks for what walks"
        if way is not feedback:
            hint = "the description does not ask for it"
        said = f"{len(failed)} of {len(own)} unsteady, worst {worst.way}: "
        if worst.completed:
            said += f"{worst.unsteadiness:.2f} of 1"
        else:
            said += worst.message
        found.append(RequirementCheck(name, verdict, said, hint))
    return found
