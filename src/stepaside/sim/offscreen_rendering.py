"""Off-screen graphics, where the machine has any."""

import os
import subprocess
import sys
from collections.abc import Callable
from functools import lru_cache
from importlib import import_module
from typing import Any, NamedTuple

import mujoco
import numpy as np

from ..core.errors import ConfigurationError
from ..perception.images import Pixels
from .camera_settings import BACKENDS as BACKENDS
from .camera_settings import RAYCAST as RAYCAST
from .camera_settings import RENDERERS

PROBE = (
    "import mujoco; "
    "from stepaside.sim.offscreen_rendering import OffscreenRenderer; "
    'm = mujoco.MjModel.from_xml_string(\'<mujoco><worldbody><geom size="1"/>'
    "</worldbody></mujoco>'); OffscreenRenderer(m, 16, 16, {backend!r})"
)
GEOMS = 2000  # that a scene can hold
GRID = 10.0  # spacing of the vertices of a plane, in [m]


class RenderQuality(NamedTuple):
    """How much trouble is taken over a picture.

    Attributes:
        samples: Of each pixel, against jagged edges; 0 for one.
        shadow: Side of the map of shadows, in [pixels]; 0 for none.
        reach: Half side of the square that has shadows, in [m].
        slices: Of round shapes.
        stacks: Likewise, along their axes.
        groups: How many groups of shapes are drawn, from the first.
    """

    samples: int = 0
    shadow: int = 0
    reach: float = 1.0
    slices: int = 16
    stacks: int = 10
    groups: int = 3


PLAIN = RenderQuality()  # quick, for sensors


def choose_renderer(wanted: str = "auto") -> str:
    """Renderer of colour images on this machine.

    Graphics that do not work can end the process that tries them: another
    process tries.

    Args:
        wanted: "auto", or one of "egl", "osmesa" and "raycast". MUJOCO_GL
            narrows down what "auto" tries.

    Raises:
        ConfigurationError: If it does not work here.
    """
    if wanted == RAYCAST:
        return RAYCAST
    if wanted != "auto":
        if wanted not in BACKENDS:
            raise ConfigurationError(
                f"renderer must be one of {', '.join(RENDERERS)}, "
                f"got {wanted!r}"
            )
        if not _works(wanted):
            raise ConfigurationError(
                f"renderer {wanted} does not work on this machine; "
                "auto finds one that does"
            )
        return wanted
    asked = os.environ.get("MUJOCO_GL", "").lower()
    tried = BACKENDS if asked in ("", "glfw", "glx") else (asked,)
    for backend in tried:
        if backend in BACKENDS and _works(backend):
            return backend
    return RAYCAST


@lru_cache(maxsize=4)
def _works(backend: str) -> bool:
    environment = _environment(backend) | {"OPENBLAS_NUM_THREADS": "1"}
    probe = PROBE.format(backend=backend)
    try:
        done = subprocess.run(
            [sys.executable, "-c", probe],
            env=os.environ | environment,
            capture_output=True,
            timeout=60.0,
            check=False,
        )
    except (OSError, subprocess.TimeoutExpired):
        return False
    return done.returncode == 0


def _environment(backend: str) -> dict[str, str]:
    return {"MUJOCO_GL": backend, "PYOPENGL_PLATFORM": backend}


class OffscreenRenderer:
    """An off-screen picture of one size, that any camera can draw on."""

    def __init__(
        self,
        model: mujoco.MjModel,
        width: int,
        height: int,
        backend: str,
        look: RenderQuality = PLAIN,
    ) -> None:
        """Set up graphics; only ever one backend in a process."""
        os.environ.update(_environment(backend))
        context: Any = import_module(f"mujoco.{backend}").GLContext
        self._model = model
        self._gl = context(width, height)
        self._gl.make_current()
        quality = model.vis.quality
        quality.shadowsize, quality.offsamples = look.shadow, look.samples
        quality.numslices, quality.numstacks = look.slices, look.stacks
        if look.shadow:
            model.vis.map.shadowclip = look.reach / model.stat.extent
        # The third size of a plane is how fine its grid is drawn.
        planes = model.geom_type == mujoco.mjtGeom.mjGEOM_PLANE
        model.geom_size[planes, 2] = GRID
        model.vis.global_.offwidth = width
        model.vis.global_.offheight = height
        scale = mujoco.mjtFontScale.mjFONTSCALE_100
        self._context = mujoco.MjrContext(model, scale)
        offscreen = mujoco.mjtFramebuffer.mjFB_OFFSCREEN
        mujoco.mjr_setBuffer(offscreen, self._context)
        self._scene = mujoco.MjvScene(model, GEOMS)
        flags = self._scene.flags
        flags[mujoco.mjtRndFlag.mjRND_SHADOW] = look.shadow > 0
        flags[mujoco.mjtRndFlag.mjRND_REFLECTION] = 0
        self._option = mujoco.MjvOption()
        drawn = np.arange(len(self._option.geomgroup)) < look.groups
        self._option.geomgroup[:] = drawn
        self._area = mujoco.MjrRect(0, 0, width, height)
        self._pixels: Pixels = np.zeros((height, width, 3), dtype=np.uint8)

    def draw(
        self,
        data: mujoco.MjData,
        camera: int | mujoco.MjvCamera,
        decorate: Callable[[mujoco.MjvScene], None] | None = None,
    ) -> Pixels:
        """Draw what a camera sees. Shape (height, width, 3).

        Args:
            data: State of the model.
            camera: Number of a camera of the model, or one of its own.
            decorate: Adds to the scene before it is drawn.
        """
        self._gl.make_current()
        view = camera
        if isinstance(camera, int):
            view = mujoco.MjvCamera()
            view.type = mujoco.mjtCamera.mjCAMERA_FIXED
            view.fixedcamid = camera
        mujoco.mjv_updateScene(
            self._model,
            data,
            self._option,
            None,
            view,
            mujoco.mjtCatBit.mjCAT_ALL,
            self._scene,
        )
        if decorate is not None:
            decorate(self._scene)
        mujoco.mjr_render(self._area, self._scene, self._context)
        mujoco.mjr_readPixels(self._pixels, None, self._area, self._context)
        return self._pixels[::-1].copy()

    def close(self) -> None:
        """Let go of the graphics."""
        self._gl.make_current()
        self._context.free()
        self._gl.free()
