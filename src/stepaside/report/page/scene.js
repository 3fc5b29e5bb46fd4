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

  /* Lines over the scene: a flat bar for each segment, in the order of their times. */
  const BAR = 0.008, layers = {};
  const overlays = run.overlays.map((own) => {
    const ends = new Float32Array(decode(own.segments)), corners = [];
    for (let i = 0; i < ends.length; i += 4) {
      const [ax, ay, bx, by] = ends.subarray(i, i + 4), length = Math.hypot(bx - ax, by - ay) || 1;
      const nx = -0.5 * BAR * (by - ay) / length, ny = 0.5 * BAR * (bx - ax) / length;
      const a = [ax + nx, ay + ny, 0], b = [ax - nx, ay - ny, 0];
      const c = [bx + nx, by + ny, 0], d = [bx - nx, by - ny, 0];
      corners.push(...a, ...b, ...c, ...c, ...b, ...d);
    }
    const bars = new THREE.BufferGeometry();
    bars.setAttribute("position", new THREE.Float32BufferAttribute(corners, 3));
    const rod = new THREE.CylinderGeometry(0.004, 0.004, 1, 8).rotateX(Math.PI / 2);
    const mesh = new THREE.Mesh(own.follows.length === 2 ? rod : bars,
      new THREE.MeshBasicMaterial({ side: THREE.DoubleSide }));
    mesh.position.z = own.height;
    mesh.frustumCulled = false;
    world.add(mesh);
    (layers[own.layer] = layers[own.layer] || []).push(mesh);
    return { ...own, mesh, times: own.times && new Float32Array(decode(own.times)) };
  });

  function applyTheme(theme) {
    const palette = run.palettes[theme];
    const rgba = (c) => [1, 3, 5].map((i) => parseInt(c.slice(i, i + 2), 16)).concat(255);
    const [floorColour, tileColour] = [rgba(palette.floor), rgba(palette.tile)];
    for (let i = 0; i < side * side; i++)
      tiles.image.data.set((i % side < side / 2) === (i < side * side / 2) ? floorColour : tileColour, 4 * i);
    tiles.needsUpdate = true;
    world.background = linear(palette.sky);
    world.fog = new THREE.Fog(linear(palette.sky), 12 + run.camera_distance, 40 + 2 * run.camera_distance);
    for (const { mesh, colours } of overlays) mesh.material.color = linear(colours[theme]);
  }

  const positions = new Float32Array(decode(run.positions)), quaternions = new Int16Array(decode(run.quaternions));
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
    const torsos = run.players.map((player) => bodies[run.bodies.indexOf(player.torso)].position);
    for (const { mesh, times, lasting, follows, height } of overlays) {
      if (times) {
        const start = lasting === null ? 0 : countUntil(times, now - lasting);
        mesh.geometry.setDrawRange(6 * start, 6 * (countUntil(times, now) - start));
      }
      const [first, second] = follows.map((i) => torsos[i]);
      if (second) {
        mesh.position.addVectors(first, second).multiplyScalar(0.5);
        mesh.scale.z = first.distanceTo(second);
        mesh.lookAt(second);
      } else if (first) mesh.position.copy(first).setZ(height);
    }
    return torsos;
  }

  function draw(target) {
    sun.position.set(target.x + 2.5, target.y - 3.5, 6);
    sun.target.position.copy(target);
    const half = Math.min(12, 1.5 + 0.5 * camera.position.distanceTo(target));
    Object.assign(sun.shadow.camera, { left: -half, right: half, top: half, bottom: -half, far: 30 });
    sun.shadow.camera.updateProjectionMatrix();
    renderer.render(world, camera);
  }

  return { renderer, camera, layers, applyTheme, show, draw, bodies };
}
