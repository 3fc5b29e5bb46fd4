"""Settings of learned legs."""

from dataclasses import dataclass

from ...core.setting import check_settings, setting


@dataclass(frozen=True, slots=True)
class LegsSettings:
    """Walking policy of a robot, in place of the paper's walk."""

    network: str = setting(
        "",
        "ONNX file of a walking policy; empty for the paper's walk",
    )
    contract: str = setting(
        "",
        "Convention of the policy's trainer, as in docs/legs.md; empty to "
        "recognise it",
    )
    learn: bool = setting(
        True,
        "Correct the velocity of a walking policy by gyro and leg odometry",
    )

    def __post_init__(self) -> None:
        """Check the ranges."""
        check_settings(self)

    @property
    def walks(self) -> bool:
        """Whether the robot walks by a policy."""
        return bool(self.network)
