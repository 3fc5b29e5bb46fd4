"""Cost of the live page, the offline page and videos."""

from collections.abc import Mapping
from typing import Any

from .markdown import table


def figures(viewer: Mapping[str, Any], replay: Mapping[str, Any]) -> str:
    """List speed of the live duel, time of a video, sizes of files."""
    live, files = viewer["live"], replay["files"]

    def speed(name: str) -> str:
        found = live[name]
        text = f"{found['real_time_factor']:.3g} x real time"
        if found["updates_per_s"] is None:
            return text
        return f"{text}, {found['updates_per_s']:.0f} updates a second"

    def size(name: str, usual: str) -> str:
        """Return the requested width and height."""
        words = files[name].get("options", "").split()
        asked = dict(zip(words[::2], words[1::2], strict=True))
        if "--width" not in asked:
            return usual
        return f"{asked['--width']}x{asked['--height']}"

    return table(
        ("what", "measured"),
        [
            ("duel as fast as it goes, no page open", speed("alone")),
            ("the same, one page open", speed("one_page")),
            ("at speed 1, one page open", speed("real_time")),
            (
                f"film of 60 s, {size('video', '640x480')}, "
                "30 pictures a second",
                f"{files['video']['wall_s']:.0f} s, "
                f"{files['video']['bytes'] / 1e6:.1f} MB",
            ),
            (
                "page from disk, 120 s",
                f"{files['html']['bytes'] / 1e6:.1f} MB",
            ),
            (
                f"GIF of 16 s of a run, {size('gif', '320x240')}",
                f"{files['gif']['bytes'] / 1e6:.1f} MB",
            ),
        ],
    )
