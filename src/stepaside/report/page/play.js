/* The page that plays: the recorded duel until MuJoCo has loaded, then the game itself. */

const opened = performance.now();
let game = null, playing = true, waiting = "the game is loading", clock = 0, growing = [], began = [];
const degrees = (angle) => angle * 180 / Math.PI, radians = (angle) => angle * Math.PI / 180;

/* Settings of the game: label, unit, range, and where the value stands. Those of the start restart it. */
const { speed: usual, gain: steering, near, far } = run.template;
const CONTROLS = [
  ["speed of the pursuer", "m/s", 0.2 * usual, 1.2 * usual, 0.05 * usual, (s) => s.speeds[0], (s, v) => { s.speeds[0] = v; }],
  ["speed of the evader", "m/s", 0.2 * usual, 1.2 * usual, 0.05 * usual, (s) => s.speeds[1], (s, v) => { s.speeds[1] = v; }],
  ["steering gain k", "1/s", 0.25 * steering, 2 * steering, 0.05 * steering, (s) => s.gain, (s, v) => { s.gain = v; }],
  ["angle of evasion \u03b1", "\u00b0", 0, 180, 5, (s) => degrees(s.angle), (s, v) => { s.angle = radians(v); }],
  ["start: distance", "m", near, 4 / 3 * far, 0.01, (s) => s.start[0], (s, v) => { s.start[0] = v; }, true],
  ["start: pursuer looks aside by", "\u00b0", -90, 90, 1, (s) => degrees(s.start[1]), (s, v) => { s.start[1] = radians(v); }, true],
  ["start: evader looks aside by", "\u00b0", -90, 90, 1, (s) => degrees(s.start[2]), (s, v) => { s.start[2] = radians(v); }, true],
];
const inputs = CONTROLS.map(([text, unit, least, most, step, read, set, restarts]) => {
  const label = document.createElement("label"), shown = document.createElement("span");
  const input = Object.assign(document.createElement("input"), { type: "range", disabled: true,
    ariaLabel: `${text} [${unit}]` });
  Object.assign(input, { min: least, max: most, step: step / 10 });
  const digits = unit === "\u00b0" ? 0 : unit === "m/s" ? 3 : 2;
  const tell = () => { shown.textContent = `${read(game.settings).toFixed(digits)} ${unit}`; };
  input.oninput = () => {
    set(game.settings, Math.round(input.value / step) * step);
    tell();
    if (restarts) restart();
  };
  label.append(text, shown, input);
  byId("controls").append(label);
  return { show: () => { input.disabled = false; input.value = read(game.settings); tell(); } };
});
/* The theoretical circle passes through both players, on the side to which the pursuer turns. It is
   drawn while the evader evades, with the speeds, gain and angle of which the circle is known. */
function placeTheory() {
  const { settings, defaults, players: [pursuer, evader] } = game;
  const values = ({ speeds, gain, angle }) => [...speeds, gain, angle];
  const changed = values(settings).some((value, i) => Math.abs(value - values(defaults)[i]) > 1e-6);
  const [a, b] = [pursuer, evader].map((player) => player.truth().reference);
  const half = 0.5 * Math.hypot(b[0] - a[0], b[1] - a[1]), radius = run.circle ? run.circle[2] : 0;
  scene.theory.visible = !changed && evader.memory !== 0 && half < radius;
  if (!scene.theory.visible) return;
  const side = pursuer.turning < 0 ? -1 : 1;
  const aside = side * Math.sqrt(radius ** 2 - half ** 2) / (2 * half);
  scene.theory.position.set(0.5 * (a[0] + b[0]) - aside * (b[1] - a[1]),
    0.5 * (a[1] + b[1]) + aside * (b[0] - a[0]), 0);
}

function restart() {
  game.reset(game.settings);
  growing.forEach((line) => line.clear());
  began = [];
  toggle(true);
}
function toggle(on) {
  playing = on;
  byId("play").textContent = playing ? "Pause" : "Play";
}
byId("play").onclick = () => toggle(!playing);
byId("again").onclick = restart;
byId("draw").onclick = () => {
  game.settings.start = [near + (far - near) * Math.random(), radians(180 * Math.random() - 90), radians(60 * Math.random() - 30)];
  inputs.forEach((input) => input.show());
  restart();
};

