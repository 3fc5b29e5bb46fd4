"use strict";
/* Scene, theme, cameras and legend of the replay page. */

const byId = (id) => document.getElementById(id);
const run = JSON.parse(byId("run").textContent);
const decode = (text) => Uint8Array.from(atob(text), (c) => c.charCodeAt(0)).buffer;

const canvas = byId("world");
/* The drawing buffer is preserved so that screenshots taken between two frames are not blank. */
const context = canvas.getContext("webgl2", { antialias: true, preserveDrawingBuffer: true });
const scene = context && makeScene(run, canvas, context);
byId("flat").hidden = Boolean(scene);
let stale = true;

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
  for (const [mark, own] of marks) mark.style.borderColor = own.colours[theme];
  stale = true;
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
    box.getCenter(target).setZ(0.6 * box.max.z);
    distance = Math.max(1.5, 4 * box.max.z) + 1.1 * box.min.distanceTo(box.max);
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

/* Legend of the layers, whose colour is that of their first lines. */
const marks = [];
for (const name of Object.keys(scene ? scene.layers : {})) {
  const label = document.createElement("label"), box = document.createElement("input");
  box.type = "checkbox";
  box.onchange = () => { for (const mesh of scene.layers[name]) mesh.visible = box.checked; stale = true; };
  box.checked = name !== "ZMP trace"; /* it covers the other paths */
  box.onchange();
  const own = run.overlays.filter((each) => each.layer === name);
  label.title = own[0].meaning;
  for (const each of own.slice(0, 2)) {
    const mark = document.createElement("i");
    marks.push([mark, each]);
    label.append(mark);
  }
  label.prepend(box);
  label.append(" " + (own.length === 1 && own[0].label || name));
  byId("layers").append(label);
}
/* Draw the players, with their torsos at these positions, and their names. */
function drawScene(torsos) {
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
/* Fit the picture to the size of its element. */
function fitScene() {
  const w = canvas.clientWidth, h = canvas.clientHeight;
  scene.renderer.setPixelRatio(Math.min(2, window.devicePixelRatio || 1));
  const size = scene.renderer.getSize(new THREE.Vector2());
  if (size.x !== w || size.y !== h) scene.renderer.setSize(w, h, false);
  scene.camera.aspect = w / h;
}
new ResizeObserver(() => { stale = true; }).observe(canvas);
