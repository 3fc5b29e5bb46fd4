"use strict";
/* The page: time, cameras, keys. */

const byId = (id) => document.getElementById(id);
const run = JSON.parse(byId("run").textContent);
const decode = (text) => Uint8Array.from(atob(text), (c) => c.charCodeAt(0)).buffer;
run.positions = decode(run.positions);
run.quaternions = decode(run.quaternions);

const frames = run.times.length, end = run.times[frames - 1];
const canvas = byId("world");
/* The drawing buffer is preserved so that screenshots taken between two frames are not blank. */
const context = canvas.getContext("webgl2", { antialias: true, preserveDrawingBuffer: true });
const scene = context && makeScene(run, canvas, context);
byId("flat").hidden = Boolean(scene);
let clock = 0, index = 0, playing = false, stale = true;
const seek = (time) => {
  if (time !== null) clock = Math.min(end, Math.max(run.times[0], time));
  stale = true;
};

const addNames = (id) => run.players.map((player) => {
  const span = document.createElement("span");
  span.textContent = player.name;
  byId(id).append(span);
  return span;
});
const names = addNames("players"), labels = addNames("labels");
/* A press on a player's name follows that player. */
let followed = null;
names.forEach((name, i) => {
  name.title = `follow ${run.players[i].name}`;
  name.style.cursor = "pointer";
  name.onclick = () => { choose("follow"); followed = i; };
});

/* Light or dark theme: that of the system until the button is pressed. */
const systemDark = window.matchMedia("(prefers-color-scheme: dark)");
let theme = systemDark.matches ? "dark" : "light";
function applyTheme() {
  for (const [name, colour] of Object.entries(run.palettes[theme]))
    document.documentElement.style.setProperty(`--${name}`, colour);
  document.documentElement.style.colorScheme = theme;
  byId("light").setAttribute("aria-pressed", String(theme === "dark"));
  if (scene) scene.applyTheme(theme);
  run.players.forEach((player, i) => {
    for (const span of [names[i], labels[i]]) span.style.color = player.colours[theme];
  });
  colourLegend();
  stale = true;
}
/* Colour the marks of the legend; a mark that stands for both players has both colours. */
function colourLegend() {
  const colours = run.players.map((player) => player.colours[theme]);
  for (const [mark, name] of marks) {
    const colour = name === "players" ? colours[0] : typeof name === "number" ? colours[name] : run.palettes[theme][name];
    mark.style.borderTopColor = colour;
    mark.style.borderBottomColor = name === "players" ? colours[colours.length - 1] : colour;
  }
}
systemDark.onchange = () => { theme = systemDark.matches ? "dark" : "light"; applyTheme(); };
byId("light").onclick = () => { theme = theme === "dark" ? "light" : "dark"; applyTheme(); };

/* Cameras: around a target, or at the evader's head. Angles in [rad], zoom and offset [m]. */
const view = { azimuth: -1.05, elevation: 0.5, zoom: 1, offset: [0, 0] };
const VIEWS = { whole: "Whole scene", follow: "Follow", top: "Top", eyes: "Evader's view" };
let chosen = "whole";
function choose(name) {
  chosen = name;
  followed = null;
  view.offset = [0, 0];
  view.zoom = 1;
  view.elevation = name === "top" ? 1.5706 : 0.5;
  if (name === "top") view.azimuth = -Math.PI / 2;
  for (const [key, button] of Object.entries(buttons))
    button.setAttribute("aria-pressed", String(key === name));
  stale = true;
}
const buttons = {};
for (const [name, text] of Object.entries(VIEWS)) {
  if (name === "eyes" && run.players.length < 2) continue;
  const button = document.createElement("button");
  button.textContent = text;
  button.onclick = () => choose(name);
  buttons[name] = button;
  byId("cameras").append(button);
}

/* Aim the camera; return the point that it looks at, in [m]. */
function aim(torsos) {
  const camera = scene.camera;
  const [first, second] = (run.pair || [0, 0]).map((i) => torsos[i]);
  if (chosen === "eyes") {
    const sight = first.clone().sub(second).setZ(0).normalize();
    camera.fov = 60;
    camera.position.copy(second).addScaledVector(sight, 0.09);
    camera.position.z = second.z + 0.2;
    camera.lookAt(first.x, first.y, first.z);
    return first;
  }
  const target = new THREE.Vector3(run.center[0], run.center[1], 0.15);
  let distance = run.camera_distance;
  if (chosen === "follow") {
    const box = new THREE.Box3().setFromPoints(followed === null ? torsos : [torsos[followed]]);
    box.getCenter(target).setZ(0.2);
    distance = 1.5 + 1.1 * box.min.distanceTo(box.max);
  }
  /* The top view shows the whole room at any aspect ratio. */
  const slope = Math.tan(20 * Math.PI / 180);
  if (chosen === "top")
    distance = 0.6 + Math.max(run.half_extent[1], run.half_extent[0] / camera.aspect) / slope;
  target.x += view.offset[0];
  target.y += view.offset[1];
  /* On a narrow screen the camera stands farther away. */
  distance *= view.zoom * (chosen === "top" ? 1 : Math.max(1, 1.35 / camera.aspect));
  const level = Math.cos(view.elevation);
  camera.fov = 40;
  camera.position.set(target.x + distance * level * Math.cos(view.azimuth),
    target.y + distance * level * Math.sin(view.azimuth), target.z + distance * Math.sin(view.elevation));
  camera.lookAt(target);
  return target;
}