/* Engine: MuJoCo's WebAssembly build, the generated formulas and the values of the start. */
async function load() {
  const [module, data] = await Promise.all([import("./mujoco.js"),
    fetch("game.json").then((answer) => answer.json())]);
  const mujoco = await module.default(), formulas = makeFormulas();
  game = data.learned ? new LegsGame(mujoco, data, formulas, ...await choosePolicy(data.learned.network))
    : new Game(mujoco, data, formulas);
  if (scene) growing = run.players.map((_, number) => scene.growing(number));
  inputs.forEach((input) => input.show());
  for (const id of ["play", "again", "draw"]) byId(id).disabled = false;
  restart();
  return (performance.now() - opened) / 1000;
}
/* The runtime of networks, and the network that the visitor chooses; the file stays in the browser. */
async function choosePolicy({ file, sha256 }) {
  const runtime = await import("./ort.wasm.min.mjs"), input = byId("network"), hint = byId("hint");
  runtime.env.wasm.numThreads = 1;
  runtime.env.wasm.wasmPaths = new URL("./", location.href).href;
  hint.textContent = `To play, choose the walking policy ${file}; it stays on this device.`;
  byId("policy").hidden = false;
  waiting = "choose the policy to play";
  for (;;) {
    await new Promise((chosen) => { input.onchange = chosen; });
    const bytes = await input.files[0].arrayBuffer();
    const digest = crypto.subtle && Array.from(new Uint8Array(await crypto.subtle.digest("SHA-256", bytes)),
      (byte) => byte.toString(16).padStart(2, "0")).join("");
    if (digest && digest !== sha256) hint.textContent = `${input.files[0].name} is not ${file}, for which this page was made.`;
    else {
      byId("policy").hidden = true;
      return [runtime, await runtime.InferenceSession.create(bytes, { executionProviders: ["wasm"] })];
    }
  }
}
const loaded = load();
loaded.catch((error) => {
  const served = location.protocol.startsWith("http");
  byId("outcome").textContent = served ? `The game did not load: ${error.message || error}`
    : "This is a recording. To play, serve this folder: python -m http.server";
});

/* Lines that grow, and steps that have begun. */
function note() {
  game.players.forEach((player, i) => {
    if (scene) growing[i].move(player.truth().reference);
    if (!player.plan || began[i] === player.plan) return;
    began[i] = player.plan;
    if (scene) growing[i].land([0, player.plan.side, ...player.landing()]);
  });
}
/* Play as many ticks as the time since the last frame has, but for no longer than half of it. */
let owed = 0, busy = false;
async function advance(passed) {
  owed = Math.min(owed + passed * +byId("speed").value, 0.5);
  if (busy) return;
  busy = true;
  const until = performance.now() + Math.max(25, 500 * passed);
  while (owed >= game.data.tick && performance.now() < until && !game.outcome && playing) {
    const waits = game.tick();
    if (waits) await waits;
    owed -= game.data.tick;
  }
  busy = false;
  note();
}

const spoken = { stand: "stands", start: "starts to walk", step: "walks", halt: "halts" };
function tell() {
  const [a, b] = game.players.map((player) => player.truth());
  const between = Math.abs(degrees(wrapAngle(a.heading - b.heading)));
  byId("clock").textContent = `${game.time.toFixed(1)} s`;
  byId("message").textContent = game.players.map((player) =>
    `${player.name} ${spoken[player.state] || player.state}`).join(", ");
  byId("values").textContent = `distance ${game.distance.toFixed(2)} m, angle between the headings ${between.toFixed(0)}\u00b0`;
  byId("outcome").textContent = game.outcome ? `${game.outcome} at ${game.time.toFixed(1)} s: start again` : "";
}
function tellRecorded() {
  clock = Math.min(clock, run.times[run.times.length - 1]);
  const index = Math.max(0, run.times.findLastIndex((time) => time <= clock));
  byId("clock").textContent = `${clock.toFixed(1)} s`;
  byId("message").textContent = `${run.messages[run.message_index[index]]} (recorded; ${waiting})`;
  byId("values").textContent = `distance ${run.distance[index].toFixed(2)} m`;
  const next = Math.min(index + 1, run.times.length - 1), gap = run.times[next] - run.times[index];
  return scene && scene.show(index, gap > 0 ? (clock - run.times[index]) / gap : 0);
}

