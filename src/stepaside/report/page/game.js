/* A duel in MuJoCo: the loop around generated formulas. Lengths in [m], angles in [rad], times in
   [s]. A pose is [x, y, heading], as in core/poses.py. */

const wrapAngle = (angle) => angle - 2 * Math.PI * Math.round(angle / (2 * Math.PI));
function compose([x, y, theta], [u, v, turn]) {
  const c = Math.cos(theta), s = Math.sin(theta);
  return [x + c * u - s * v, y + s * u + c * v, theta + turn];
}
function inverse([x, y, theta]) {
  const c = Math.cos(theta), s = Math.sin(theta);
  return [-c * x - s * y, s * x - c * y, -theta];
}
const doubles = (text) => new Float64Array(Uint8Array.from(atob(text), (c) => c.charCodeAt(0)).buffer);
function table(rows, columns, values) {
  const array = values ? Float64Array.from(values) : new Float64Array(rows * columns);
  array.shape = [rows, columns];
  return array;
}
/* Product of one row of a matrix with the columns x and y of a plan's inputs or placements. */
function times(matrix, row, points, width, column) {
  const count = points.length / width;
  let total = 0;
  for (let k = 0; k < count; k++) total += matrix[row * count + k] * points[width * k + column];
  return total;
}

/* Plan of one maneuver, sampled at ticks; see planning/plan.py and reference_table.py. */
class Plan {
  constructor(game, kind, intent, side, swing, state, frame, started) {
    const data = game.data, plan = data.plans[kind];
    const numbers = game.formulas[`plan_${kind}`](intent.heading || 1e-12, intent.velocity, intent.gain,
      side, ...swing, 0, 0, 0, ...state);
    const inputs = plan.landing[0].length;
    Object.assign(this, { data, plan, kind, side, frame, started, heading: intent.heading });
    this.placements = numbers.slice(0, numbers.length - 2 * inputs);
    this.inputs = numbers.slice(numbers.length - 2 * inputs);
    this.first = Math.ceil((started - 1e-9) / data.tick);
    const offset = this.first * data.tick - started;
    this.map = plan.maps.reduce((a, b) => Math.abs(b.offset - offset) < Math.abs(a.offset - offset) ? b : a);
  }
  placement(row) { return Array.from(this.placements.slice(3 * row, 3 * row + 3)); }
  /* Row i of ZMP (0), DCM (1) or CoM (2) in the plan frame. */
  point(part, i) {
    const row = part * this.map.count + i;
    return [0, 1].map((axis) => times(this.map.pendulum, row, this.inputs, 2, axis));
  }
  row(now) { return Math.min(Math.round(now / this.data.tick) - this.first, this.map.count - 1); }
  /* Body reference and ZMP of a tick in odometry. */
  reference(now) {
    const i = this.row(now), { count, feet, heights } = this.map;
    const foot = (moving) => {
      const pose = [0, 1, 2].map((axis) => times(feet, moving * count + i, this.placements, 3, axis));
      const [x, y, theta] = compose(this.frame, pose);
      return [x, y, heights[moving * count + i], theta];
    };
    const [left, right] = this.side > 0 ? [foot(1), foot(0)] : [foot(0), foot(1)];
    const inWorld = (part) => compose(this.frame, [...this.point(part, i), 0]).slice(0, 2);
    return { body: [...inWorld(2), this.data.height, ...left, ...right], zmp: inWorld(0) };
  }
  /* State of the CoM at the first landing, in the frame of the foot that lands. */
  landing() {
    const [dcm, com] = [1, 2].map((part) => [0, 1].map((axis) =>
      this.plan.landing[part].reduce((sum, weight, k) => sum + weight * this.inputs[2 * k + axis], 0)));
    const back = inverse(this.placement(2));
    const velocity = [0, 1].map((axis) => this.data.eta * (dcm[axis] - com[axis]));
    return [...compose(back, [...com, 0]).slice(0, 2),
      ...compose([0, 0, back[2]], [...velocity, 0]).slice(0, 2)];
  }
  /* Pose of the template unicycle in odometry; see planning/template_path.py. */
  template(now) {
    const { data, plan } = this, i = this.row(now), time = i * data.tick + this.map.offset;
    const [comX, comY] = this.point(2, i), half = 0.5 * data.spacing * this.side;
    const samples = Array.from({ length: this.placements.length / 3 }, (_, k) =>
      compose(this.placement(k), [0, k % 2 ? half : -half, 0]));
    const pose = [...samples[0]];
    for (let k = 0; k + 1 < samples.length; k++) {
      const way = [0, 1, 2].map((axis) => samples[k + 1][axis] - samples[k][axis]);
      const middle = samples[k][2] + 0.5 * way[2];
      const lead = way[0] * Math.cos(middle) + way[1] * Math.sin(middle);
      const come = (comX - samples[k][0]) * way[0] + (comY - samples[k][1]) * way[1] - data.ahead * lead;
      const length = way[0] ** 2 + way[1] ** 2;
      const clock = (time - plan.begun - 0.5 * data.support) / data.step - (k - 1);
      const timed = !(plan.standing && k === 0);
      let share = length > data.still ** 2 ? come / length : 1;
      if (timed && length < data.short ** 2) share = clock;
      if (timed) share = Math.min(Math.max(share, clock - 0.5), clock + 0.5);
      share = Math.min(Math.max(share, 0), 1);
      for (let axis = 0; axis < 3; axis++) pose[axis] += share * way[axis];
    }
    return compose(this.frame, pose);
  }
}

