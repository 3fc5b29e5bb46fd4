"""What every way to a robot has in common."""

from ..errors import StepAsideError


class SessionLost(StepAsideError, ConnectionError):
    """The robot cannot be heard or reached any more."""
