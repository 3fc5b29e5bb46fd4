"""Optional dependencies, and the extra that installs each."""

EXTRAS = {  # as in ``pyproject.toml``, with the names of the modules
    "dask": ("distributed",),
    "export": ("polars", "rosbags"),
    "learn": ("gymnasium", "pettingzoo"),
    "legs": ("onnx", "onnxruntime", "yaml"),
    "mpc": ("daqp",),
    "robot": ("cyclonedds", "msgpack", "qi", "rosbags"),
    "viewer": ("av", "trimesh", "viser", "websockets"),
    "vision": ("cv2",),
}


def install_hint(error: ModuleNotFoundError) -> str:
    """Return a message with the command that installs a missing module."""
    missing = (error.name or str(error)).partition(".")[0]
    extra = next((e for e, names in EXTRAS.items() if missing in names), "")
    package = f"'stepaside[{extra}]'" if extra else "stepaside"
    return (
        f"this needs {missing}, which is not installed: pip install {package}"
    )
