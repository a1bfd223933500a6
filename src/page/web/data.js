// What the page holds: facts of the run as JSON, and images as base64 of a raw deflate stream.
const jsonOf = (id) => JSON.parse(document.getElementById(id).textContent);

function bytesOf(base64) {
  if (Uint8Array.fromBase64) return Uint8Array.fromBase64(base64);
  const text = atob(base64), bytes = new Uint8Array(text.length);
  for (let i = 0; i < text.length; ++i) bytes[i] = text.charCodeAt(i);
  return bytes;
}

// Reads the stream as it is inflated, so that the first image is there before the last.
class Inflated {
  constructor(bytes) {
    const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream("deflate-raw"));
    this.reader = stream.getReader();
    this.chunk = new Uint8Array(0);
    this.at = 0;
  }

  async take(count) {
    const bytes = new Uint8Array(count);
    for (let have = 0; have < count;) {
      if (this.at === this.chunk.length) {
        const next = await this.reader.read();
        if (next.done) throw new Error("This page is incomplete: its data end early. Copy or download it again.");
        this.chunk = next.value;
        this.at = 0;
        continue;
      }
      const part = this.chunk.subarray(this.at, this.at + count - have);
      bytes.set(part, have);
      this.at += part.length;
      have += part.length;
    }
    return bytes;
  }

  // Whole numbers that were stored by planes of bytes, each as its difference from the one before.
  async numbers(count) {
    const planes = (await this.take(1))[0], numbers = new Int32Array(count);
    if (planes === 0) return numbers;
    const bytes = await this.take(planes * count);
    for (let p = 0; p < planes; ++p)
      for (let i = 0, from = p * count; i < count; ++i) numbers[i] |= bytes[from + i] << (8 * p);
    for (let i = 0, before = 0; i < count; ++i) {
      const folded = numbers[i];
      before = numbers[i] = (before + ((folded >>> 1) ^ -(folded & 1))) | 0;
    }
    return numbers;
  }
}

// Vectors from image to image: each image says how far they are from where the two before would take them.
class Track {
  constructor(count, quantum) {
    this.count = count;
    this.quantum = quantum;
    this.last = new Int32Array(3 * count);
    this.before = new Int32Array(3 * count);
    this.first = true;
  }

  async next(data) {
    const n = this.count, { last, before, quantum } = this, vectors = new Float32Array(3 * n);
    const residual = await data.numbers(3 * n);
    for (let c = 0; c < 3; ++c) {
      for (let i = 0, at = c * n; i < n; ++i, ++at) {
        const now = (2 * last[at] - before[at] + residual[at]) | 0;
        before[at] = this.first ? now : last[at];
        last[at] = now;
        vectors[3 * i + c] = now * quantum;
      }
    }
    this.first = false;
    return vectors;
  }
}

// One run: its facts, its shapes, and its images as far as they are inflated.
class Run {
  constructor(facts, end) {
    Object.assign(this, { facts, end, positions: [], balls: [], turns: [], changes: [], change: new Float32Array(facts.classes.length) });
    this.times = end.steps.map((step) => step * facts.timestep);
    this.tracks = [new Track(facts.particles, facts.quantum),
      new Track(facts.balls.length, facts.ballQuantum), new Track(facts.balls.length, facts.spinQuantum),
      new Track(Math.ceil(facts.actuated.length / 3), facts.changeQuantum)];
  }

  async readShapes(data) {
    const { listed, bodies, terrain } = this.facts;
    const a = await data.numbers(listed), reach = await data.numbers(listed);
    this.listed = { a, b: reach.map((r, i) => a[i] + r), classes: await data.numbers(listed) };
    for (const body of bodies) {
      body.quads = [];
      if (body.mesh) await this.readMesh(data, body.mesh);
      else body.quads = await this.readLists(data, body.groups.reduce((sum, quads) => sum + quads, 0), 4);
    }
    for (const t of terrain) {
      if (!t.surface) continue;
      t.surface.numbers = await data.numbers(3 * (t.surface.rings + 1) * (t.surface.sectors + 1));
      if (t.flat) t.surface.offs = await data.numbers(t.surface.side ** 2);
    }
  }