const pointers = new Map();
let pinch = 0;
canvas.onpointerdown = (event) => {
  pointers.set(event.pointerId, [event.clientX, event.clientY]);
  canvas.setPointerCapture(event.pointerId);
};
canvas.onpointerup = canvas.onpointercancel = (event) => { pointers.delete(event.pointerId); pinch = 0; };
canvas.oncontextmenu = (event) => event.preventDefault();
canvas.onpointermove = (event) => {
  const last = pointers.get(event.pointerId);
  if (!last) return;
  const dx = event.clientX - last[0], dy = event.clientY - last[1];
  pointers.set(event.pointerId, [event.clientX, event.clientY]);
  if (pointers.size === 2) {
    const [a, b] = [...pointers.values()], now = Math.hypot(a[0] - b[0], a[1] - b[1]);
    if (pinch) zoomBy(pinch / now);
    pinch = now;
    move(0.5 * dx, 0.5 * dy);
  } else if (event.shiftKey || event.buttons & 2) move(dx, dy);
  else {
    view.azimuth -= dx / 200;
    view.elevation = Math.min(1.5706, Math.max(0.04, view.elevation + dy / 200));
  }
  stale = true;
};
function move(dx, dy) {
  const scale = 1.2 * view.zoom * run.camera_distance / canvas.clientHeight;
  const c = Math.cos(view.azimuth), s = Math.sin(view.azimuth);
  view.offset[0] += scale * (s * dx - c * dy);
  view.offset[1] += scale * (-c * dx - s * dy);
}
function zoomBy(factor) { view.zoom = Math.min(6, Math.max(0.08, view.zoom * factor)); stale = true; }
canvas.onwheel = (event) => { event.preventDefault(); zoomBy(Math.exp(event.deltaY / 800)); };

/* Legend of each layer: text, style of its line, colour. */
const metres = (value) => value === null || value === undefined ? "" : `, ${value.toFixed(2)} m`;
const guarded = run.safety === null ? "" : run.players[run.safety_player].name;
const LINES = {
  traces: ["path of the center of mass", "solid", "players"],
  footsteps: ["footsteps", "broad", "players"],
  pushes: ["pushes", "solid", "pushed"],
  "safety radius": [`safety radius of the ${guarded}${metres(run.safety)}`, "dashed", run.safety_player],
  "theoretical circle": [`theoretical circle, radius${metres(run.circle && run.circle[2]).slice(1)}`, "solid", "theory"],
  "line of sight": ["line of sight", "solid", "theory"],
};
const marks = [];
for (const name of Object.keys(scene ? scene.layers : {})) {
  const label = document.createElement("label"), box = document.createElement("input");
  box.type = "checkbox"; box.checked = true;
  box.onchange = () => { for (const mesh of scene.layers[name]) mesh.visible = box.checked; stale = true; };
  const mark = document.createElement("i");
  mark.className = LINES[name][1];
  marks.push([mark, LINES[name][2]]);
  label.append(box, mark, " " + LINES[name][0]);
  byId("layers").append(label);
}
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
if (run.players.length > 2) byId("distance-title").textContent = "Least distance of opponents [m] over time [s]";
byId("legend").textContent = !run.distance ? "" : ["thin: every sample", "thick: mean over a gait cycle", run.theory ? "dashed: theory" : "",
  run.safety ? "dotted: safety radius" : ""].filter(Boolean).join("; ");

const format = (value, digits, unit) => value === null ? "unknown" : value.toFixed(digits) + unit;
function draw() {
  stale = false;
  index = sampleAt(run.times, clock + 1e-9);
  const next = Math.min(index + 1, frames - 1), gap = run.times[next] - run.times[index];
  if (scene) {
    const w = canvas.clientWidth, h = canvas.clientHeight;
    scene.renderer.setPixelRatio(Math.min(2, window.devicePixelRatio || 1));
    const size = scene.renderer.getSize(new THREE.Vector2());
    if (size.x !== w || size.y !== h) scene.renderer.setSize(w, h, false);
    scene.camera.aspect = w / h;
    const torsos = scene.show(index, gap > 0 ? (clock - run.times[index]) / gap : 0);
    const target = aim(torsos);
    scene.camera.updateProjectionMatrix();
    scene.camera.updateMatrixWorld();
    scene.draw(target);
    labels.forEach((label, i) => {
      const top = torsos[i].clone().setZ(torsos[i].z + run.players[i].label_height).project(scene.camera);
      const own = chosen === "eyes" && i === run.pair[1];
      label.hidden = own || top.z > 1 || Math.abs(top.x) > 1.1 || Math.abs(top.y) > 1.1;
      label.style.left = `${50 * (top.x + 1)}%`;
      label.style.top = `${50 * (1 - top.y)}%`;
    });
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
new ResizeObserver(() => { stale = true; }).observe(canvas);
/* For tests and for the browser's console: positions at which bodies are drawn, in [m]. */
globalThis.stepaside = { seek: (time) => { seek(time); draw(); },
  positions: () => Object.fromEntries(run.bodies.map((body, i) => [body, scene.bodies[i].position.toArray()])) };
applyTheme();
choose("whole");
draw();
requestAnimationFrame(tick);
