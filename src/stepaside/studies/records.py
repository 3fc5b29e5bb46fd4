"""Record of one case of a study."""

from typing import Any

Record = dict[str, Any]
"""Measured values by name, as values for JSON."""
