/* Robots on learned legs: sensors, odometry and observations around generated formulas; a network
   that the visitor chooses. Lengths in [m], angles in [rad], times in [s]. */

const clamp = (value, low, high) => Math.min(Math.max(value, low), high);

/* One robot on learned legs: the parts of locomotion/policy/ on the sensors of the simulation. */
class LegsWalker extends Robot {
  constructor(game, spec, frame, body) {
    super(game, spec, frame);
    const { learned: legs } = this.data, { policy } = legs;
    Object.assign(this, { legs, policy, body, plan: null, turning: 0, phase: "stands" });
    this.velocity = this.intended = [0, 0, 0];
    this.next = 0;
    [this.up, this.yawing, this.bias] = [table(3, 1, [0, 0, 1]), table(1, 1), table(2, 1)];
    [this.correction, this.wish, this.wanted] = [0, 1, 2].map(() => table(3, 1));
    this.learning = table(2, 1, [legs.learning, policy.period]);
    this.following = table(3, 1, [this.data.tick, 0, 0]);
    this.stood = 0;
    [this.site, this.gravity] = [body.place, legs.gravity].map((values) => table(3, 1, values));
    this.mount = table(3, 3, body.mount.flat());
    this.clock = table(1, 1);
    this.last = table(17, 1);
    this.last[0] = -1;
    this.imu = table(9, 1);
    this.angles = table(body.qpos.length, 1);
    this.numbers = table(27, 1);
    this.corners = table(8, 2, legs.corners.flat());
    this.given = table(7, 1, [0, 0, 0, 0, legs.smoothing, ...legs.ratio]);
    [this.points, this.loads, this.forces] = [table(9, 3), table(2, 8), table(8, 1)];
    [this.speed, this.position, this.moved] = [table(3, 1), table(3, 1), table(3, 1)];
    this.sizes = Int32Array.from(legs.sizes);
    this.commands = table(3, legs.commands[0].length, legs.commands.flat());
    this.effects = table(legs.effects.length, 3, legs.effects.flat());
    this.values = new Float64Array(policy.size);
    const column = (values) => table(values.length, 1, values.map((value) => value ?? Infinity));
    const { offsets, order, clips, scales } = policy;
    [this.offsets, this.phases, this.gait] = [offsets, offsets, policy.clock].map(column);
    [this.posture, this.order, this.clips, this.scales] = [policy.default, order, clips, scales].map(column);
    [this.scale, this.limits] = [policy.scale, policy.limits].map(column);
    [this.actions, this.frequency] = [policy.actions, policy.frequency].map((place) => this.values.subarray(...place));
    this.seen = table(order.length, 1);
    this.past = null;
    this.targets = Float64Array.from(policy.default);
    this.states = legs.network.states.map(([, , shape]) => new Float32Array(shape.reduce((a, b) => a * b, 1)));
    this.stand(legs.posture, legs.targets);
  }
  get ready() { return this.stood >= this.legs.calibration - 1e-9; }
  get state() { return this.phase; }
  /* Roll and pitch of the torso. */
  get tilt() {
    const [x, y, z] = this.up;
    return [Math.atan2(y, z), -Math.asin(clamp(x, -1, 1))];
  }
  /* Observation of the network at a tick. */
  sense(now) {
    const { qpos, qvel, sensordata } = this.game.state, { body, game } = this;
    this.clock[0] = game.physics.time;
    const [at, dof] = body.free;
    game.formulas.strapdown(qpos.subarray(at + 3, at + 7), qvel.subarray(dof, dof + 3),
      qvel.subarray(dof + 3, dof + 6), this.site, this.mount, this.gravity, this.clock, this.last, this.imu);
    body.qpos.forEach((address, i) => { this.angles[i] = qpos[address]; });
    body.forces.forEach((address, i) => { this.forces[i] = sensordata[address]; });
    this.choose(now);
    this.balance();
    this.navigate();
    return this.observe(body.dofs.map((address) => qvel[address]));
  }
  /* Decisions at fixed intervals; see locomotion/policy/policy_walk.py. */
  choose(now) {
    const stands = this.phase === "stands";
    if (!(stands ? this.ready : now >= this.next - 1e-9)) return;
    const intent = this.decide(0);
    if (stands && !intent) return;
    this.turning = intent ? intent.heading : 0;
    this.velocity = intent ? [intent.velocity, 0, intent.gain * intent.heading] : [0, 0, 0];
    this.phase = this.velocity.some(Boolean) ? "walks" : "stands";
    this.next = now + this.data.step;
    this.intended = this.nearest(this.velocity);
  }
  /* Deliverable velocity with the same path; see strategies/velocity_set.py. */
  nearest(velocity) {
    const limits = this.legs.bounds.map(([low, high], i) => velocity[i] > 0 ? high : -low);
    const relative = velocity.map((value, i) => limits[i] > 0 ? Math.abs(value) / limits[i] : 0);
    let share = 1;
    relative.forEach((part, i) => { if (part > 1) share = Math.min(share, limits[i] / Math.abs(velocity[i])); });
    const oblique = Math.hypot(relative[0], relative[1]);
    if (relative[0] && relative[1] && oblique > 1) share = Math.min(share, 1 / oblique);
    return velocity.map((value, i) => share * (limits[i] > 0 ? value : 0));
  }
  /* Direction of gravity; see locomotion/policy/gravity_filter.py. */
  balance() {
    const { legs, imu, data } = this;
    this.following.set(legs.corrections[this.ready ? 1 : 0], 1);
    this.stood += data.tick;
    this.game.formulas.follow_gravity(this.up, this.yawing, this.bias, imu.subarray(0, 3), imu.subarray(3, 6),
      this.speed, this.following);
  }
  /* Odometry, then the command for the intended velocity; see locomotion/policy/policy_legs.py. */
  navigate() {
    const { formulas } = this.game, { legs, policy, numbers } = this, { period } = policy;
    const turned = this.yawing[0] * this.data.tick;
    formulas.posture_row(this.angles, numbers);
    this.given.set([...this.tilt, turned, period]);
    const feet = table(2, 3, numbers.subarray(3, 9)), axes = table(6, 3, numbers.subarray(9, 27));
    formulas.note(numbers, feet, axes, this.corners, this.forces, this.given, this.points, this.loads,
      this.speed, this.position, this.moved);
    if (!this.intended.some(Boolean)) {
      this.wanted.fill(0);
      return;
    }
    formulas.learn(this.intended, this.moved, this.learning, this.correction, this.wish);
    formulas.invert(this.wish, this.sizes, this.commands, this.effects, table(3, 1), table(3, 3), this.wanted);
  }
  /* Input of the network; see locomotion/policy/runner.py. */
  observe(velocities) {
    const { policy, seen } = this;
    this.game.formulas.observe(this.angles, velocities, this.imu.subarray(6, 9), this.up, this.speed, this.wanted,
      this.legs.joints, this.posture, this.values, this.phases, this.offsets, this.gait, this.order, this.clips,
      this.scales, seen);
    if (policy.history === 1) return Float32Array.from(seen);
    this.past = this.past ? [...this.past.slice(1), [...seen]] : Array(policy.history).fill([...seen]);
    const all = this.past.flat();
    return Float32Array.from(policy.flat, (place) => all[place]);
  }
  /* Joint targets of an action, to the actuators. */
  act(raw) {
    const { legs } = this;
    this.game.formulas.act(table(raw.length, 1, raw), this.posture, this.scale, this.limits, this.actions, this.targets,
      this.frequency, this.gait);
    for (const joints of legs.coupled) {
      const mean = joints.reduce((sum, i) => sum + this.targets[i], 0) / joints.length;
      joints.forEach((i) => { this.targets[i] = mean; });
    }
    const sent = this.sent;
    legs.joints.forEach((j, i) => { sent[j] = this.targets[i]; });
  }
}

