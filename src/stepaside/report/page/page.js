"use strict";
/* The page: time, cameras, keys. */

const byId = (id) => document.getElementById(id);
const run = JSON.parse(byId("run").textContent);
const bytes = (text) => Uint8Array.from(atob(text), (c) => c.charCodeAt(0)).buffer;
run.places = bytes(run.places);
run.turns = bytes(run.turns);

const frames = run.times.length, end = run.times[frames - 1];
const canvas = byId("world");
/* Kept for pictures of the page, which are taken between two frames. */
const context = canvas.getContext("webgl2", { antialias: true, preserveDrawingBuffer: true });
const scene = context && makeScene(run, canvas, context);
byId("flat").hidden = Boolean(scene);
let clock = 0, index = 0, playing = false, stale = true;
const seek = (time) => {
  if (time !== null) clock = Math.min(end, Math.max(run.times[0], time));
  stale = true;
};

const spans = (place) => run.robots.map((robot) => {
  const word = document.createElement("span");
  word.textContent = robot.name;
  byId(place).append(word);
  return word;
});
const names = spans("players"), labels = spans("labels");

/* Light and dark: as the system says, until this viewer says otherwise. */
const night = window.matchMedia("(prefers-color-scheme: dark)");
let light = night.matches ? "dark" : "light";
function dress() {
  for (const [name, colour] of Object.entries(run.palettes[light]))
    document.documentElement.style.setProperty(`--${name}`, colour);
  document.documentElement.style.colorScheme = light;
  byId("light").setAttribute("aria-pressed", String(light === "dark"));
  if (scene) scene.dress(light);
  run.robots.forEach((robot, i) => {
    for (const word of [names[i], labels[i]]) word.style.color = robot.colours[light];
  });
  paintMarks();
  stale = true;
}
/* The marks of the legend; what each player has is in the colour of each. */
function paintMarks() {
  const shown = run.robots.map((robot) => robot.colours[light]);
  for (const [mark, name] of marks) {
    const colour = name === "players" ? shown[0] : typeof name === "number" ? shown[name] : run.palettes[light][name];
    mark.style.borderTopColor = colour;
    mark.style.borderBottomColor = name === "players" ? shown[shown.length - 1] : colour;
  }
}
night.onchange = () => { light = night.matches ? "dark" : "light"; dress(); };
byId("light").onclick = () => { light = light === "dark" ? "light" : "dark"; dress(); };

/* Cameras: round a target, or in the evader's head. */
const view = { turn: -1.05, tilt: 0.5, away: 1, aside: [0, 0] };
const VIEWS = { whole: "Whole", follow: "Follow", top: "Top", eyes: "Evader's eyes" };
let chosen = "whole";
function choose(name) {
  chosen = name;
  view.aside = [0, 0];
  view.away = 1;
  view.tilt = name === "top" ? 1.5706 : 0.5;
  if (name === "top") view.turn = -Math.PI / 2;
  for (const [key, button] of Object.entries(buttons))
    button.setAttribute("aria-pressed", String(key === name));
  stale = true;
}
const buttons = {};
for (const [name, text] of Object.entries(VIEWS)) {
  if (name === "eyes" && run.robots.length < 2) continue;
  const button = document.createElement("button");
  button.textContent = text;
  button.onclick = () => choose(name);
  buttons[name] = button;
  byId("cameras").append(button);
}

function aim(seats) {
  const camera = scene.camera;
  const [one, two] = [seats[0], seats[1] || seats[0]];
  if (chosen === "eyes") {
    const toward = one.clone().sub(two).setZ(0).normalize();
    camera.fov = 60;
    camera.position.copy(two).addScaledVector(toward, 0.09);
    camera.position.z = two.z + 0.2;
    camera.lookAt(one.x, one.y, one.z);
    return one;
  }
  const target = new THREE.Vector3(run.middle[0], run.middle[1], 0.15);
  let away = run.away;
  if (chosen === "follow") {
    const about = new THREE.Box3().setFromPoints(seats);
    about.getCenter(target).setZ(0.2);
    away = 1.5 + 1.1 * about.min.distanceTo(about.max);
  }
  /* From above all of the room is seen, whatever the page's shape. */
  const steep = Math.tan(20 * Math.PI / 180);
  if (chosen === "top")
    away = 0.6 + Math.max(run.half[1], run.half[0] / camera.aspect) / steep;
  target.x += view.aside[0];
  target.y += view.aside[1];
  /* A phone held upright sees less from side to side. */
  away *= view.away * (chosen === "top" ? 1 : Math.max(1, 1.35 / camera.aspect));
  const flat = Math.cos(view.tilt);
  camera.fov = 40;
  camera.position.set(target.x + away * flat * Math.cos(view.turn),
    target.y + away * flat * Math.sin(view.turn), target.z + away * Math.sin(view.tilt));
  camera.lookAt(target);
  return target;
}