/* Feet abreast, the CoM midway between them. */
class Rest {
  constructor(data, left, right) {
    const anchor = (foot) => compose(foot, [data.ahead, 0, 0]);
    const [a, b] = [anchor(left), anchor(right)], com = [0.5 * (a[0] + b[0]), 0.5 * (a[1] + b[1])];
    const foot = ([x, y, theta]) => [x, y, 0, theta];
    this.sample = { body: [...com, data.height, ...foot(left), ...foot(right)], zmp: com };
    this.pose = [0.5 * (left[0] + right[0]), 0.5 * (left[1] + right[1]),
      right[2] + 0.5 * wrapAngle(left[2] - right[2])];
  }
  reference() { return this.sample; }
  template() { return this.pose; }
}

/* One robot: where it is, and what it decides. */
class Robot {
  constructor(game, spec, frame) {
    Object.assign(this, { game, spec, data: game.data, frame, name: spec.name, memory: 0 });
  }
  /* Put the robot in a posture, with these joint targets, into the world. */
  stand(posture, targets) {
    const { qpos } = this.game.state, [x, y, theta] = compose(this.frame, [posture[0], posture[1], 0]);
    const c = Math.cos(0.5 * theta), s = Math.sin(0.5 * theta), [w, a, b, d] = posture.slice(3, 7);
    qpos.set([x, y, posture[2], c * w - s * d, c * a - s * b, c * b + s * a, c * d + s * w, ...posture.slice(7)],
      this.spec.qpos);
    this.sent.set(targets);
  }
  get sent() { return this.game.state.ctrl.subarray(this.spec.ctrl, this.spec.ctrl + this.spec.joints); }
  /* Torso and reference point in the world, as sim/ground_truth.py. */
  truth() {
    const { xpos, xmat, subtree_com: com } = this.game.state, t = this.spec.torso;
    const heading = Math.atan2(xmat[9 * t + 3], xmat[9 * t]), { ahead } = this.data;
    return { heading, upright: xmat[9 * t + 8],
      torso: [xpos[3 * t] + this.spec.hips * xmat[9 * t], xpos[3 * t + 1] + this.spec.hips * xmat[9 * t + 3]],
      reference: [com[3 * t] - ahead * Math.cos(heading), com[3 * t + 1] - ahead * Math.sin(heading)] };
  }
  /* Pose of a sole in the world: 1 left, -1 right. */
  sole(side) {
    const { site_xpos: at, site_xmat: axes } = this.game.state, i = this.spec.soles[side > 0 ? 0 : 1];
    return [at[3 * i], at[3 * i + 1], Math.atan2(axes[9 * i + 3], axes[9 * i])];
  }
  /* Decision of the paper's laws, where the template is turned by an angle from the torso's estimated heading;
     null to stand. */
  decide(turned) {
    const own = this.truth(), other = this.opponent.truth(), { settings, formulas } = this.game;
    const dx = other.reference[0] - own.reference[0], dy = other.reference[1] - own.reference[1];
    const bearing = wrapAngle(wrapAngle(Math.atan2(dy, dx) - own.heading) - turned), distance = Math.hypot(dx, dy);
    const velocity = this.spec.direction * settings.speeds[this.number];
    if (this.spec.direction > 0) return { heading: bearing, velocity, gain: settings.gain };
    const { radius, release, hysteresis } = this.data.evasion;
    const evading = formulas.is_evading(this.memory !== 0, distance, radius, release === null ? Infinity : release);
    this.memory = evading ? formulas.update_side(this.memory, bearing, hysteresis) : 0;
    const heading = formulas.evasion_heading(bearing, this.memory, settings.angle);
    return evading ? { heading, velocity, gain: settings.gain } : null;
  }
}

