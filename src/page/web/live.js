// A page that simulates: its images come from a worker, as the recorded ones come from the file, and what a reader changes takes
// effect at the moment that is shown.
class LiveRun extends Run {
  constructor(facts, end) {
    super(facts, { hash: "", precision: end.precision, steps: [], kinetic: [], elastic: [], gravitational: [], work: [] });
    Object.assign(this, { states: [], hashes: [], before: 0 });  // all numbers of each image, their hash; work before the last change
  }

  take({ step, hash, numbers, kinetic, elastic, gravitational, work, changes }) {
    const { end, facts } = this, particles = facts.particles, balls = facts.balls.length, ballsFrom = 6 * particles;
    end.hash = hash;
    end.steps.push(step);
    this.hashes.push(hash);
    for (const [list, value] of [[end.kinetic, kinetic], [end.elastic, elastic], [end.gravitational, gravitational]]) list.push(value);
    if (work !== undefined) end.work.push(this.before + work);
    this.times.push(step * facts.timestep);
    this.states.push(numbers);
    this.positions.push(numbers.subarray(0, 3 * particles));
    this.balls.push(numbers.subarray(ballsFrom, ballsFrom + 3 * balls));
    this.turn(numbers.subarray(ballsFrom + 6 * balls));
    if (facts.actuated.length > 0) this.changes.push(changes);
  }

  // Forgets all images but so many.
  keep(count) {
    const { end } = this;
    delete end.diverged;
    this.before = end.work[count - 1] ?? 0;
    for (const list of [end.steps, end.kinetic, end.elastic, end.gravitational, end.work, this.times, this.states, this.hashes, this.positions, this.balls, this.turns, this.changes])
      list.length = Math.min(list.length, count);
  }
}

class LiveRecording extends Recording {
  constructor() {
    super();
    this.live = this.facts.live;
    [this.run] = this.runs;
    this.times = this.run.times;
    this.rows = this.live.controls.flatMap((group) => group.rows);
    this.values = new Map(this.rows.map((row) => [row.path, row.value]));
    this.inputs = this.rows.filter((row) => row.channel !== undefined);
    this.timestep = this.sceneTimestep = this.facts.runs[0].timestep;
    this.first = this.machine.steps[0] * this.timestep;
    this.last = (this.live.lastStep ?? this.machine.steps.at(-1)) * this.timestep;
    this.hashes = new Map(this.machine.steps.map((step, i) => [step, this.machine.hashes[i]]));
    Object.assign(this, { generation: 0, heard: 0, left: 0, done: false, error: "", refused: "", rate: 0, changedFrom: Infinity });
  }

  makeRun(facts, end) {
    this.machine = end;  // what the machine that made the page came to
    return new LiveRun(facts, end);
  }

  get count() { return this.times.length + this.left; }
  get complete() { return this.done; }
  get version() { return this.heard; }
  get start() { return this.times[0] ?? this.first; }
  get end() { return this.done ? this.times.at(-1) : this.last; }
  get diverged() { return this.run.end.diverged; }
  get changed() { return this.changedFrom < Infinity; }

  // How many images have the bits that the machine computed, and the step of the first that has others; images before a change count.
  get bits() {
    let same = 0;
    for (let f = 0; f < Math.min(this.times.length, this.changedFrom); ++f) {
      const step = this.run.end.steps[f], there = this.hashes.get(step);
      if (there && there !== this.run.hashes[f]) return { same, other: step };
      if (there) ++same;
    }
    return { same, other: null };
  }

  async readShapes() {
    await super.readShapes();
    const { particles, balls } = this.run.facts;
    if (this.machine.starts) {
      const bytes = await this.data.take(4 * (6 * particles + 9 * balls.length));
      this.startState = { step: this.machine.steps[0], numbers: new Float32Array(bytes.buffer) };
    }
  }

  // Steps of the images after a step: those that aspic run would choose (io/frame_schedule.h).
  plan(after) {
    const { timestep, facts: { fps, speed } } = this, first = Math.round(this.first / timestep), last = Math.round(this.last / timestep);
    const perImage = speed / fps / timestep, steps = [];
    for (let f = 0, step = first; step < last; ++f) {
      step = Math.min(first + Math.round(f * perImage), last);
      if (step > after && step !== steps.at(-1)) steps.push(step);
    }
    if (after < last && steps.at(-1) !== last) steps.push(last);
    return steps;
  }

