"""What a figure shows, as texts and numbers."""

from collections.abc import Iterator
from itertools import chain
from typing import Any

import numpy as np
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.colors import to_hex
from matplotlib.figure import Figure
from matplotlib.text import Text
from matplotlib.ticker import FixedLocator


def content_of(figure: Figure) -> Iterator[Any]:
    """Yield labels, and the colours and means of all that is drawn."""
    yield from map(float, figure.get_size_inches())
    yield figure.get_suptitle()
    yield from chain.from_iterable(map(_legend, figure.legends))
    axes: Any
    for axes in figure.axes:
        yield from ("axes", *map(float, axes.get_position().bounds))
        yield from (axes.get_title(), axes.get_xlabel())
        yield from (axes.get_ylabel(), str(axes.get_aspect()))
        yield str(axes.xaxis_inverted() or axes.yaxis_inverted())
        yield f"{axes.axison} {axes.get_xscale()} {axes.get_yscale()}"
        yield from map(float, (*axes.get_xlim(), *axes.get_ylim()))
        yield from map(float, axes.titleOffsetTrans.to_values()[4:])
        for axis in (axes.xaxis, axes.yaxis):
            if isinstance(axis.get_major_locator(), FixedLocator):
                yield " ".join(t.get_text() for t in axis.get_ticklabels())
        for line in axes.lines:
            yield from ("line", _label(line), _colour(line.get_color()))
            yield f"{line.get_linestyle()} {line.get_marker()}"
            yield from (float(line.get_linewidth()), float(line.get_zorder()))
            yield from _mean(line.get_xydata())
        for each in axes.collections:
            yield from ("collection", _label(each), float(each.get_zorder()))
            yield from map(float, each.get_linewidths()[:2])
            yield from map(_colour, each.get_facecolor()[:2])
            yield from map(_colour, each.get_edgecolor()[:2])
            yield from _mean(each.get_offsets())
            for path in each.get_paths()[:2]:
                yield from _mean(path.vertices)
        for patch in axes.patches:
            yield from ("patch", _label(patch))
            yield _colour(patch.get_facecolor())
            yield _colour(patch.get_edgecolor())
            path = patch.get_patch_transform().transform_path(patch.get_path())
            yield from _mean(path.vertices)
        for image in axes.images:
            values: Any = np.ma.filled(np.ma.asarray(image.get_array()), 0.0)
            yield from ("image", *map(float, image.get_extent()))
            rows, columns = (np.arange(n) / n for n in values.shape[:2])
            yield from (rows @ values.mean(axis=1)).ravel().tolist()
            yield from (columns @ values.mean(axis=0)).ravel().tolist()
        text: Any
        for text in axes.texts:
            yield from (text.get_text(), *map(float, text.get_position()))
            place = f"{text.get_ha()} {text.get_va()}"
            yield f"{_colour(text.get_color())} {place}"
            yield from (float(text.get_fontsize()), float(text.get_rotation()))
        legend = axes.get_legend()
        if legend is not None:
            yield from _legend(legend)
    illegible = [*_illegible(figure)]
    assert not illegible, illegible


def _legend(legend: Any) -> Iterator[Any]:
    yield from (each.get_text() for each in legend.get_texts())
    frame = legend.get_frame()
    yield f"{frame.get_visible()} {_colour(frame.get_facecolor())}"
    yield f"{legend._loc} {legend._ncols}"


def _label(artist: Any) -> str:
    label = str(artist.get_label())
    return "" if label.startswith("_") else label


def _colour(colour: Any) -> str:
    return str(to_hex(colour, keep_alpha=True))


def _mean(points: Any) -> list[float]:
    """Return the number of points, their mean and the last one."""
    rows: Any = np.ma.filled(np.ma.asarray(points, dtype=float), 0.0)
    rows = np.nan_to_num(rows)
    if not len(rows):
        return [0.0]
    return [float(len(rows)), *rows.mean(axis=0), *rows[-1]]


def _illegible(figure: Figure) -> Iterator[str]:
    """Yield texts that cover another one, or leave the image."""
    canvas: Any = FigureCanvasAgg(figure)
    canvas.draw()
    ticks = [
        (tick, axis.get_view_interval())
        for axes in figure.axes
        for axis in (axes.xaxis, axes.yaxis)
        for tick in (*axis.majorTicks, *axis.minorTicks)
    ]
    beyond = [
        label
        for tick, (one, other) in ticks
        if not min(one, other) <= tick.get_loc() <= max(one, other)
        for label in (tick.label1, tick.label2)
    ]
    seen: list[tuple[str, Any]] = []
    for text in figure.findobj(Text):
        assert isinstance(text, Text)
        if text in beyond or not (text.get_visible() and text.get_text()):
            continue
        box = text.get_window_extent(canvas.get_renderer())
        if not figure.bbox.padded(1.0).contains(box.x0, box.y0) or (
            not figure.bbox.padded(1.0).contains(box.x1, box.y1)
        ):
            yield f"{text.get_text()!r} leaves the image"
        for other, taken in seen:
            if taken.padded(-1.0).overlaps(box.padded(-1.0)):
                yield f"{text.get_text()!r} covers {other!r}"
        seen.append((text.get_text(), box))