/* A duel on learned legs; its ticks wait for the network. */
class LegsGame extends Game {
  constructor(mujoco, data, formulas, runtime, session) {
    super(mujoco, data, formulas);
    Object.assign(this, { runtime, session });
  }
  walker(spec, number, frame) { return new LegsWalker(this, spec, frame, this.data.learned.players[number]); }
  async tick() {
    if (this.outcome) return;
    const { input, output, states } = this.data.learned.network, { Tensor } = this.runtime, began = this.players;
    for (const player of began) {
      const seen = player.sense(this.time);
      const given = { [input]: new Tensor("float32", seen, [1, seen.length]) };
      states.forEach(([name, , shape], i) => { given[name] = new Tensor("float32", player.states[i], shape); });
      const found = await this.session.run(given);
      if (began !== this.players) return;  // it was started again meanwhile
      player.states = states.map(([, name]) => Float32Array.from(found[name].data));
      player.act(found[output].data);
    }
    this.step();
  }
  async simulate(seconds) {
    const rows = [], every = Math.round(0.1 / this.data.tick);
    for (const end = this.ticks + Math.round(seconds / this.data.tick); this.ticks < end && !this.outcome;) {
      if (this.ticks % every === 0) rows.push(this.row());
      await this.tick();
    }
    return [...rows, this.row()];
  }
}
