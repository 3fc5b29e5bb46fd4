/* The scene: floor, bodies, lines on the floor. Units are metres, z is up. */

function makeScene(run, canvas, context) {
  const renderer = new THREE.WebGLRenderer({ canvas, context });
  renderer.outputEncoding = THREE.sRGBEncoding;
  renderer.shadowMap.enabled = true;
  renderer.shadowMap.type = THREE.PCFSoftShadowMap;
  const world = new THREE.Scene();
  const camera = new THREE.PerspectiveCamera(40, 1, 0.05, 200);
  camera.up.set(0, 0, 1);
  const paint = (colour) => new THREE.Color(colour).convertSRGBToLinear();

  const sky = new THREE.HemisphereLight(0xffffff, 0x8a8782, 0.5);
  const sun = new THREE.DirectionalLight(0xffffff, 0.62);
  sun.castShadow = true;
  sun.shadow.mapSize.set(2048, 2048);
  sun.shadow.radius = 4;
  sun.shadow.bias = -0.0005;
  world.add(sky, sun, sun.target);

  /* Tiles of half a metre, far enough for whoever walks for an hour. */
  const side = 64;
  const tiles = new THREE.DataTexture(new Uint8Array(4 * side * side), side, side);
  tiles.magFilter = THREE.LinearFilter;
  tiles.minFilter = THREE.LinearMipmapLinearFilter;
  tiles.generateMipmaps = true;
  tiles.anisotropy = 8;
  tiles.encoding = THREE.sRGBEncoding;
  tiles.wrapS = tiles.wrapT = THREE.RepeatWrapping;
  const reach = 2 * Math.ceil(run.away + 20);
  const floor = new THREE.Mesh(new THREE.PlaneGeometry(2 * reach, 2 * reach),
    new THREE.MeshStandardMaterial({ map: tiles, roughness: 1 }));
  floor.position.set(2 * Math.round(run.middle[0] / 2),
    2 * Math.round(run.middle[1] / 2), 0);
  tiles.repeat.set(2 * reach, 2 * reach);
  floor.receiveShadow = true;
  world.add(floor);

  function shape(part) {
    const [a, b, c] = part.size;
    const round = 24;
    if (part.kind === "mesh") {
      const shell = new THREE.BufferGeometry();
      const corners = new Float32Array(part.corners.flat());
      shell.setAttribute("position", new THREE.BufferAttribute(corners, 3));
      shell.setIndex(part.faces.flat());
      shell.computeVertexNormals();
      return shell;
    }
    if (part.kind === "box") return new THREE.BoxGeometry(2 * a, 2 * b, 2 * c);
    if (part.kind === "sphere") return new THREE.SphereGeometry(a, round, 16);
    if (part.kind === "ellipsoid")
      return new THREE.SphereGeometry(1, round, 16).scale(a, b, c);
    const long = part.kind === "capsule"
      ? new THREE.CapsuleGeometry(a, 2 * b, 8, round)
      : new THREE.CylinderGeometry(a, a, 2 * b, round);
    return long.rotateX(Math.PI / 2);
  }

  const quaternion = ([w, x, y, z]) => new THREE.Quaternion(x, y, z, w);
  const bodies = run.bodies.map(() => new THREE.Group());
  const walls = [];
  world.add(...bodies);
  for (const part of run.parts) {
    const see = part.wall ? { transparent: true, opacity: 0.12, depthWrite: false } : {};
    const mesh = new THREE.Mesh(shape(part), new THREE.MeshStandardMaterial({
      color: paint(part.colour), roughness: 0.55, ...see }));
    mesh.position.set(...part.place);
    mesh.quaternion.copy(quaternion(part.turn));
    mesh.receiveShadow = !part.wall;
    mesh.castShadow = !part.wall && part.shades;
    const body = run.bodies.indexOf(part.body);
    (body < 0 ? world : bodies[body]).add(mesh);
  }

  /* A flat ribbon along points; its first triangles can be drawn alone. */
  function ribbon(points, width, height, closed) {
    const all = closed ? [...points, points[0]] : points;
    const corners = [];
    for (let i = 0; i + 1 < all.length; i++) {
      const [ax, ay] = all[i], [bx, by] = all[i + 1];
      const long = Math.hypot(bx - ax, by - ay) || 1;
      const nx = -0.5 * width * (by - ay) / long, ny = 0.5 * width * (bx - ax) / long;
      corners.push(ax + nx, ay + ny, height, ax - nx, ay - ny, height,
        bx + nx, by + ny, height, bx + nx, by + ny, height,
        ax - nx, ay - ny, height, bx - nx, by - ny, height);
    }
    const flat = new THREE.BufferGeometry();
    flat.setAttribute("position", new THREE.Float32BufferAttribute(corners, 3));
    flat.computeBoundingSphere();
    return flat;
  }

  const dyes = [];
  function line(geometry, name, opacity) {
    const ink = new THREE.MeshBasicMaterial({ side: THREE.DoubleSide,
      transparent: opacity < 1, opacity, depthWrite: opacity === 1 });
    dyes.push([ink, name]);
    const mesh = new THREE.Mesh(geometry, ink);
    world.add(mesh);
    return mesh;
  }

  const circle = (x, y, r, n) => Array.from({ length: n }, (_, i) => [
    x + r * Math.cos(2 * Math.PI * i / n), y + r * Math.sin(2 * Math.PI * i / n)]);

  /* A push: an arrow that ends where it was felt, as long as it was strong. */
  function arrow([time, , x, y, ix, iy]) {
    const strength = Math.hypot(ix, iy), long = Math.max(0.12, 0.25 * strength);
    const shaft = line(new THREE.CylinderGeometry(0.012, 0.012, long - 0.08, 12)
      .translate(0, -0.5 * long - 0.04, 0), "pushed", 1);
    const head = line(new THREE.ConeGeometry(0.035, 0.08, 16).translate(0, -0.04, 0), "pushed", 1);
    const all = new THREE.Group();
    all.add(shaft, head);
    all.position.set(x, y, 0.3);
    all.rotation.z = Math.atan2(iy, ix) - Math.PI / 2;
    const switched = new THREE.Group();
    switched.add(all);
    world.add(layer("pushes", switched));
    return { time, all };
  }

  const layers = {};
  const layer = (name, mesh) => { (layers[name] = layers[name] || []).push(mesh); return mesh; };
  const robots = run.robots.map((robot, who) => {
    const made = { body: run.bodies.indexOf(robot.torso), robot };
    made.trace = layer("traces", line(
      ribbon(robot.trace, 0.014, 0.006, false), who, 1));
    made.trace.frustumCulled = false;
    const [back, front, right, left] = run.sole;
    const prints = new THREE.InstancedMesh(
      new THREE.PlaneGeometry(front - back, left - right)
        .translate(0.5 * (front + back), 0.5 * (left + right), 0),
      new THREE.MeshBasicMaterial({ transparent: true, opacity: 0.3,
        side: THREE.DoubleSide, depthWrite: false }), Math.max(1, robot.landings.length));
    dyes.push([prints.material, who]);
    robot.landings.forEach(([, side, x, y, turn], i) => {
      const c = Math.cos(turn), s = Math.sin(turn);
      const place = new THREE.Matrix4();
      place.set(c, -s * side, 0, x, s, c * side, 0, y, 0, 0, 1, 0.003, 0, 0, 0, 1);
      prints.setMatrixAt(i, place);
    });
    prints.count = 0;
    prints.frustumCulled = false;
    world.add(prints);
    made.prints = layer("footsteps", prints);
    made.pushes = robot.pushes.map(arrow);
    return made;
  });
  const guarded = run.safety ? robots[run.guarded] : null;
  let safety = null;
  if (guarded) {
    const dashes = new THREE.Group();
    const all = circle(0, 0, run.safety, 96);
    for (let i = 0; i < 96; i += 3) {
      const dash = line(ribbon([all[i], all[i + 1], all[(i + 2) % 96]], 0.012, 0.008, false), run.guarded, 1);
      dashes.add(dash);
    }
    world.add(dashes);
    safety = layer("safety area", dashes);
  }
  if (run.circle)
    layer("circle of theory", line(
      ribbon(circle(...run.circle, 128), 0.012, 0.010, true), "theory", 1));
  let sight = null;
  if (robots.length > 1)
    sight = layer("line of sight", line(
      new THREE.CylinderGeometry(0.004, 0.004, 1, 8).rotateX(Math.PI / 2), "theory", 0.8));

  function dress(light) {
    const palette = run.palettes[light];
    const bytes = (c) => [1, 3, 5].map((i) => parseInt(c.slice(i, i + 2), 16)).concat(255);
    const [one, two] = [bytes(palette.floor), bytes(palette.tile)];
    for (let i = 0; i < side * side; i++)
      tiles.image.data.set((i % side < side / 2) === (i < side * side / 2) ? one : two, 4 * i);
    tiles.needsUpdate = true;
    world.background = paint(palette.sky);
    world.fog = new THREE.Fog(paint(palette.sky), 12 + run.away, 40 + 2 * run.away);
    for (const [ink, name] of dyes) 
      ink.color = paint(typeof name === "number" ? run.robots[name].colours[light] : palette[name]);
  }

  const places = new Float32Array(run.places), turns = new Int16Array(run.turns);
  const count = run.bodies.length;
  const from = new THREE.Quaternion(), to = new THREE.Quaternion();
  /* Put all where it was: a share of the way from one sample to the next. */
  function show(index, share) {
    const next = Math.min(index + 1, run.times.length - 1);
    bodies.forEach((body, number) => {
      const p = 3 * (index * count + number), q = 3 * (next * count + number);
      const at = [0, 1, 2].map((i) => places[p + i] + share * (places[q + i] - places[p + i]));
      body.position.set(...at);
      const a = 4 * (index * count + number), b = 4 * (next * count + number);
      from.set(turns[a + 1], turns[a + 2], turns[a + 3], turns[a]).normalize();
      to.set(turns[b + 1], turns[b + 2], turns[b + 3], turns[b]).normalize();
      body.quaternion.copy(from).slerp(to, share);
    });
    const now = run.times[index] + share * (run.times[next] - run.times[index]);
    for (const one of robots) {
      one.trace.geometry.setDrawRange(0, 6 * index);
      const steps = one.robot.landings;
      let seen = 0;
      while (seen < steps.length && steps[seen][0] <= now + 0.5) seen++;
      one.prints.count = seen;
      for (const push of one.pushes) push.all.visible = now >= push.time && now < push.time + 1;
    }
    const seats = robots.map((one) => bodies[one.body].position);
    if (safety) safety.position.copy(bodies[guarded.body].position).setZ(0);
    if (sight) {
      sight.position.addVectors(seats[0], seats[1]).multiplyScalar(0.5);
      sight.scale.z = seats[0].distanceTo(seats[1]);
      sight.lookAt(seats[1]);
    }
    return seats;
  }

  function draw(target) {
    sun.position.set(target.x + 2.5, target.y - 3.5, 6);
    sun.target.position.copy(target);
    const wide = Math.min(12, 1.5 + 0.5 * camera.position.distanceTo(target));
    Object.assign(sun.shadow.camera, { left: -wide, right: wide, top: wide, bottom: -wide, far: 30 });
    sun.shadow.camera.updateProjectionMatrix();
    renderer.render(world, camera);
  }

  return { renderer, camera, layers, dress, show, draw, bodies, robots };
}
