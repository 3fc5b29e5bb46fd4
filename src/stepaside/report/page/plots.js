/* Number of ascending times up to a time, in [s]. */
function countUntil(times, time) {
  let a = 0, b = times.length;
  while (a < b) { const m = (a + b) >> 1; if (times[m] <= time) a = m + 1; else b = m; }
  return a;
}
/* Index of the last sample at or before a time, in [s]. */
const sampleAt = (times, time) => Math.max(0, countUntil(times, time) - 1);

/* Plot over time with ticks at round numbers; a click seeks to that time. */
function makePlot(canvas, run, values, means, options, seek) {
  const end = run.times[run.times.length - 1] || 1;
  const known = values.filter((v) => v !== null).concat(options.levels.map((l) => l.value));
  let [low, high] = known.reduce(([a, b], v) => [Math.min(a, v), Math.max(b, v)], [Infinity, -Infinity]);
  if (!known.length) [low, high] = [0, 1];
  const margin = 0.08 * (high - low) || 0.5;
  low -= margin; high += margin;
  let box = null, over = null;

  function step(range, most) {
    const raw = range / Math.max(1, most), unit = 10 ** Math.floor(Math.log10(raw));
    return unit * [1, 2, 5, 10].find((k) => k * unit >= raw);
  }

  function draw(index, palette) {
    const scale = window.devicePixelRatio || 1;
    const w = canvas.clientWidth, h = canvas.clientHeight;
    canvas.width = Math.round(w * scale); canvas.height = Math.round(h * scale);
    const pen = canvas.getContext("2d");
    pen.scale(scale, scale);
    pen.font = "12px system-ui, sans-serif";
    box = { left: 40, right: w - 10, top: 8, bottom: h - 20 };
    const px = (t) => box.left + (box.right - box.left) * t / end;
    const py = (v) => box.bottom - (box.bottom - box.top) * (v - low) / (high - low);
    const stroke = (colour, width, dash, points) => {
      pen.strokeStyle = colour; pen.lineWidth = width; pen.setLineDash(dash);
      pen.beginPath();
      points.forEach(([x, y], i) => { if (i) pen.lineTo(x, y); else pen.moveTo(x, y); });
      pen.stroke(); pen.setLineDash([]);
    };
    pen.fillStyle = palette.soft;
    const dy = step(high - low, (box.bottom - box.top) / 26);
    pen.textAlign = "right"; pen.textBaseline = "middle";
    for (let v = Math.ceil(low / dy) * dy; v <= high; v += dy) {
      stroke(palette.grid, 1, [], [[box.left, py(v)], [box.right, py(v)]]);
      pen.fillText(String(+v.toFixed(6)), box.left - 5, py(v));
    }
    const dx = step(end, (box.right - box.left) / 55);
    pen.textAlign = "center"; pen.textBaseline = "top";
    for (let t = 0; t <= end + 1e-9; t += dx) {
      stroke(palette.grid, 1, [], [[px(t), box.top], [px(t), box.bottom]]);
      pen.fillText(String(+t.toFixed(6)), px(t), box.bottom + 5);
    }
    for (const level of options.levels)
      stroke(palette[level.colour], 1.5, level.dash, [[box.left, py(level.value)], [box.right, py(level.value)]]);
    /* Two points per pixel suffice, and keep the sway of single steps. */
    const every = Math.max(1, Math.floor(values.length / (2 * (box.right - box.left))));
    const curve = (of) => of.flatMap((v, i) => v === null
      || (i % every && i !== of.length - 1) ? [] : [[px(run.times[i]), py(v)]]);
    stroke(palette.sway, 1, [], curve(values));
    stroke(palette.mean, 2, [], curve(means));
    const shown = over === null ? index : over;
    const x = px(run.times[shown]);
    stroke(palette.ink, 1, over === null ? [] : [3, 3], [[x, box.top], [x, box.bottom]]);
    pen.fillStyle = palette.ink;
    const value = values[shown], known = value !== null;
    if (known) { pen.beginPath(); pen.arc(x, py(value), 3.5, 0, 2 * Math.PI); pen.fill(); }
    const text = `${run.times[shown].toFixed(1)} s: ${known ? `${value.toFixed(options.digits)} ${options.unit}` : "unknown"}`;
    pen.textBaseline = "top";
    pen.textAlign = x > (box.left + box.right) / 2 ? "right" : "left";
    const aside = pen.textAlign === "right" ? -7 : 7;
    const wide = pen.measureText(text).width;
    pen.fillStyle = palette.paper;
    pen.globalAlpha = 0.85;
    pen.fillRect(aside > 0 ? x + aside - 2 : x + aside - wide - 2, box.top, wide + 4, 15);
    pen.globalAlpha = 1;
    pen.fillStyle = palette.ink;
    pen.fillText(text, x + aside, box.top + 1);
  }

  const timeOf = (event) => {
    const x = event.clientX - canvas.getBoundingClientRect().left;
    return Math.min(end, Math.max(0, end * (x - box.left) / (box.right - box.left)));
  };
  let dragging = false;
  canvas.onpointerdown = (event) => { dragging = true; seek(timeOf(event)); };
  canvas.onpointerup = canvas.onpointercancel = () => { dragging = false; };
  canvas.onpointermove = (event) => {
    if (dragging && event.buttons) seek(timeOf(event));
    else { over = sampleAt(run.times, timeOf(event)); seek(null); }
  };
  canvas.onpointerleave = () => { over = null; dragging = false; seek(null); };
  return { draw };
}
