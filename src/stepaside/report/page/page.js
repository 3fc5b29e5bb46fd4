/* The page of a run: time, plots, keys. */

const frames = run.times.length, end = run.times[frames - 1];
let clock = 0, index = 0, playing = false;
const seek = (time) => {
  if (time !== null) clock = Math.min(end, Math.max(run.times[0], time));
  stale = true;
};

const level = (value, colour, dash) => value === null || value === undefined ? [] : [{ value, colour, dash }];
const [, theoryDistance, theoryAngle] = run.theory || [null, null, null];
const plots = run.distance ? [
  makePlot(byId("distance"), run, run.distance, run.means.distance, { unit: "m", digits: 2,
    levels: [...level(theoryDistance, "theory", [6, 4]), ...level(run.safety, "soft", [2, 3])] }, seek),
  ...(run.angle ? [makePlot(byId("angle"), run, run.angle, run.means.angle, { unit: "\u00b0", digits: 0,
    levels: level(theoryAngle, "theory", [6, 4]) }, seek)] : []),
] : [];
byId("plots").hidden = !run.distance;
byId("angle").hidden = byId("angle-title").hidden = !run.angle;
if (run.players.length > 2) byId("distance-title").textContent = "Least distance [m] over time [s]";
byId("legend").textContent = !run.distance ? "" : ["thin: every sample", "thick: mean over a gait cycle", run.theory ? "dashed: theory" : "",
  run.safety ? "dotted: safety radius" : ""].filter(Boolean).join("; ");

const format = (value, digits, unit) => value === null ? "unknown" : value.toFixed(digits) + unit;
function draw() {
  stale = false;
  index = sampleAt(run.times, clock + 1e-9);
  const next = Math.min(index + 1, frames - 1), gap = run.times[next] - run.times[index];
  if (scene) {
    fitScene();
    drawScene(scene.show(index, gap > 0 ? (clock - run.times[index]) / gap : 0));
  }
  byId("message").textContent = run.messages[run.message_index[index]];
  plots.forEach((plot) => plot.draw(index, run.palettes[theme]));
  byId("clock").textContent = `${run.times[index].toFixed(1)} s`;
  const least = run.players.length > 2 ? "least distance" : "distance";
  byId("values").textContent = !run.distance ? "" : `${least} ${format(run.distance[index], 2, " m")}` +
    (run.angle ? `, angle between the headings ${format(run.angle[index], 0, "\u00b0")}` : "");
  byId("time").value = index;
}

const slider = byId("time"), play = byId("play");
slider.max = frames - 1;
slider.oninput = () => { seek(run.times[+slider.value]); draw(); };
function toggle(on) {
  playing = on;
  play.textContent = playing ? "Pause" : "Play";
  if (playing && clock >= end) seek(run.times[0]);
}
play.onclick = () => toggle(!playing);
byId("help").onclick = () => byId("keys").showModal();

const KEYS = { " ": () => toggle(!playing), ArrowLeft: () => seek(clock - 1),
  ArrowRight: () => seek(clock + 1), Home: () => seek(run.times[0]), End: () => seek(end),
  l: () => byId("light").click(), "?": () => byId("keys").showModal() };
Object.keys(VIEWS).forEach((name, i) => { if (buttons[name]) KEYS[String(i + 1)] = () => choose(name); });
document.onkeydown = (event) => {
  const control = /^(INPUT|SELECT|BUTTON)$/.test(event.target.tagName);
  if (event.ctrlKey || event.metaKey || event.altKey || byId("keys").open) return;
  if (control && (event.key === " " || event.key.length > 1)) return;
  if (KEYS[event.key]) { event.preventDefault(); KEYS[event.key](); }
};

let last = performance.now();
function tick(now) {
  if (playing) {
    seek(clock + (now - last) / 1000 * +byId("speed").value);
    if (clock >= end) toggle(false);
  }
  last = now;
  if (stale) draw();
  requestAnimationFrame(tick);
}
/* For tests and for the browser's console: positions at which bodies are drawn, in [m]. */
globalThis.stepaside = { seek: (time) => { seek(time); draw(); },
  positions: () => Object.fromEntries(run.bodies.map((body, i) => [body, scene.bodies[i].position.toArray()])) };
applyTheme();
choose("whole");
draw();
requestAnimationFrame(tick);