/* One robot: strategy, maneuvers, joint motion and servos. */
class Walker extends Robot {
  constructor(game, spec, frame) {
    super(game, spec, frame);
    const { data } = this, n = data.free, joints = data.fixed.length;
    this.states = table(2, n + 7, [...data.state, ...data.state]);
    this.limits = table(n, 3, data.limits.flat());
    this.references = table(1, 16);
    this.contacts = table(1, 7);
    this.points = table(3, data.masses);
    this.torques = table(1, data.legs.length);
    this.soon = table(1, joints);
    this.offsets = table(2, joints);
    this.weight = table(joints, 1, data.weight);
    this.memoryOfOffsets = table(joints, 1, data.memory);
    this.slowest = Math.min(...data.limits.map(([reach]) => reach));
    [this.lead, this.reach] = data.servos[game.data.players.indexOf(spec)].map((values) => table(joints, 1, values));
    this.calls = 0;
    this.deflections = null;
    this.left = [0, 0.5 * data.spacing, 0];
    this.right = [0, -0.5 * data.spacing, 0];
    this.side = 1;
    this.rest();
    this.pose = this.motion.template(0);
    this.target = table(joints, 1, this.angles());
    this.stand(data.posture, this.target);
  }
  /* Its phase, and the heading that it steers to. */
  get state() { return this.plan ? this.plan.kind : "stand"; }
  get turning() { return this.plan ? this.plan.heading : 0; }
  rest() {
    this.plan = null;
    this.motion = new Rest(this.data, this.left, this.right);
  }
  support(swing) { return swing > 0 ? this.right : this.left; }
  angles() { return this.data.columns.map((column, j) => column === null ? this.data.fixed[j] : this.states[column]); }
  /* Where the foot that swings will land: the planned step, from where the robot stands. */
  landing() { return compose(this.sole(-this.plan.side), this.plan.placement(2)); }
  tick(now) {
    this.heading = wrapAngle(this.states[this.data.free + 4]);
    if (!this.plan) this.wait(now);
    else if (now >= this.ends - 1e-9) this.finish();
    this.write(this.motion.reference(now));
    this.pose = this.motion.template(now);
  }
  wait(now) {
    const intent = this.decide(this.pose[2] - this.heading);
    if (!intent) return;
    const support = this.support(this.side);
    const [x, y] = compose(inverse(support), [...this.motion.reference(now).body.slice(0, 2), 0]);
    this.walk("start", intent, [x, y, 0, 0], now);
  }
  finish() {
    const { plan } = this, landed = compose(plan.frame, plan.placement(2));
    if (plan.side > 0) this.left = landed; else this.right = landed;
    if (plan.kind === "halt") return this.rest();
    this.side = -plan.side;
    const intent = this.decide(this.pose[2] - this.heading);
    return this.walk(intent ? "step" : "halt", intent || { heading: 0, velocity: 0, gain: 0 },
      plan.landing(), plan.started + plan.plan.first);
  }
  walk(kind, intent, state, started) {
    const support = this.support(this.side);
    const swing = compose(inverse(support), this.support(-this.side));
    this.plan = this.motion = new Plan(this.game, kind, intent, this.side, swing, state, support, started);
    this.ends = started + this.plan.plan.lasts;
  }
  /* Joint targets of a reference, to the servos. Row 0 of each table is the tick before. */
  write({ body, zmp }) {
    const { data, states, references, limits, offsets } = this, { formulas } = this.game;
    references.set(body);
    if (!formulas.track_rows(references, states, limits, this.slowest)) this.clip();
    this.load(body, zmp);
    states.copyWithin(0, data.free + 7);
    const targets = table(offsets.shape[1], 1, this.angles().map((angle, j) => angle + offsets[j]));
    formulas.write_targets(targets, this.target, this.reach, this.lead, this.sent);
  }
  /* Step towards a reference that joint limits forbid: each joint goes as far as it can. */
  clip() {
    const { states, limits, references } = this, n = this.data.free;
    const step = this.game.formulas.leg_step(...states.subarray(0, n + 4), ...references.subarray(0, 15));
    const short = (move) => Math.min(Math.max(move, -0.1), 0.1);
    for (let j = 0; j < n; j++) {
      const [reach, low, high] = limits.subarray(3 * j, 3 * j + 3);
      const moved = states[j] + Math.min(Math.max(step[4 + j] || 0, -reach), reach);
      states[n + 7 + j] = Math.min(Math.max(moved, low), high);
    }
    const at = [...states.subarray(n, n + 2), states[n + 3]];
    const moved = compose(at, [short(step[0] || 0), short(step[1] || 0), short(step[3] || 0)]);
    const height = states[n + 2] + short(step[2] || 0);
    states.set([moved[0], moved[1], height, moved[2], states[n + 3], 0, 0], 2 * n + 7);
  }
  /* Offsets of the servos under the planned load; see locomotion/zmp/feedforward.py. */
  load(body, zmp) {
    const { data, points, torques, soon, offsets } = this, { formulas } = this.game;
    const [, , , leftX, leftY, z, left, rightX, rightY, w, right] = body;
    const [x, y] = compose([leftX, leftY, left], [data.ahead, 0, 0]);
    const [u, v] = compose([rightX, rightY, right], [data.ahead, 0, 0]);
    const share = ((zmp[0] - u) * (x - u) + (zmp[1] - v) * (y - v)) / ((x - u) ** 2 + (y - v) ** 2);
    const fraction = z > data.lifted ? 0 : w > data.lifted ? 1 : Math.min(Math.max(share, 0), 1);
    this.contacts.set([x, y, z, u, v, w, fraction]);
    formulas.load_rows(this.states, this.contacts, points, torques, 1 / data.tick ** 2, this.calls++);
    points.copyWithin(0, data.masses);
    const deflections = data.fixed.map(() => 0);
    data.legs.forEach((motor, i) => { deflections[motor] = data.compliance[motor] * torques[i]; });
    const before = this.deflections || deflections;
    this.deflections = deflections;
    soon.set(deflections.map((now, j) => Math.min(Math.max(2 * now - before[j], -data.bound), data.bound)));
    formulas.offset_rows(soon, offsets, this.weight, this.memoryOfOffsets);
    offsets.copyWithin(0, offsets.shape[1]);
  }
}