  // Calls `did` with each image, and where there is something else to say.
  readImages(did) {
    const text = document.getElementById("worker").textContent, module = document.getElementById("module");
    const url = URL.createObjectURL(new Blob([text], { type: "text/javascript" }));
    this.worker = new Worker(url);
    URL.revokeObjectURL(url);
    return new Promise((go) => {
      this.did = () => {
        ++this.heard;
        did();
        if (this.done || this.error) go();
      };
      this.worker.onerror = (event) => this.hear({ generation: this.generation, failed: event.message });
      this.worker.onmessage = ({ data }) => this.hear(data);
      this.worker.postMessage({ command: "load", deflated: bytesOf(module.textContent) });
      this.create();
    });
  }

  hear(message) {
    const { run } = this;
    if (message.generation !== undefined && message.generation !== this.generation && !message.failed) return;
    if (message.failed) this.error ||= `The simulation ended: ${message.failed}`;
    if (message.refused) return this.takeBack(message.refused);
    if (message.facts) {
      message.facts.classes.forEach(([k, c, r], i) => Object.assign(run.facts.classes[i], { k, c, r }));
      message.facts.radii.forEach((radius, i) => { run.facts.balls[i].radius = radius; });
    }
    if (message.numbers && message.step !== run.end.steps.at(-1)) {
      run.take(message);
      this.left = Math.max(0, this.left - 1);
      if (message.spent > 0) this.rate = (1000 * message.steps) / message.spent;
    }
    if (message.diverged) run.end.diverged = message.diverged;
    if (message.done || message.diverged) this.done = true;
    if (this.done) this.left = 0;
    this.did();
  }

  send(message, after) {
    const plan = this.plan(after);
    this.left = plan.length;
    Object.assign(this, { done: false, error: "", refused: "" });
    this.worker.postMessage({ ...message, plan, generation: ++this.generation });
    if (plan.length === 0) this.done = true;
  }

  // From the start, with the values of the scene.
  create() {
    for (const row of this.rows) this.values.set(row.path, row.value);
    this.applied = new Map(this.values);
    this.timestep = this.run.facts.timestep = this.sceneTimestep;
    this.run.keep(0);
    this.changedFrom = Infinity;
    this.send({ command: "create", text: this.live.scene, state: this.startState }, -1);
  }

  // From an image on with other values: [path, value] each.
  change(changes, image) {
    const { run } = this, at = Math.min(image, run.states.length - 1), time = run.times[at];
    if (at < 0) return;
    this.before = [new Map(this.applied), this.timestep];
    for (const [path, value] of changes) {
      this.values.set(path, value);
      this.applied.set(path, value);
    }
    const last = changes.find(([path]) => path === "simulation.timestep");
    if (last) this.timestep = run.facts.timestep = last[1];
    const step = Math.round(time / this.timestep);
    run.keep(at + 1);
    run.end.steps[at] = step;
    run.times[at] = step * this.timestep;
    if (changes.length > 0) this.changedFrom = Math.min(this.changedFrom, at);
    const ofScene = changes.filter(([path]) => !this.inputs.some((row) => row.path === path));
    const text = ofScene.map(([path, value]) => `${path}=${valueText(value)}\n`).join("");
    const inputs = this.inputs.map((row) => this.applied.get(row.path));
    this.send({ command: "change", text, inputs, state: { step, numbers: run.states[at] } }, step);
  }

  // What the module refused of the last change, which a field let pass.
  takeBack(why) {
    [this.applied, this.timestep] = this.before;
    this.run.facts.timestep = this.timestep;
    this.values = new Map(this.applied);
    this.change([], this.run.states.length - 1);
    this.refused = why;
    this.did();
  }

  // From the start, with the values that there are.
  restart() {
    this.changedFrom = this.changed ? 0 : Infinity;
    this.change([], 0);
  }
}

// As TOML writes it.
function valueText(value) {
  if (Array.isArray(value)) return `[${value.map(valueText).join(", ")}]`;
  return typeof value === "string" ? `"${value}"` : String(value);
}
