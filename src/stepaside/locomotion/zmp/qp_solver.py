"""Optional solver of quadratic programs."""

from functools import cache
from typing import Any

from ...core.errors import ConfigurationError


@cache
def load_solver() -> Any:
    """Import the solver of quadratic programs.

    Raises:
        ConfigurationError: If it is not installed.
    """
    try:
        import daqp
    except ImportError as error:
        raise ConfigurationError(
            "method 'mpc' needs the solver daqp: pip install 'stepaside[mpc]'"
        ) from error
    return daqp