/* The game: two walkers in one world. Settings: start (distance, offsets of the headings), speeds
   [m/s], gain [1/s] and angle of evasion. */
class Game {
  constructor(mujoco, data, formulas) {
    Object.assign(this, { mujoco, data, formulas });
    this.model = mujoco.MjModel.from_xml_string(data.model.xml);
    for (const [name, text] of Object.entries(data.model.arrays)) {
      const values = doubles(text), own = this.model[name];
      if (own && own.length === values.length) own.set(values);
    }
    for (const { maps } of Object.values(data.plans || {}))
      for (const map of maps) for (const name of ["pendulum", "feet", "heights"]) map[name] = doubles(map[name]);
    this.physics = new mujoco.MjData(this.model);
    this.defaults = { start: data.start, speeds: data.players.map(() => data.speed), gain: data.gain,
      angle: data.evasion.angle };
    this.reset(this.defaults);
  }
  /* Views of the state; WebAssembly moves them when its memory grows. */
  get state() {
    if (!this.views || !this.views.qpos.length) {
      this.views = {};
      for (const name of ["qpos", "ctrl", "xpos", "xquat", "xmat", "subtree_com", "xfrc_applied",
        "site_xpos", "site_xmat", "qvel", "sensordata"])
        this.views[name] = this.physics[name];
    }
    return this.views;
  }
  reset(settings) {
    const [distance, pursuer, evader] = settings.start;
    this.settings = structuredClone(settings);
    this.ticks = 0;
    this.pushes = [];
    this.outcome = "";
    this.mujoco.mj_resetData(this.model, this.physics);
    const frames = [[0, 0, pursuer], [distance, 0, Math.PI + evader]];
    this.players = this.data.players.map((spec, i) => this.walker(spec, i, frames[i]));
    this.players.forEach((player, i) => { player.number = i; player.opponent = this.players[1 - i]; });
    this.mujoco.mj_forward(this.model, this.physics);
  }
  walker(spec, number, frame) { return new Walker(this, spec, frame); }
  get time() { return this.ticks * this.data.tick; }
  get distance() {
    const [a, b] = this.players.map((player) => player.truth().reference);
    return Math.hypot(b[0] - a[0], b[1] - a[1]);
  }
  /* Push a player with an impulse [N s] in the world, for 0.1 s. */
  push(number, x, y) {
    this.pushes.push({ at: 6 * this.data.players[number].torso, x: x / 0.1, y: y / 0.1, until: this.time + 0.1 });
  }
  /* Play one control tick, unless the game has ended. */
  tick() {
    if (this.outcome) return;
    for (const player of this.players) player.tick(this.time);
    this.step();
  }
  /* Advance physics by one control tick. */
  step() {
    const forces = this.state.xfrc_applied;
    for (const { at } of this.pushes) forces[at] = forces[at + 1] = 0;
    this.pushes = this.pushes.filter(({ until }) => until > this.time + 1e-9);
    for (const { at, x, y } of this.pushes) { forces[at] += x; forces[at + 1] += y; }
    for (let i = 0; i < this.data.steps; i++) this.mujoco.mj_step(this.model, this.physics);
    this.ticks += 1;
    this.judge();
  }
  judge() {
    const [a, b] = this.players.map((player) => player.truth());
    this.players.forEach(({ name }, i) => {
      if ([a, b][i].upright < this.data.fallen) this.outcome = `the ${name} fell`;
    });
    const reach = this.players.reduce((sum, { spec }) => sum + spec.radius, 0);
    if (Math.hypot(b.torso[0] - a.torso[0], b.torso[1] - a.torso[1]) < reach && this.touches())
      this.outcome = "contact";
  }
  touches() {
    const contacts = this.physics.contact, { geom_bodyid: body, body_rootid: root } = this.model;
    let found = false;
    for (let i = 0; i < contacts.size(); i++) {
      const contact = contacts.get(i), [one, other] = contact.geom;
      found = found || (root[body[one]] !== root[body[other]] && root[body[one]] > 0 && root[body[other]] > 0);
      contact.delete();
    }
    contacts.delete();
    return found;
  }
  /* Play some seconds at full speed; return rows of time and both torsos, ten a second. */
  simulate(seconds) {
    const rows = [], every = Math.round(0.1 / this.data.tick);
    for (const end = this.ticks + Math.round(seconds / this.data.tick); this.ticks < end && !this.outcome;) {
      if (this.ticks % every === 0) rows.push(this.row());
      this.tick();
    }
    return [...rows, this.row()];
  }
  row() { return [this.time, ...this.players.flatMap((player) => player.truth().torso)]; }
}
