"""Layout with which Foxglove, or Lichtblick, opens a recording."""

import json
from pathlib import Path
from typing import Any

from ...perception.images import ColourImage
from ..palette import colours_in
from .recording import Recording

GRID = {
    "layerId": "foxglove.Grid",
    "instanceId": "grid",
    "label": "Floor",
    "visible": True,
    "frameId": "map",
    "size": 10,
    "divisions": 20,
    "lineWidth": 1,
    "color": "#9a9a9a80",
    "position": [0, 0, 0],
    "rotation": [0, 0, 0],
}
# Points: name of the topic, colour.
MARKS = (("com", "#5b2a86"), ("zmp", "#e0a400"))


def write_layout(file: Path, recording: Recording) -> None:
    """Write a layout: the scene, the cameras, distance and joints.

    Args:
        file: JSON file, which Foxglove imports.
        recording: The recording.
    """
    panels: dict[str, Any] = {"3D!scene": _scene(recording)}
    plots = list(_plots(recording))
    images = list(_images(recording))
    for name, panel in plots + images:
        panels[name] = panel
    right = _stack([name for name, _ in images + plots], "column")
    layout = {
        "configById": panels,
        "globalVariables": {},
        "userNodes": {},
        "playbackConfig": {"speed": 1},
        "layout": {
            "first": "3D!scene",
            "second": right,
            "direction": "row",
            "splitPercentage": 60,
        },
    }
    text = json.dumps(layout, indent=2) + "\n"
    file.write_text(text, encoding="utf-8")


def _stack(names: list[str], direction: str) -> Any:
    """Return panels one beside the other, of equal size."""
    if len(names) == 1:
        return names[0]
    return {
        "first": names[0],
        "second": _stack(names[1:], direction),
        "direction": direction,
        "splitPercentage": 100.0 / len(names),
    }


def _scene(recording: Recording) -> dict[str, Any]:
    colours = colours_in("light", recording.run.players)
    layers: dict[str, Any] = {"grid": GRID, "room": _urdf_layer("room")}
    topics: dict[str, Any] = {}
    transforms: dict[str, Any] = {}
    for name in recording.run.players:
        for part, alpha in (("planned", "60"), ("landed", "c0")):
            topics[f"/{name}/footsteps/{part}"] = {
                "visible": True,
                "colorMode": "flat",
                "flatColor": colours[name] + alpha,
                "pointSize": 3,
            }
        for mark, colour in MARKS:
            topics[f"/{name}/{mark}"] = {
                "visible": True,
                "type": "axis",
                "axisScale": 0.08,
                "color": colour,
            }
        transforms[f"frame:{name}/base_footprint"] = {"visible": True}
    for name, model in recording.models.items():
        layers[name] = _urdf_layer(name)
        for link in model.tree.links:
            transforms[f"frame:{name}/{link.name}"] = {"visible": False}
    return {
        "followTf": "map",
        "followMode": "follow-none",
        "cameraState": {
            "perspective": True,
            "distance": 3.5,
            "phi": 55,
            "thetaOffset": 30,
            "target": [0, 0, 0],
            "targetOffset": _center(recording),
            "targetOrientation": [0, 0, 0, 1],
            "fovy": 45,
            "near": 0.05,
            "far": 500,
        },
        "scene": {"transforms": {"showLabel": False, "axisScale": 0.2}},
        "topics": topics,
        "transforms": transforms,
        "layers": layers,
        "imageMode": {},
    }


def _urdf_layer(name: str) -> dict[str, Any]:
    return {
        "layerId": "foxglove.Urdf",
        "instanceId": name,
        "label": name,
        "visible": True,
        "sourceType": "topic",
        "topic": f"/{name}/robot_description",
        "displayMode": "visual",
    }


def _center(recording: Recording) -> list[float]:
    """Return the middle of all paths, in [m]."""
    tracks = recording.run.tracks.values()
    means = [track.unicycle[:, :2].mean(axis=0) for track in tracks]
    x, y = (sum(means) / len(means)).tolist()
    return [round(x, 3), round(y, 3), 0.2]


def _plot(title: str, paths: dict[str, tuple[str, str]]) -> dict[str, Any]:
    """Return a plot over time: path by label, with its colour."""
    return {
        "title": title,
        "foxglovePanelTitle": title,
        "paths": [
            {
                "value": path,
                "label": label,
                "color": colour,
                "enabled": True,
                "timestampMethod": "receiveTime",
            }
            for label, (path, colour) in paths.items()
        ],
        "showLegend": True,
        "legendDisplay": "floating",
        "showXAxisLabels": True,
        "showYAxisLabels": True,
        "isSynced": True,
        "xAxisVal": "timestamp",
    }


def _plots(recording: Recording) -> list[tuple[str, dict[str, Any]]]:
    run = recording.run
    colours = colours_in("light", run.players)
    found = []
    if run.pair is not None:
        paths = {"distance [m]": ("/distance_m.data", "#222222")}
        if run.has_orientation:
            paths["angle [rad]"] = ("/angle_rad.data", "#888888")
        found.append(("Plot!distance", _plot("Distance and angle", paths)))
    heights = {
        f"{name} CoM z [m]": (f"/{name}/com.pose.position.z", colours[name])
        for name in recording.models
    }
    forces = {
        f"{name} {side} sole [N]": (
            f"/{name}/{side}_sole/wrench.wrench.force.z",
            colours[name] if side == "l" else "#999999",
        )
        for name in recording.models
        if name in recording.signals
        for side in "lr"
    }
    if forces:
        found.append(("Plot!forces", _plot("Foot forces", forces)))
    if heights:
        found.append(("Plot!com", _plot("Height of the CoM", heights)))
    return found


def _images(recording: Recording) -> list[tuple[str, dict[str, Any]]]:
    found = []
    for name, signals in recording.signals.items():
        if any(isinstance(image, ColourImage) for image in signals.images):
            topic = f"/{name}/camera/image_raw/compressed"
            calibration = f"/{name}/camera/camera_info"
            mode = {"imageTopic": topic, "calibrationTopic": calibration}
            found.append((f"Image!{name}", {"imageMode": mode}))
    return found
