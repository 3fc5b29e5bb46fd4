"""Parser of ROS 2 namespaces on the command line."""

import re

from ...core.errors import ConfigurationError

SCHEME = "ros2:"
_NAME = re.compile(r"(/[A-Za-z_][A-Za-z0-9_]*)*")


def parse_namespace(text: str) -> str:
    """Parse ``/NAMESPACE``, with or without the prefix ``ros2:``.

    Returns:
        The namespace with a leading slash; empty for the root.

    Raises:
        ConfigurationError: If it is not a valid ROS 2 namespace.
    """
    name = text.removeprefix(SCHEME).rstrip("/")
    name = name if not name or name.startswith("/") else f"/{name}"
    if not _NAME.fullmatch(name):
        raise ConfigurationError(
            "namespace must be /WORD or /WORD/WORD of letters, digits and "
            f"underscores, got {text!r}"
        )
    return name
