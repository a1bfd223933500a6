// A run on the device: what is drawn of it, where it is now, and its light maps.
const textureWidth = 1024;
const sunSize = 512, skySize = 256;
const springRadius = { structural: 0.026, shear: 0.014, bending: 0.018 };  // in spacings
const types = ["structural", "shear", "bending"];

// Towards the sun: from the left of the default camera, from the right where that would leave a slope in the dark.
function sunOver(terrain) {
  const left = unit([-0.6, 0.78, -0.12]), right = unit([0.35, 0.85, -0.38]);
  const slant = (sun) => Math.min(1, ...terrain.filter((t) => t.flat).map((t) => dot(sun, t.flat.normal)));
  return slant(left) >= 0.5 || slant(left) >= slant(right) ? left : right;
}

// Rows of a rotation whose z goes away from a light.
function lightRows(towards) {
  const up = Math.abs(towards[1]) > 0.999 ? [1, 0, 0] : [0, 1, 0];
  const z = times(-1, towards), x = unit(cross(up, z));
  return [x, cross(z, x), z];
}

// Cords take the place of a surface.
const drawsCords = (look) => look.solid && !look.structural;

class Bodies {
  constructor(device, run) {
    const { gl } = device, { facts } = run;
    Object.assign(this, { device, run, facts, motion: new Motion(run), springs: new Springs(run), meshes: new Meshes(facts) });
    const rows = Math.max(1, Math.ceil(this.meshes.end / textureWidth));
    this.texels = new Float32Array(4 * textureWidth * rows);
    this.rows = rows;
    this.particles = device.texture(gl.RGBA32F, textureWidth, rows, { filter: gl.NEAREST });
    this.skins = skins(facts);
    this.skin = device.array([[this.skins.vertices, 0, 1, { stride: 20 }]], this.skins.indices);
    gl.bindVertexArray(this.skin.vao);
    gl.enableVertexAttribArray(1);
    gl.vertexAttribIPointer(1, 4, gl.UNSIGNED_INT, 20, 4);
    gl.bindVertexArray(null);
    this.ribbons = {};
    for (const type of types) this.addRibbons(type, this.springs.ofType(type));
    this.addRibbons("cords", this.springs.cords());
    const rods = facts.bodies.flatMap((body) => body.rods);
    if (rods.length > 0) this.rods = this.mesh(rodMesh(rods));
    this.terrain = facts.terrain.map((t) => this.placed(t));
    this.places = device.buffer(new Float32Array(4 * facts.balls.length));
    this.turns = device.buffer(new Float32Array(4 * facts.balls.length));
    this.looks = device.buffer(new Float32Array(4 * facts.balls.length));
    const once = { divisor: 1 };
    this.balls = device.array([[this.places, 0, 4, once], [this.turns, 1, 4, once], [this.looks, 2, 4, once]]);
    this.sun = sunOver(facts.terrain);
    const flat = facts.terrain.find((t) => t.flat);
    this.lightRows = [lightRows(this.sun), lightRows(flat ? flat.flat.normal : [0, 1, 0])];
    const formats = device.floats ? [gl.RG16F, gl.RGBA16F] : [gl.RGBA8, gl.RGBA8];
    this.maps = [sunSize, skySize].map((size, i) =>
      device.image(formats[i], size, size, { levels: Math.log2(size) + 1, depth: i === 0 }));
  }

  mesh({ vertices, indices }) {
    const buffer = this.device.buffer(vertices);
    return this.device.array([[buffer, 0, 3, { stride: 24 }], [buffer, 1, 3, { stride: 24, offset: 12 }]], indices);
  }

  addRibbons(name, springs) {
    const ends = new Uint32Array(2 * springs.length);
    if (springs.length === 0) return;
    springs.forEach((s, i) => ends.set([this.springs.a[s], this.springs.b[s]], 2 * i));
    const values = new Float32Array(springs.length), buffer = this.device.buffer(values);
    const array = this.device.array([[ends, 0, 2, { divisor: 1 }], [buffer, 1, 1, { divisor: 1 }]]);
    this.ribbons[name] = { springs, values, buffer, array, count: springs.length };
  }

  placed(t) {
    const made = { facts: t };
    if (!t.surface) return made;
    made.mesh = this.mesh(terrainMesh(t));
    if (!t.flat) return made;
    const { gl } = this.device, { side, offs } = t.surface;
    made.hole = this.device.texture(gl.R8, side, side);
    gl.pixelStorei(gl.UNPACK_ALIGNMENT, 1);
    gl.texSubImage2D(gl.TEXTURE_2D, 0, 0, 0, side, side, gl.RED, gl.UNSIGNED_BYTE, Uint8Array.from(offs, (off) => off + 128));
    return made;
  }

  // Where a terrain is displaced to now.
  offset({ motion }) {
    if (!motion) return [0, 0, 0];
    return times(Math.sin(2 * Math.PI * (motion.frequency * this.time + motion.phase)), motion.along);
  }

