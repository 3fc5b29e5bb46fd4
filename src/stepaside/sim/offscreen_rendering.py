"""Off-screen rendering, and the choice of its backend."""

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

PROBE = (
    "import mujoco; from {module} import {renderer}; "
    'm = mujoco.MjModel.from_xml_string(\'<mujoco><worldbody><geom size="1"/>'
    "</worldbody></mujoco>'); {renderer}(m, 16, 16, {backend!r})"
)
MAX_GEOMS = 2000  # in a scene
GRID = 10.0  # spacing of the vertices of a plane, in [m]


class RenderQuality(NamedTuple):
    """Quality settings of a rendered image."""

    samples: int = 0  # samples per pixel for antialiasing; 0 for one
    shadow: int = 0  # side of the shadow map [pixels]; 0 for none
    reach: float = 1.0  # half side of the square with shadows [m]
    slices: int = 12  # slices of round geoms around their axis
    stacks: int = 6  # slices of round geoms along their axis
    groups: int = 3  # number of geom groups that are drawn


# Fast, for sensors: a sphere of 3 cm at 1 m is round to a third of a pixel.
PLAIN = RenderQuality()


def choose_renderer(wanted: str = "auto") -> str:
    """Return a renderer of colour images that works on this machine.

    A broken graphics driver can crash the process, so each backend is tried
    in another process. MUJOCO_GL narrows down what "auto" tries.
    """
    if wanted == RAYCAST:
        return RAYCAST
    if wanted != "auto":
        if not _works(wanted):
            raise ConfigurationError(
                f"renderer {wanted} does not work on this machine; "
                "auto finds one that does"
            )
        return wanted
    variable = os.environ.get("MUJOCO_GL", "").lower()
    tried = BACKENDS if variable in ("", "glfw", "glx") else (variable,)
    for backend in tried:
        if backend in BACKENDS and _works(backend):
            return backend
    return RAYCAST


@lru_cache(maxsize=4)
def _works(backend: str) -> bool:
    environment = _environment(backend) | {"OPENBLAS_NUM_THREADS": "1"}
    probe = PROBE.format(
        module=__name__,
        renderer=OffscreenRenderer.__name__,
        backend=backend,
    )
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
    """Off-screen renderer of images of one size, for any camera."""

    def __init__(
        self,
        model: mujoco.MjModel,
        width: int,
        height: int,
        backend: str,
        look: RenderQuality = PLAIN,
    ) -> None:
        os.environ.update(_environment(backend))
        context: Any = import_module(f"mujoco.{backend}").GLContext
        self._model = model
        self._gl = context(width, height)
        self._gl.make_current()
        self._closed = False
        quality = model.vis.quality
        quality.shadowsize, quality.offsamples = look.shadow, look.samples
        quality.numslices, quality.numstacks = look.slices, look.stacks
        if look.shadow:
            model.vis.map.shadowclip = look.reach / model.stat.extent
        # The third size of a plane is the spacing of its rendered grid.
        planes = model.geom_type == mujoco.mjtGeom.mjGEOM_PLANE
        model.geom_size[planes, 2] = GRID
        model.vis.global_.offwidth = width
        model.vis.global_.offheight = height
        scale = mujoco.mjtFontScale.mjFONTSCALE_100
        self._context = mujoco.MjrContext(model, scale)
        offscreen = mujoco.mjtFramebuffer.mjFB_OFFSCREEN
        mujoco.mjr_setBuffer(offscreen, self._context)
        self._scene = mujoco.MjvScene(model, MAX_GEOMS)
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
        """Render an image (height, width, 3), of a scene to decorate."""
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
        """Release the graphics context, unless it is released already."""
        if self._closed:
            return
        self._closed = True
        self._gl.make_current()
        self._context.free()
        self._gl.free()
