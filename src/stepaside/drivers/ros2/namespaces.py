"""Namespaces of robots on ROS 2 topics."""

import re

from ...core.errors import ConfigurationError

SCHEME = "ros2:"
_NAME = re.compile(r"(/[A-Za-z_][A-Za-z0-9_]*)*")


def parse_namespace(text: str) -> str:
    """Read ``/NAMESPACE``, with or without ``ros2:`` before it.

    Returns:
        The namespace with a slash before it; empty for the root.

    Raises:
        ConfigurationError: If no topic could be called so.
    """
    name = text.removeprefix(SCHEME).rstrip("/")
    name = name if not name or name.startswith("/") else f"/{name}"
    if not _NAME.fullmatch(name):
        raise ConfigurationError(
            "namespace must be /WORD or /WORD/WORD of letters, digits and "
            f"underscores, got {text!r}"
        )
    return name
