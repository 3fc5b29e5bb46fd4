"""Depth images of posts and walls on a floor, by plane geometry."""

from collections.abc import Sequence

import numpy as np

from stepaside.core.poses import Array
from stepaside.perception.camera_model import CameraModel
from stepaside.perception.images import DepthImage, Pixels

NEAR, FAR = 0.8, 3.5
Post = tuple[float, float, float, float]  # x, y, radius, height
Wall = tuple[float, float]  # where its normal points [rad], how far it is


def draw(
    camera: CameraModel,
    place: Array,
    axes: Array,
    posts: Sequence[Post] = (),
    walls: Sequence[Wall] = (),
    time: float = 0.0,
) -> DepthImage:
    """Depth image of a camera at a pose, without noise."""
    rays = camera.rays() @ axes.T
    with np.errstate(divide="ignore"):
        depth = np.where(rays[..., 2] < 0.0, -place[2] / rays[..., 2], np.inf)
    for x, y, radius, height in posts:
        x, y = x - place[0], y - place[1]
        a = rays[..., 0] ** 2 + rays[..., 1] ** 2
        b = rays[..., 0] * x + rays[..., 1] * y
        root = b**2 - a * (x * x + y * y - radius**2)
        hit = (b - np.sqrt(np.maximum(root, 0.0))) / a
        level = place[2] + hit * rays[..., 2]
        there = (root > 0.0) & (hit > 0.0) & (level > 0.0) & (level < height)
        depth = np.where(there, np.minimum(depth, hit), depth)
    for angle, away in walls:
        normal = np.array([np.cos(angle), np.sin(angle)])
        with np.errstate(divide="ignore"):
            hit = (away - normal @ place[:2]) / (rays[..., :2] @ normal)
        depth = np.where(hit > 0.0, np.minimum(depth, hit), depth)
    depth = np.where((depth < NEAR) | (depth > FAR), 0.0, depth)
    return DepthImage(time, camera, depth.astype(np.float32), NEAR, FAR)


def paint(
    camera: CameraModel,
    place: Array,
    axes: Array,
    posts: Sequence[Post] = (),
    noise: float = 4.0,
) -> Pixels:
    """Colours of the same scene: a light chequered floor, dark posts."""
    rays = camera.rays() @ axes.T
    with np.errstate(divide="ignore"):
        floor = np.where(rays[..., 2] < 0.0, -place[2] / rays[..., 2], 1e3)
    points = place[:2] + floor[..., None] * rays[..., :2]
    tiles = np.floor(points / 0.5).astype(int).sum(axis=2) % 2
    tone = np.where(rays[..., 2] < 0.0, 219.0 - 15.0 * tiles, 190.0)
    for x, y, radius, height in posts:
        x, y = x - place[0], y - place[1]
        a = rays[..., 0] ** 2 + rays[..., 1] ** 2
        b = rays[..., 0] * x + rays[..., 1] * y
        root = b**2 - a * (x * x + y * y - radius**2)
        hit = (b - np.sqrt(np.maximum(root, 0.0))) / a
        level = place[2] + hit * rays[..., 2]
        there = (root > 0.0) & (hit > 0.0) & (level > 0.0) & (level < height)
        tone = np.where(there & (hit < floor), 64.0, tone)
    grain = np.random.default_rng(1).normal(0.0, noise, (*tone.shape, 3))
    pixels: Pixels = np.clip(tone[..., None] + grain, 0, 255).astype(np.uint8)
    return pixels
