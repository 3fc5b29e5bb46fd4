/* Scene of a run: floor, bodies and lines on the floor. Lengths in [m], z up. */

function makeScene(run, canvas, context) {
  const renderer = new THREE.WebGLRenderer({ canvas, context });
  renderer.outputEncoding = THREE.sRGBEncoding;
  renderer.shadowMap.enabled = true;
  renderer.shadowMap.type = THREE.PCFSoftShadowMap;
  const world = new THREE.Scene();
  const camera = new THREE.PerspectiveCamera(40, 1, 0.05, 200);
  camera.up.set(0, 0, 1);
  const linear = (colour) => new THREE.Color(colour).convertSRGBToLinear();

  const sky = new THREE.HemisphereLight(0xffffff, 0x8a8782, 0.5);
  const sun = new THREE.DirectionalLight(0xffffff, 0.62);
  sun.castShadow = true;
  sun.shadow.mapSize.set(2048, 2048);
  sun.shadow.radius = 4;
  sun.shadow.bias = -0.0005;
  world.add(sky, sun, sun.target);

  /* Tiles of 0.5 m, repeated beyond the extent of the run. */
  const side = 64;
  const tiles = new THREE.DataTexture(new Uint8Array(4 * side * side), side, side);
  tiles.magFilter = THREE.LinearFilter;
  tiles.minFilter = THREE.LinearMipmapLinearFilter;
  tiles.generateMipmaps = true;
  tiles.anisotropy = 8;
  tiles.encoding = THREE.sRGBEncoding;
  tiles.wrapS = tiles.wrapT = THREE.RepeatWrapping;
  const reach = 2 * Math.ceil(run.camera_distance + 20);
  const floor = new THREE.Mesh(new THREE.PlaneGeometry(2 * reach, 2 * reach),
    new THREE.MeshStandardMaterial({ map: tiles, roughness: 1 }));
  floor.position.set(2 * Math.round(run.center[0] / 2),
    2 * Math.round(run.center[1] / 2), 0);
  tiles.repeat.set(2 * reach, 2 * reach);
  floor.receiveShadow = true;
  world.add(floor);

  function shape(part) {
    const [a, b, c] = part.size;
    const segments = 24;
    if (part.kind === "mesh") {
      const mesh = new THREE.BufferGeometry();
      const vertices = new Float32Array(part.vertices.flat());
      mesh.setAttribute("position", new THREE.BufferAttribute(vertices, 3));
      mesh.setIndex(part.faces.flat());
      mesh.computeVertexNormals();
      return mesh;
    }
    if (part.kind === "box") return new THREE.BoxGeometry(2 * a, 2 * b, 2 * c);
    if (part.kind === "sphere") return new THREE.SphereGeometry(a, segments, 16);
    if (part.kind === "ellipsoid")
      return new THREE.SphereGeometry(1, segments, 16).scale(a, b, c);
    const column = part.kind === "capsule"
      ? new THREE.CapsuleGeometry(a, 2 * b, 8, segments)
      : new THREE.CylinderGeometry(a, a, 2 * b, segments);
    return column.rotateX(Math.PI / 2);
  }

  const quaternion = ([w, x, y, z]) => new THREE.Quaternion(x, y, z, w);
  const bodies = run.bodies.map(() => new THREE.Group());
  world.add(...bodies);
  for (const part of run.parts) {
    const glass = part.wall ? { transparent: true, opacity: 0.12, depthWrite: false } : {};
    const mesh = new THREE.Mesh(shape(part), new THREE.MeshStandardMaterial({
      color: linear(part.colour), roughness: 0.55, ...glass }));
    mesh.position.set(...part.position);
    mesh.quaternion.copy(quaternion(part.quaternion));
    mesh.receiveShadow = !part.wall;
    mesh.castShadow = !part.wall && part.casts_shadow;
    const body = run.bodies.indexOf(part.body);
    (body < 0 ? world : bodies[body]).add(mesh);
  }

  /* Corners of the two triangles of a straight part of a ribbon. */
  function stripe([ax, ay], [bx, by], width, height) {
    const length = Math.hypot(bx - ax, by - ay) || 1;
    const nx = -0.5 * width * (by - ay) / length, ny = 0.5 * width * (bx - ax) / length;
    return [ax + nx, ay + ny, height, ax - nx, ay - ny, height,
      bx + nx, by + ny, height, bx + nx, by + ny, height,
      ax - nx, ay - ny, height, bx - nx, by - ny, height];
  }

  /* Flat ribbon through points (x, y); a prefix of its triangles draws a prefix of the path. */
  function ribbon(points, width, height, closed) {
    const all = closed ? [...points, points[0]] : points;
    const corners = [];
    for (let i = 0; i + 1 < all.length; i++) corners.push(...stripe(all[i], all[i + 1], width, height));
    const strip = new THREE.BufferGeometry();
    strip.setAttribute("position", new THREE.Float32BufferAttribute(corners, 3));
    strip.computeBoundingSphere();
    return strip;
  }

  /* Materials whose colour depends on the theme: [material, player or palette name]. */
  const themed = [];
  function line(geometry, name, opacity) {
    const material = new THREE.MeshBasicMaterial({ side: THREE.DoubleSide,
      transparent: opacity < 1, opacity, depthWrite: opacity === 1 });
    themed.push([material, name]);
    const mesh = new THREE.Mesh(geometry, material);
    world.add(mesh);
    return mesh;
  }

  const circle = (x, y, r, n) => Array.from({ length: n }, (_, i) => [
    x + r * Math.cos(2 * Math.PI * i / n), y + r * Math.sin(2 * Math.PI * i / n)]);

  /* Arrow of a push: its tip is where the push acts; 0.25 m of length per [N s]. */
  function pushArrow([time, , x, y, ix, iy]) {
    const length = Math.max(0.12, 0.25 * Math.hypot(ix, iy));
    const shaft = line(new THREE.CylinderGeometry(0.012, 0.012, length - 0.08, 12)
      .translate(0, -0.5 * length - 0.04, 0), "pushed", 1);
    const head = line(new THREE.ConeGeometry(0.035, 0.08, 16).translate(0, -0.04, 0), "pushed", 1);
    const arrow = new THREE.Group();
    arrow.add(shaft, head);
    arrow.position.set(x, y, 0.3);
    arrow.rotation.z = Math.atan2(iy, ix) - Math.PI / 2;
    /* The group is switched with its layer, the arrow with time. */
    const group = new THREE.Group();
    group.add(arrow);
    world.add(layer("pushes", group));
    return { time, arrow };
  }

  function printPose([, side, x, y, heading]) {
    const c = Math.cos(heading), s = Math.sin(heading);
    return new THREE.Matrix4().set(c, -s * side, 0, x, s, c * side, 0, y, 0, 0, 1, 0.003, 0, 0, 0, 1);
  }

  const layers = {};
  const layer = (name, mesh) => { (layers[name] = layers[name] || []).push(mesh); return mesh; };
  const players = run.players.map((player, number) => {
    const drawn = { body: run.bodies.indexOf(player.torso), landings: player.landings };
    drawn.trace = layer("traces", line(
      ribbon(player.trace, 0.014, 0.006, false), number, 1));
    drawn.trace.frustumCulled = false;
    const [back, front, right, left] = run.sole;
    const prints = new THREE.InstancedMesh(
      new THREE.PlaneGeometry(front - back, left - right)
        .translate(0.5 * (front + back), 0.5 * (left + right), 0),
      new THREE.MeshBasicMaterial({ transparent: true, opacity: 0.3,
        side: THREE.DoubleSide, depthWrite: false }), Math.max(1, player.landings.length, run.footprints || 0));
    themed.push([prints.material, number]);
    player.landings.forEach((landing, i) => prints.setMatrixAt(i, printPose(landing)));
    prints.count = 0;
    prints.frustumCulled = false;
    world.add(prints);
    drawn.prints = run.footprints || player.landings.length ? layer("footsteps", prints) : prints;
    drawn.pushes = player.pushes.map(pushArrow);
    return drawn;
  });
  const guarded = run.safeties.map(([number, radius]) => {
    const dashes = new THREE.Group();
    const points = circle(0, 0, radius, 96);
    for (let i = 0; i < 96; i += 3) {
      const dash = [points[i], points[i + 1], points[(i + 2) % 96]];
      dashes.add(line(ribbon(dash, 0.012, 0.008, false), number, 1));
    }
    world.add(dashes);
    return [players[number], layer("safety radius", dashes)];
  });
  const theory = new THREE.Group();
  if (run.circle) {
    const [x, y, radius] = run.circle;
    theory.add(layer("theoretical circle", line(
      ribbon(circle(0, 0, radius, 128), 0.012, 0.010, true), "theory", 1)));
    theory.position.set(x, y, 0);
    world.add(theory);
  }
  const rods = run.sights.map(() => line(
    new THREE.CylinderGeometry(0.004, 0.004, 1, 8).rotateX(Math.PI / 2), "theory", 0.8));
  if (rods.length) {
    const sights = new THREE.Group();
    sights.add(...rods);
    world.add(sights);
    layer("line of sight", sights);
  }

  function applyTheme(theme) {
    const palette = run.palettes[theme];
    const rgba = (c) => [1, 3, 5].map((i) => parseInt(c.slice(i, i + 2), 16)).concat(255);
    const [floorColour, tileColour] = [rgba(palette.floor), rgba(palette.tile)];
    for (let i = 0; i < side * side; i++)
      tiles.image.data.set((i % side < side / 2) === (i < side * side / 2) ? floorColour : tileColour, 4 * i);
    tiles.needsUpdate = true;
    world.background = linear(palette.sky);
    world.fog = new THREE.Fog(linear(palette.sky), 12 + run.camera_distance, 40 + 2 * run.camera_distance);
    for (const [material, name] of themed)
      material.color = linear(typeof name === "number" ? run.players[name].colours[theme] : palette[name]);
  }

  const positions = new Float32Array(run.positions), quaternions = new Int16Array(run.quaternions);
  const count = run.bodies.length;
  const from = new THREE.Quaternion(), to = new THREE.Quaternion();
  /* Show a time between two samples (fraction 0 to 1); return the torsos' positions, in [m]. */
  function show(index, fraction) {
    const next = Math.min(index + 1, run.times.length - 1);
    bodies.forEach((body, number) => {
      const p = 3 * (index * count + number), q = 3 * (next * count + number);
      const at = [0, 1, 2].map((i) => positions[p + i] + fraction * (positions[q + i] - positions[p + i]));
      body.position.set(...at);
      const a = 4 * (index * count + number), b = 4 * (next * count + number);
      from.set(quaternions[a + 1], quaternions[a + 2], quaternions[a + 3], quaternions[a]).normalize();
      to.set(quaternions[b + 1], quaternions[b + 2], quaternions[b + 3], quaternions[b]).normalize();
      body.quaternion.copy(from).slerp(to, fraction);
    });
    const now = run.times[index] + fraction * (run.times[next] - run.times[index]);
    for (const player of players) {
      player.trace.geometry.setDrawRange(0, 6 * index);
      /* A footstep appears 0.5 s before it lands. */
      let count = 0;
      while (count < player.landings.length && player.landings[count][0] <= now + 0.5) count++;
      player.prints.count = count;
      for (const push of player.pushes) push.arrow.visible = now >= push.time && now < push.time + 1;
    }
    return attach();
  }
  /* Show bodies where a game has them: arrays by the number of the body. Return as show does. */
  function place(xpos, xquat) {
    run.bodies.forEach((number, i) => {
      bodies[i].position.fromArray(xpos, 3 * number);
      const [w, x, y, z] = xquat.subarray(4 * number, 4 * number + 4);
      bodies[i].quaternion.set(x, y, z, w);
    });
    return attach();
  }
  /* Lines that move with the players; return the torsos' positions. */
  function attach() {
    const torsos = players.map((player) => bodies[player.body].position);
    for (const [player, area] of guarded) area.position.copy(bodies[player.body].position).setZ(0);
    rods.forEach((rod, number) => {
      const [first, second] = run.sights[number].map((i) => torsos[i]);
      rod.position.addVectors(first, second).multiplyScalar(0.5);
      rod.scale.z = first.distanceTo(second);
      rod.lookAt(second);
    });
    return torsos;
  }
  /* Path and footprints of a player that grow while a game is played; both forget their oldest part. */
  function growing(number) {
    const { trace, prints } = players[number], most = 6000, width = 0.014;
    const strip = new THREE.BufferGeometry();
    const corners = new THREE.BufferAttribute(new Float32Array(18 * most), 3);
    strip.setAttribute("position", corners);
    trace.geometry = strip;
    let last = null, parts = 0, steps = 0;
    const clear = () => { last = null; parts = steps = prints.count = 0; strip.setDrawRange(0, 0); };
    clear();
    return { clear,
      move(point) {
        if (last && Math.hypot(point[0] - last[0], point[1] - last[1]) < 0.004) return;
        if (last) {
          corners.array.set(stripe(last, point, width, 0.006), 18 * (parts++ % most));
          corners.needsUpdate = true;
          strip.setDrawRange(0, 6 * Math.min(parts, most));
        }
        last = point;
      },
      land(landing) {
        prints.setMatrixAt(steps++ % run.footprints, printPose(landing));
        prints.instanceMatrix.needsUpdate = true;
        prints.count = Math.min(steps, run.footprints);
      } };
  }

  /* Draw without shadows and highlights, with at most this number of points per pixel and axis. */
  function simplify(points) {
    renderer.shadowMap.enabled = sun.castShadow = false;
    renderer.pixels = points;
    world.traverse((mesh) => {
      if (!mesh.material || !mesh.material.isMeshStandardMaterial) return;
      const { color, map, transparent, opacity, depthWrite } = mesh.material;
      mesh.material = new THREE.MeshLambertMaterial({ color, map, transparent, opacity, depthWrite });
    });
  }

  function draw(target) {
    sun.position.set(target.x + 2.5, target.y - 3.5, 6);
    sun.target.position.copy(target);
    const half = Math.min(12, 1.5 + 0.5 * camera.position.distanceTo(target));
    Object.assign(sun.shadow.camera, { left: -half, right: half, top: half, bottom: -half, far: 30 });
    sun.shadow.camera.updateProjectionMatrix();
    renderer.render(world, camera);
  }

  return { renderer, camera, world, layers, applyTheme, show, place, growing, simplify, draw, bodies, theory };
}
