// Springs, and the numbers that colors show (docs/images.md).
const drawnSprings = 1000000;  // of larger runs those of the skin are drawn

// Every particle of a run's skins.
function skinOf(facts) {
  const skin = new Uint8Array(facts.particles);
  for (const { quads, mesh } of facts.bodies)
    for (const corner of mesh ? mesh.corners : quads) for (const particle of corner) skin[particle] = 1;
  return skin;
}

// Calls each(a, b, class) for every spring of a run.
function eachSpring(run, each) {
  const { bodies, directions } = run.facts, { a, b, classes } = run.listed;
  for (let s = 0; s < a.length; ++s) each(a[s], b[s], classes[s]);
  for (const body of bodies) {
    if (!body.lattice) continue;
    const [ni, nj, nk] = body.lattice, ups = directions.slice(directions.length / 2);
    for (let i = 0; i < ni; ++i)
      for (let j = 0; j < nj; ++j)
        for (let k = 0; k < nk; ++k)
          for (const [di, dj, dk, own] of ups) {
            const x = i + di, y = j + dj, z = k + dk;
            if (x >= ni || y < 0 || y >= nj || z < 0 || z >= nk) continue;
            each(body.first + (i * nj + j) * nk + k, body.first + (x * nj + y) * nk + z, body.firstClass + own);
          }
  }
}

class Springs {
  constructor(run) {
    const skin = skinOf(run.facts), { particles, springs, bodies } = run.facts;
    this.run = run;
    this.large = springs > drawnSprings;
    const solid = bodies.some((body) => body.groups.length > 0 || body.mesh);
    const a = [], b = [], classes = [], counts = new Uint32Array(particles + 1);
    eachSpring(run, (p, q, own) => {
      if (this.large && !(solid ? skin[p] || skin[q] : true)) return;
      a.push(p);
      b.push(q);
      classes.push(own);
      ++counts[p + 1];
      ++counts[q + 1];
    });
    this.a = Uint32Array.from(a);
    this.b = Uint32Array.from(b);
    this.classes = Uint16Array.from(classes);
    for (let i = 0; i < particles; ++i) counts[i + 1] += counts[i];
    this.starts = counts;
    this.incident = new Uint32Array(2 * a.length);
    const next = counts.slice();
    for (let s = 0; s < a.length; ++s) {
      this.incident[next[a[s]]++] = s;
      this.incident[next[b[s]]++] = s;
    }
    this.skin = Uint32Array.from(skin.keys()).filter((p) => skin[p] || (!solid && !this.large));
  }

  // Springs of a type that are drawn: of large runs those within the skin.
  ofType(type) {
    const { classes } = this.run.facts;
    const own = Array.from(this.classes.keys()).filter((s) => classes[this.classes[s]].type === type);
    return Uint32Array.from(own);
  }

  // Structural springs of nets: their cords.
  cords() {
    const nets = this.run.facts.bodies.filter((body) => body.style === "cords");
    const ofNet = (p) => nets.some(({ first, count }) => p >= first && p < first + count);
    return this.ofType("structural").filter((s) => ofNet(this.a[s]));
  }

  // What a color shows of one spring between x and moving at v (all particles').
  value(color, s, x, v) {
    const own = this.run.facts.classes[this.classes[s]], a = 3 * this.a[s], b = 3 * this.b[s];
    const ex = x[a] - x[b], ey = x[a + 1] - x[b + 1], ez = x[a + 2] - x[b + 2];
    const change = this.run.change[this.classes[s]], r = own.r * (1 + change);
    const L = Math.sqrt(ex * ex + ey * ey + ez * ez), stretch = L - r;
    if (color === "actuation") return change;
    if (color === "strain") return Math.abs(stretch) / r;
    if (color === "signed-strain") return stretch / r;
    if (own.cord && stretch < 0) return 0;
    if (color === "energy") return 0.5 * own.k * stretch * stretch;
    if (L === 0) return 0;
    const rate = ((v[a] - v[b]) * ex + (v[a + 1] - v[b + 1]) * ey + (v[a + 2] - v[b + 2]) * ez) / L;
    this.pull = (own.k * stretch + own.c * rate) / L;
    return Math.abs(own.k * stretch + own.c * rate);
  }

  // The same of a particle.
  particleValue(color, p, x, v) {
    if (color === "speed") return Math.hypot(v[3 * p], v[3 * p + 1], v[3 * p + 2]);
    const from = this.starts[p], to = this.starts[p + 1], force = [0, 0, 0];
    let sum = 0;
    for (let i = from; i < to; ++i) {
      const s = this.incident[i];
      this.pull = 0;
      const value = this.value(color, s, x, v);
      sum += value;
      if (color !== "force" || value === 0) continue;
      const other = this.a[s] === p ? this.b[s] : this.a[s];
      for (let c = 0; c < 3; ++c) force[c] += this.pull * (x[3 * other + c] - x[3 * p + c]);
    }
    if (color === "force") return Math.hypot(...force);
    if (color === "energy") return 0.5 * sum;
    return to > from ? sum / (to - from) : 0;
  }
}

// Positions and velocities of a run between its images: cubic, with the mean speed of the two intervals at each.
class Motion {
  constructor(run) {
    this.run = run;
    this.x = new Float32Array(3 * run.facts.particles);
    this.v = new Float32Array(3 * run.facts.particles);
    this.balls = new Float32Array(3 * run.facts.balls.length);
    this.turns = new Float32Array(4 * run.facts.balls.length);
  }

  at({ image, share }) {
    const { run } = this, last = run.positions.length - 1;
    const f = [image - 1, image, image + 1, image + 2].map((i) => clamp(i, 0, last));
    // A run that stood still, diverged, has no speed.
    const rate = (i, j) => (run.times[j] > run.times[i] ? 1 / (run.times[j] - run.times[i]) : 0);
    this.mix(run.positions, this.x, f, share, rate, this.v);
    this.mix(run.balls, this.balls, f, share, rate);
    if (run.changes.length > 0) {
      const from = run.changes[f[1]], to = run.changes[f[2]];
      run.facts.actuated.forEach((own, i) => { run.change[own] = from[i] + share * (to[i] - from[i]); });
    }
    const q = run.turns[f[1]], r = run.turns[f[2]];
    for (let i = 0; i < q.length; ++i) this.turns[i] = q[i] + share * (r[i] - q[i]);
  }

  mix(images, x, [a, b, c, d], s, rate, v) {
    const xa = images[a], xb = images[b], xc = images[c], xd = images[d];
    const before = rate(a, c), after = rate(b, d), dt = this.run.times[c] - this.run.times[b];
    if (s === 0) x.set(xb);
    const h1 = s * s * (3 - 2 * s), g0 = dt * s * (1 - s) ** 2, g1 = dt * s * s * (s - 1);
    for (let i = 0; i < x.length; ++i) {
      const v0 = (xc[i] - xa[i]) * before, v1 = (xd[i] - xb[i]) * after;
      if (s > 0) x[i] = xb[i] + h1 * (xc[i] - xb[i]) + g0 * v0 + g1 * v1;
      if (v) v[i] = v0 + s * (v1 - v0);
    }
  }
}
