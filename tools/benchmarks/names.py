"""Names of pursuers at another speed than the evader's."""


def name_and_speed(text: str) -> tuple[str, float]:
    """Return name and relative speed of NAME or NAME@RATIO."""
    name, _, ratio = text.partition("@")
    return name, float(ratio or 1.0)