/* On a slow machine the picture loses its shadows, then three quarters of its points. */
const ENOUGH = 20;  // [frames/s]
let simplified = 0;
function simplify() {
  if (!scene || simplified > 1) return;
  scene.simplify(simplified === 0 ? 1 : 0.5);
  simplified += 1;
}
/* Frames and seconds of the game in the last second. */
const measured = { frames: 0, from: performance.now(), time: 0, rate: 0 };
function measure(now) {
  measured.frames += 1;
  if (now - measured.from < 1000) return;
  const passed = (now - measured.from) / 1000, time = game ? game.time : clock;
  measured.rate = measured.frames / passed;
  if (game && playing && measured.rate < ENOUGH) simplify();
  const factor = Math.max(0, time - measured.time) / passed;
  byId("rate").textContent = `${measured.rate.toFixed(0)} frames/s, ${factor.toFixed(2)} x real time`;
  Object.assign(measured, { frames: 0, from: now, time });
}
let last = performance.now();
function frame(now) {
  const passed = document.hidden ? 0 : Math.max(0, now - last) / 1000;
  last = now;
  if (game && playing) advance(passed);
  if (!game) clock += passed;
  const torsos = game ? scene && scene.place(game.state.xpos, game.state.xquat) : tellRecorded();
  if (game) tell();
  if (scene) {
    scene.theory.visible = false;
    if (game) placeTheory();
    fitScene();
    drawScene(torsos);
  }
  measure(now);
  requestAnimationFrame(frame);
}

/* Pushes: a tap pushes away from the camera, a drag along itself, 2 N s for each metre on the floor; on a
   robot heavier than NAO in proportion. */
const [TAP, PER_METRE, MOST] = [0.6, 2, 3].map((value) => value * run.template.weight);  // [N s], [N s/m], [N s]
let pushing = null;
const ray = new THREE.Raycaster();
function onFloor(event, height) {
  const box = canvas.getBoundingClientRect(), at = new THREE.Vector2(
    2 * (event.clientX - box.left) / box.width - 1, 1 - 2 * (event.clientY - box.top) / box.height);
  ray.setFromCamera(at, scene.camera);
  return ray.ray.intersectPlane(new THREE.Plane(new THREE.Vector3(0, 0, 1), -height), new THREE.Vector3());
}
function robotAt(event) {
  onFloor(event, 0);
  const hit = ray.intersectObjects(scene.bodies, true)[0];
  if (!hit) return -1;
  const body = run.bodies[scene.bodies.indexOf(hit.object.parent)];
  return game.data.players.findIndex(({ bodies: [first, end] }) => first <= body && body < end);
}
const turnCamera = { down: canvas.onpointerdown, move: canvas.onpointermove, up: canvas.onpointerup };
const arrow = scene && new THREE.ArrowHelper(new THREE.Vector3(1, 0, 0), new THREE.Vector3(), 0.3, 0xd98c00, 0.1, 0.07);
if (scene) { arrow.visible = false; scene.world.add(arrow); }
function impulse(event) {
  const { number, from } = pushing, drawn = onFloor(event, from.z);
  const along = drawn ? drawn.sub(from).setZ(0) : new THREE.Vector3();
  const torso = new THREE.Vector3().fromArray(game.state.xpos, 3 * game.data.players[number].torso);
  const tapped = Math.hypot(event.clientX - pushing.x, event.clientY - pushing.y) < 8;
  if (tapped) along.copy(torso).sub(scene.camera.position).setZ(0).setLength(TAP);
  else along.multiplyScalar(PER_METRE).clampLength(0, MOST);
  arrow.position.copy(torso);
  arrow.setDirection(along.clone().normalize());
  arrow.setLength(0.1 + 0.3 * along.length() / run.template.weight, 0.1, 0.07);
  arrow.visible = true;
  return along;
}
canvas.onpointerdown = (event) => {
  const number = game && !game.outcome && event.button === 0 ? robotAt(event) : -1;
  if (number < 0 || pointers.size) return turnCamera.down(event);
  const height = game.state.xpos[3 * game.data.players[number].torso + 2];
  pushing = { number, from: onFloor(event, height) || new THREE.Vector3(), x: event.clientX, y: event.clientY };
  return canvas.setPointerCapture(event.pointerId);
};
canvas.onpointermove = (event) => { if (pushing) impulse(event); else turnCamera.move(event); };
canvas.onpointerup = (event) => {
  if (!pushing) return turnCamera.up(event);
  const along = impulse(event);
  game.push(pushing.number, along.x, along.y);
  pushing = null;
  return setTimeout(() => { arrow.visible = false; }, 800);
};
canvas.onpointercancel = (event) => { pushing = null; if (arrow) arrow.visible = false; turnCamera.up(event); };

document.onkeydown = (event) => {
  if (event.ctrlKey || event.metaKey || event.altKey || /^(INPUT|SELECT|BUTTON)$/.test(event.target.tagName)) return;
  if (event.key === " " && game) { event.preventDefault(); toggle(!playing); }
};
/* For tests and for the browser's console. */
globalThis.stepaside = { loaded, measured, get game() { return game; },
  simulate: (seconds, changes) => {
    toggle(false);
    game.reset({ ...game.defaults, ...changes });
    return game.simulate(seconds);
  } };
applyTheme();
choose("follow");
requestAnimationFrame(frame);
