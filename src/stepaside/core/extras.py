"""Optional parts: what brings each."""

EXTRAS = {  # as ``pyproject.toml`` has them; names as they are imported
    "fast": ("numba",),
    "mpc": ("daqp",),
    "robot": ("msgpack",),
    "naoqi": ("msgpack", "qi"),
    "ros2": ("cyclonedds",),
    "viewer": ("av", "msgspec", "trimesh", "viser", "websockets"),
    "vision": ("cv2",),
}


def remedy(error: ModuleNotFoundError) -> str:
    """What to do about a module that is not installed, in one line.

    Args:
        error: Of the import.
    """
    missing = (error.name or str(error)).partition(".")[0]
    extra = next((e for e, names in EXTRAS.items() if missing in names), "")
    wanted = f"'stepaside[{extra}]'" if extra else "stepaside"
    return (
        f"this needs {missing}, which is not installed: pip install {wanted}"
    )