const held = new Map();
let spread = 0;
canvas.onpointerdown = (event) => {
  held.set(event.pointerId, [event.clientX, event.clientY]);
  canvas.setPointerCapture(event.pointerId);
};
canvas.onpointerup = canvas.onpointercancel = (event) => { held.delete(event.pointerId); spread = 0; };
canvas.oncontextmenu = (event) => event.preventDefault();
canvas.onpointermove = (event) => {
  const was = held.get(event.pointerId);
  if (!was) return;
  const dx = event.clientX - was[0], dy = event.clientY - was[1];
  held.set(event.pointerId, [event.clientX, event.clientY]);
  if (held.size === 2) {
    const [a, b] = [...held.values()], now = Math.hypot(a[0] - b[0], a[1] - b[1]);
    if (spread) near(spread / now);
    spread = now;
    move(0.5 * dx, 0.5 * dy);
  } else if (event.shiftKey || event.buttons & 2) move(dx, dy);
  else {
    view.turn -= dx / 200;
    view.tilt = Math.min(1.5706, Math.max(0.04, view.tilt + dy / 200));
  }
  stale = true;
};
function move(dx, dy) {
  const per = 1.2 * view.away * run.away / canvas.clientHeight;
  const c = Math.cos(view.turn), s = Math.sin(view.turn);
  view.aside[0] += per * (s * dx - c * dy);
  view.aside[1] += per * (-c * dx - s * dy);
}
function near(factor) { view.away = Math.min(6, Math.max(0.08, view.away * factor)); stale = true; }
canvas.onwheel = (event) => { event.preventDefault(); near(Math.exp(event.deltaY / 800)); };

/* Layers, labels, plots: of each line what it is, how it is drawn, its colour. */
const metres = (value) => value === null || value === undefined ? "" : `, radius ${value.toFixed(2)} m`;
const guard = run.safety === null ? "" : run.robots[run.guarded].name;
const LINES = {
  traces: ["path of the center of mass", "solid", "players"],
  footsteps: ["footsteps", "broad", "players"],
  pushes: ["pushes", "solid", "pushed"],
  "safety area": [`safety area of the ${guard}${metres(run.safety)}`, "dashed", run.guarded],
  "circle of theory": [`circle of theory${metres(run.circle && run.circle[2])}`, "solid", "theory"],
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
const theory = run.theory || [null, null, null];
const plots = run.distance ? [
  makePlot(byId("distance"), run, run.distance, run.means.distance, { unit: "m", digits: 2,
    levels: [...level(theory[1], "theory", [6, 4]), ...level(run.safety, "soft", [2, 3])] }, seek),
  makePlot(byId("angle"), run, run.angle, run.means.angle, { unit: "\u00b0", digits: 0,
    levels: level(theory[2], "theory", [6, 4]) }, seek),
] : [];
byId("plots").hidden = !run.distance;
byId("legend").textContent = !run.distance ? "" : ["thin: each step", "thick: mean of a gait cycle", run.theory ? "dashed: theory" : "",
  run.safety ? "dotted: safety radius" : ""].filter(Boolean).join("; ");

const told = (value, digits, unit) => value === null ? "not known" : value.toFixed(digits) + unit;
function put() {
  stale = false;
  index = sampleAt(run.times, clock + 1e-9);
  const next = Math.min(index + 1, frames - 1), gap = run.times[next] - run.times[index];
  if (scene) {
    const w = canvas.clientWidth, h = canvas.clientHeight;
    scene.renderer.setPixelRatio(Math.min(2, window.devicePixelRatio || 1));
    const size = scene.renderer.getSize(new THREE.Vector2());
    if (size.x !== w || size.y !== h) scene.renderer.setSize(w, h, false);
    scene.camera.aspect = w / h;
    const seats = scene.show(index, gap > 0 ? (clock - run.times[index]) / gap : 0);
    const target = aim(seats);
    scene.camera.updateProjectionMatrix();
    scene.camera.updateMatrixWorld();
    scene.draw(target);
    labels.forEach((label, i) => {
      const top = seats[i].clone().setZ(seats[i].z + run.robots[i].head).project(scene.camera);
      const own = chosen === "eyes" && i === 1;
      label.hidden = own || top.z > 1 || Math.abs(top.x) > 1.1 || Math.abs(top.y) > 1.1;
      label.style.left = `${50 * (top.x + 1)}%`;
      label.style.top = `${50 * (1 - top.y)}%`;
    });
  }
  byId("words").textContent = run.words[run.says[index]];
  plots.forEach((plot) => plot.draw(index, run.palettes[light]));
  byId("clock").textContent = `${run.times[index].toFixed(1)} s`;
  byId("figures").textContent = !run.distance ? "" :
    `distance ${told(run.distance[index], 2, " m")}, between the headings ${told(run.angle[index], 0, "\u00b0")}`;
  byId("time").value = index;
}

const slider = byId("time"), play = byId("play");
slider.max = frames - 1;
slider.oninput = () => { seek(run.times[+slider.value]); put(); };
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
  const own = /^(INPUT|SELECT|BUTTON)$/.test(event.target.tagName);
  if (event.ctrlKey || event.metaKey || event.altKey || byId("keys").open) return;
  if (own && (event.key === " " || event.key.length > 1)) return;
  if (KEYS[event.key]) { event.preventDefault(); KEYS[event.key](); }
};

let last = performance.now();
function tick(now) {
  if (playing) {
    seek(clock + (now - last) / 1000 * +byId("speed").value);
    if (clock >= end) toggle(false);
  }
  last = now;
  if (stale) put();
  requestAnimationFrame(tick);
}
new ResizeObserver(() => { stale = true; }).observe(canvas);
/* For tests, and for whoever looks closer: where bodies are drawn, in [m]. */
globalThis.stepaside = { seek: (time) => { seek(time); put(); },
  places: () => Object.fromEntries(run.bodies.map((body, i) => [body, scene.bodies[i].position.toArray()])) };
dress();
choose("whole");
put();
requestAnimationFrame(tick);