  // Lists of `places` indices each: all first ones, then the others as differences from those.
  async readLists(data, count, places) {
    const first = await data.numbers(count), all = [first];
    while (all.length < places) all.push((await data.numbers(count)).map((r, i) => first[i] + r));
    return all;
  }

  // Of each vertex the particles at the corners of its cell and its place in it, and triangles.
  async readMesh(data, mesh) {
    mesh.corners = await this.readLists(data, mesh.vertices, 8);
    mesh.at = [];
    for (let axis = 0; axis < 3; ++axis) mesh.at.push(Float32Array.from(await data.numbers(mesh.vertices), (steps) => steps * mesh.quantum));
    mesh.corner = await this.readLists(data, mesh.triangles, 3);
  }

  async readImage(data) {
    this.positions.push(await this.tracks[0].next(data));
    this.balls.push(await this.tracks[1].next(data));
    this.turn(await this.tracks[2].next(data));
    if (this.facts.actuated.length > 0) this.changes.push(await this.tracks[3].next(data));
  }

  // Each ball turns from image to image by its angular velocity in the later one; none has turned in the first.
  turn(spins) {
    const image = this.turns.length, before = this.turns[image - 1];
    const turns = new Float32Array(4 * this.facts.balls.length);
    for (let i = 0; i < this.facts.balls.length; ++i) {
      const spin = spins.subarray(3 * i, 3 * i + 3), speed = length(spin);
      const q = before ? Array.from(before.subarray(4 * i, 4 * i + 4)) : [0, 0, 0, 1];
      const seconds = before ? this.times[image] - this.times[image - 1] : 0;
      turns.set(speed * seconds > 0 ? turned(q, times(1 / speed, spin), speed * seconds) : q, 4 * i);
    }
    this.turns.push(turns);
  }
}

class Recording {
  constructor() {
    this.facts = jsonOf("facts");
    const ends = jsonOf("ends"), element = document.getElementById("data");
    this.data = new Inflated(bytesOf(element.textContent));
    element.remove();
    this.runs = this.facts.runs.map((facts, i) => this.makeRun(facts, ends[i]));
    const images = ends[0].steps.length;
    this.times = Array.from({ length: images }, (_, f) => Math.max(...this.runs.map((run) => run.times[f])));
  }

  makeRun(facts, end) { return new Run(facts, end); }

  // Images that are read and that there will be; changes of `version` are changes of what the images are.
  get read() { return this.runs[this.runs.length - 1].positions.length; }
  get count() { return this.times.length; }
  get complete() { return this.read === this.count; }
  get version() { return 0; }
  get start() { return this.times[0]; }
  get end() { return this.times[this.times.length - 1]; }

  async readShapes() {
    for (const run of this.runs) await run.readShapes(this.data);
  }

  // Calls `did` after the first image and now and then, and gives the browser time between.
  async readImages(did) {
    let shown = performance.now();
    for (let f = 0; f < this.times.length; ++f) {
      for (const run of this.runs) await run.readImage(this.data);
      if (f > 0 && performance.now() - shown < 30) continue;
      did();
      await new Promise((go) => setTimeout(go));
      shown = performance.now();
    }
    did();
  }

  // The image before a time, and how far the time is on the way to the next one, 0…1.
  place(time) {
    const last = this.read - 1;
    let low = 0, high = last;
    while (low < high) {
      const middle = (low + high + 1) >> 1;
      if (this.times[middle] <= time + 1e-9) low = middle;
      else high = middle - 1;
    }
    if (low === last) return { image: last, share: 0 };
    const share = (time - this.times[low]) / (this.times[low + 1] - this.times[low]);
    return { image: low, share: share < 1e-6 ? 0 : share };
  }
}
