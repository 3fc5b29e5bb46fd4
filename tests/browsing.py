"""Open pages in Chromium, which draws only visible pages.

Without a graphics card a picture takes a second or two, and everything else
on a page waits for it. So the calls that draw are switched off in each page
until a test opens its eyes, frames come ten times a second, and edges are not
smoothed, which costs as much as the picture; all other calls of WebGL are
made as ever.
"""

import shutil
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

CHROMIUM = shutil.which("chromium") or shutil.which("chromium-browser")
ARTEFACTS = Path(__file__).parent.parent / "artefacts"
WAIT = 200_000  # more than a browser on a busy machine ever takes, in [ms]
OPTIONS = ["--no-sandbox", "--enable-unsafe-swiftshader"]
PAUSE = 100  # between two frames of a page that does not look, in [ms]
LIDS = """{
globalThis.looking = false;
globalThis.draws = 0;
const prototype = HTMLCanvasElement.prototype, context = prototype.getContext;
prototype.getContext = function (kind, options) {
  return context.call(this, kind, {...options, antialias: false});
};
const first = 1e9, ask = requestAnimationFrame, drop = cancelAnimationFrame;
globalThis.requestAnimationFrame = (call) => globalThis.looking ? ask(call)
  : first + setTimeout(() => call(performance.now()), @@PAUSE@@);
globalThis.cancelAnimationFrame = (number) =>
  number < first ? drop(number) : clearTimeout(number - first);
for (const kind of [WebGLRenderingContext, WebGL2RenderingContext])
  for (const name of Object.getOwnPropertyNames(kind.prototype))
    if (/^draw(Arrays|Elements|Range)/.test(name)) {
      const draw = kind.prototype[name];
      kind.prototype[name] = function (...all) {
        if (!globalThis.looking) return;
        globalThis.draws += 1;
        draw.apply(this, all);
      };
    }
}""".replace("@@PAUSE@@", str(PAUSE))
FRAMES = """() => new Promise((told) => requestAnimationFrame(
  () => requestAnimationFrame(told)))"""


@contextmanager
def launched(*options: str) -> Iterator[Any]:
    """A browser with these options."""
    import pytest

    playwright = pytest.importorskip("playwright.sync_api")
    ARTEFACTS.mkdir(exist_ok=True)
    with playwright.sync_playwright() as driver:
        chromium = driver.chromium.launch(
            executable_path=CHROMIUM,
            headless=True,
            args=[*options] or OPTIONS,
            timeout=WAIT,
        )
        yield chromium
        chromium.close()


def open_page(
    browser: Any, *, width: int = 640, height: int = 420, **options: Any
) -> Any:
    """Page that waits long for whatever it waits for, with its eyes shut.

    Args:
        browser: The browser.
        width: Of the page, in [pixels].
        height: Likewise.
        options: Of the context in which it opens.
    """
    page = browser.new_page(
        viewport={"width": width, "height": height},
        **options,
    )
    page.set_default_timeout(WAIT)
    page.add_init_script(LIDS)
    return page


@contextmanager
def looking(page: Any) -> Iterator[None]:
    """Let a page draw for a while."""
    page.evaluate("looking = true")
    try:
        yield
    finally:
        page.evaluate("looking = false")


def keep_picture(page: Any, name: str) -> None:
    """Look at a page, and keep what is seen in ``artefacts``.

    A page that draws only what changed draws again when it is resized.
    """
    size = page.viewport_size
    page.set_viewport_size({**size, "height": size["height"] - 1})
    page.evaluate(FRAMES)
    with looking(page):
        page.set_viewport_size(size)
        page.evaluate(FRAMES)
        page.screenshot(path=ARTEFACTS / name)


def until(page: Any, condition: Any) -> None:
    """Wait for the loop behind the page."""
    for _ in range(WAIT // 20):
        if condition():
            return
        page.wait_for_timeout(20)
    raise AssertionError("it did not happen")


def press(page: Any, label: str) -> None:
    """Press a button, wherever it lies."""
    button = page.get_by_role("button", name=label, exact=True).first
    button.dispatch_event("click")