  // How far what the camera follows has come since the start of the scene.
  followed() {
    const { follow, bodies } = this.facts;
    if (!follow) return [0, 0, 0];
    const x = this.motion[follow.ball ? "balls" : "x"];
    if (follow.ball) return minus(Array.from(x.subarray(3 * follow.index, 3 * follow.index + 3)), follow.start);
    const { first, count } = bodies[follow.index], sum = [0, 0, 0];
    for (let i = 3 * first; i < 3 * (first + count); ++i) sum[i % 3] += x[i];
    return minus(times(1 / count, sum), follow.start);
  }

  // The state at a place of the recording, colored as `look` says.
  move(place, look) {
    const { motion, run, springs, texels, facts } = this, { gl } = this.device, { x, v } = motion;
    const next = Math.min(place.image + 1, run.times.length - 1);
    this.time = run.times[place.image] + place.share * (run.times[next] - run.times[place.image]);
    motion.at(place);
    const scaled = look.range !== null, drawn = types.some((type) => look[type]);
    for (let i = 0; i < facts.particles; ++i) texels.set(x.subarray(3 * i, 3 * i + 3), 4 * i);
    if (scaled) {
      const some = look.particles || (drawn && look.color === "speed") ? null : springs.skin;
      const count = some ? some.length : facts.particles;
      for (let i = 0; i < count; ++i) {
        const p = some ? some[i] : i;
        texels[4 * p + 3] = springs.particleValue(look.color, p, x, v);
      }
    }
    if (look.solid) this.meshes.move(texels);
    this.device.bind(0, this.particles);
    gl.texSubImage2D(gl.TEXTURE_2D, 0, 0, 0, textureWidth, this.rows, gl.RGBA, gl.FLOAT, texels);
    if (scaled && look.color !== "speed")
      for (const [name, ribbons] of Object.entries(this.ribbons)) {
        if (!(name === "cords" ? drawsCords(look) : look[name])) continue;
        ribbons.springs.forEach((s, i) => { ribbons.values[i] = springs.value(look.color, s, x, v); });
        this.fill(ribbons.buffer, ribbons.values);
      }
    this.moveBalls(place, look);
    this.boxes = this.lightRows.map((rows) => this.box(rows));
  }

  moveBalls(place, look) {
    const { facts, run, motion } = this, places = [], looks = [];
    const f = place.image, later = Math.min(f + 1, run.times.length - 1);
    facts.balls.forEach((ball, i) => {
      const launched = this.time >= ball.launch * facts.timestep - 1e-9;
      const at = [0, 1, 2].map((c) => motion.balls[3 * i + c]);
      places.push(...at, launched ? ball.radius : 0);
      const step = run.times[later] - run.times[f], a = run.balls[f], b = run.balls[Math.min(later, run.balls.length - 1)];
      const speed = step > 0 ? Math.hypot(b[3 * i] - a[3 * i], b[3 * i + 1] - a[3 * i + 1], b[3 * i + 2] - a[3 * i + 2]) / step : 0;
      looks.push(...ball.color, look.color === "speed" ? speed : -1);
    });
    this.ballPlaces = places;
    this.fill(this.places, Float32Array.from(places));
    this.fill(this.turns, motion.turns);
    this.fill(this.looks, Float32Array.from(looks));
  }

  fill(buffer, data) {
    const { gl } = this.device;
    gl.bindBuffer(gl.ARRAY_BUFFER, buffer);
    gl.bufferData(gl.ARRAY_BUFFER, data, gl.DYNAMIC_DRAW);
  }

  // The box of all bodies as a light sees them.
  box(rows) {
    const low = [Infinity, Infinity, Infinity], high = [-Infinity, -Infinity, -Infinity];
    const cover = (x, y, z, radius) => rows.forEach((row, c) => {
      const at = row[0] * x + row[1] * y + row[2] * z;
      low[c] = Math.min(low[c], at - radius);
      high[c] = Math.max(high[c], at + radius);
    });
    const { x } = this.motion;
    for (let i = 0; i < x.length; i += 3) cover(x[i], x[i + 1], x[i + 2], 0);
    for (let i = 0; i < this.ballPlaces.length; i += 4)
      if (this.ballPlaces[i + 3] > 0) cover(...this.ballPlaces.slice(i, i + 4));
    if (low[0] > high[0]) cover(0, 0, 0, 1);
    const middle = times(0.5, plus(low, high)), half = times(0.5, minus(high, low));
    return { center: [...middle, 2.2 * Math.max(half[0], half[1], 0.1)], depth: 1.05 * half[2] + 0.05 };
  }

  // Uniforms of the light maps.
  lights() {
    const values = {};
    this.boxes.forEach(({ center, depth }, i) => {
      const [x, y, z] = this.lightRows[i];
      values[`lights[${i}].turn`] = [x[0], y[0], z[0], x[1], y[1], z[1], x[2], y[2], z[2]];
      values[`lights[${i}].center`] = center;
      values[`lights[${i}].depth`] = depth;
    });
    return values;
  }
}
