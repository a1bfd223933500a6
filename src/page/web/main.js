// The page in motion.
const runColors = ["rgb(242 176 92)", "rgb(110 165 240)", "rgb(120 205 140)", "rgb(224 130 200)"];
const runTints = [[242, 176, 92], [110, 165, 240], [120, 205, 140], [224, 130, 200]].map((rgb) =>
  rgb.map((c) => (c / 255 <= 0.04045 ? c / 255 / 12.92 : ((c / 255 + 0.055) / 1.055) ** 2.4)));
const axisColors = { x: "rgb(231 69 69)", y: "rgb(89 196 80)", z: "rgb(69 129 243)" };
const parts = ["solid", "particles", "terrain", "axes", ...types];

class Page {
  constructor() {
    this.recording = document.getElementById("module") ? new LiveRecording() : new Recording();
    const { facts, runs } = this.recording, { draw, color, terrain, axes } = facts.view;
    this.several = runs.length > 1;
    this.player = new Player(this.recording);
    this.camera = new Camera(facts.view);
    this.look = { ...draw, terrain, axes, color: "material" };
    if (this.offers(color)) this.look.color = color;
    this.plot = new Plot($("plot"), this.recording);
    this.stats = { firstImage: 0, images: 0 };
    this.quality = 1;
    this.fault = "";
    this.fill();
    if (this.recording.live) this.panel = new LivePanel(this);
    this.listen();
    this.ready = this.start();
  }

  async start() {
    await this.recording.readShapes();
    this.setUp();
    if (!matchMedia("(prefers-reduced-motion: reduce)").matches && !location.hash.includes("paused")) this.player.playing = true;
    await this.recording.readImages(() => this.heard());
    this.changed();
  }

  // Everything on the device; without one the page shows the rest.
  setUp() {
    try {
      this.device = new Device($("view"));
      this.painter = new Painter(this.device, this.recording.facts);
      this.bodies = this.recording.runs.map((run) => new Bodies(this.device, run));
    } catch (error) {
      this.painter = null;
      this.say(error.message);
    }
  }

  // What does not work.
  say(fault) {
    this.fault = fault;
    $("notice").textContent = fault;
  }

  fill() {
    const { facts, runs } = this.recording;
    $("title").textContent = facts.title;
    $("author").textContent = facts.author;
    $("command").textContent = facts.command;
    $("command").hidden = $("copy").hidden = facts.command === "";  // the window's pages have none
    for (const color of colors.filter((color) => this.offers(color))) $("color").append(new Option(color === "signed-strain" ? "strain, signed" : color, color));
    $("speed").append(...speeds.map((s) => new Option(s < 1 ? `1/${1 / s} ×` : `${s} ×`, s)));
    $("parameters").replaceChildren(...runs.flatMap((run, i) => {
      const table = document.createElement("table");
      table.append(...rowsOf(run.facts.parameters));
      if (!this.several) return [table];
      const head = document.createElement("h3");
      head.textContent = run.facts.name;
      head.style.setProperty("--run", runColors[i]);
      return [head, table];
    }));
    this.fillAbout();
    $("labels").replaceChildren(...(this.several ? runs : []).map((run, i) => {
      const tile = document.createElement("div"), label = document.createElement("span");
      tile.className = "tile";
      tile.style.setProperty("--run", runColors[i]);
      tile.append(label);
      return tile;
    }));
    this.showLook();
  }

  // What became of the runs.
  fillAbout() {
    const { recording, recording: { facts, runs, live } } = this;
    const about = runs.flatMap((run) => {
      const end = live ? recording.machine : run.end;
      return [
        ...(this.several ? [["run", run.facts.name]] : []),
        ["state hash", end.hash], ["precision", end.precision.replace("_", "")],
        ["last step", `${end.steps.at(-1)}`],
        ["particles", run.facts.particles.toLocaleString("en")], ["springs", run.facts.springs.toLocaleString("en")],
        ...(end.diverged ? [["", end.diverged]] : [])];
    });
    const error = runs.map((run) => `${shortNumber(500 * run.facts.quantum)} mm`);
    if (!live) about.push(["frames", `${recording.times.length}`], ["positions", `within ${[...new Set(error)].join(", ")} in x, y and z`]);
    $("about").replaceChildren(...rowsOf([...about, ["program", facts.program]]));
  }

  listen() {
    const { player, camera, look } = this, changed = () => this.changed();
    const press = (id) => $(id).click();
    watchPointers($("view"), camera, changed);
    watchKeys(keyTable({ player, camera, look, press, setColor: (color) => this.setColor(color), setLook: (what, on) => this.setLook(what, on) }), changed);
    const on = (id, event, act) => $(id).addEventListener(event, () => {
      act($(id));
      changed();
    });
    on("play", "click", () => player.toggle());
    on("back", "click", () => player.step(-1));
    on("next", "click", () => player.step(1));
    on("loop", "click", () => { player.loop = !player.loop; });
    on("speed", "change", (select) => { player.speed = Number(select.value); });
    on("scrub", "input", (range) => {
      player.playing = false;
      player.time = this.recording.times[Math.min(Number(range.value), this.recording.read - 1)];
    });
    on("color", "change", (select) => this.setColor(select.value));
    for (const what of parts) on(what, "change", (box) => this.setLook(what, box.checked));
    on("reset", "click", () => camera.reset());
    on("help", "click", () => ($("keys").open ? $("keys").close() : $("keys").showModal()));
    on("theme", "click", () => {
      const dark = getComputedStyle(document.documentElement).getPropertyValue("--is-dark").trim() === "1";
      document.documentElement.dataset.theme = dark ? "light" : "dark";
    });
    $("copy").addEventListener("click", async () => {
      await copyText(this.recording.facts.command);
      $("said").textContent = "Command copied.";
      setTimeout(() => { $("said").textContent = ""; }, 2000);
    });
    const seek = (event) => {
      if (event.type === "pointermove" && !(event.buttons & 1)) return;
      if (event.type === "pointerdown") $("plot").setPointerCapture(event.pointerId);
      player.playing = false;
      player.seek(this.plot.time(event.offsetX));
      changed();
    };
    $("plot").addEventListener("pointerdown", seek);
    $("plot").addEventListener("pointermove", seek);
    new ResizeObserver(changed).observe($("stage"));
    matchMedia("(prefers-color-scheme: dark)").addEventListener("change", changed);
    $("view").addEventListener("webglcontextlost", (event) => event.preventDefault());
    $("view").addEventListener("webglcontextrestored", () => {
      this.setUp();
      changed();
    });
  }

  // Only actuated runs have the color `actuation`.
  offers(color) {
    if (color === "actuation") return this.recording.runs.every((run) => run.facts.actuated.length > 0);
    return colors.includes(color);
  }

  setColor(color) {
    if (!this.offers(color)) return;
    this.look.color = color;
    this.showLook();
    this.changed();
  }

  setLook(what, on) {
    this.look[what] = on;
    this.showLook();
    this.changed();
  }

  showLook() {
    const { look, recording: { runs, facts } } = this;
    $("color").value = look.color;
    for (const what of parts) $(what).checked = look[what];
    const ranges = runs.map((run) => run.facts.ranges[look.color]);
    look.range = ranges[0] ? [Math.min(...ranges.map((r) => r[0])), Math.max(...ranges.map((r) => r[1]))] : null;
    const named = look.range ? [] : this.namedSprings();
    $("legend").hidden = !look.range && named.length === 0;
    $("legend-scale").hidden = !look.range;
    if (named.length > 0) this.showTypes(named);
    if (!look.range) return;
    const [title, unit, size] = quantities[look.color], [low, high] = look.range;
    $("legend-title").textContent = title;
    const mark = (x) => shortNumber(Number((x / size).toPrecision(12))) + unit;
    const signed = hasSign(look.color);
    $("legend-marks").replaceChildren(...[(low !== 0 || signed ? "≤ " : "") + mark(low), mark((low + high) / 2), "≥ " + mark(high)].map((text) => {
      const span = document.createElement("span");
      span.textContent = text;
      return span;
    }));
    const rgb = bytesOf(signed ? facts.view.signedScale : facts.view.scale), stops = [];
    for (let i = 0; i < 256; i += 15) stops.push(`rgb(${rgb.slice(3 * i, 3 * i + 3).join(" ")})`);
    $("legend-scale").style.background = `linear-gradient(to right, ${stops.join(", ")})`;
  }

  // Types of springs that are drawn in their own colors.
  namedSprings() {
    const { look, recording: { runs } } = this;
    const cords = look.color === "type" && look.solid && runs.some((run) => run.facts.bodies.some((body) => body.style === "cords"));
    return types.filter((type) => look[type] || (cords && type === "structural"));
  }

  showTypes(named) {
    $("legend-title").textContent = "springs";
    $("legend-marks").replaceChildren(...named.map((type) => {
      const span = document.createElement("span"), sample = document.createElement("i");
      const rgb = this.recording.facts.view.springColors[type].map((c) => Math.round(255 * (c <= 0.0031308 ? 12.92 * c : 1.055 * c ** (1 / 2.4) - 0.055)));
      sample.style.setProperty("--of", `rgb(${rgb.join(" ")})`);
      span.append(sample, type);
      return span;
    }));
  }

  // In a corner of the image, as in ours.
  showAxes() {
    const image = $("axes-image");
    image.style.display = this.look.axes ? "" : "none";
    if (!this.look.axes) return;
    // Numbers and letters of our own alone.
    image.innerHTML = `<circle r="3.4"/>${this.camera.axes().map(([letter, right, down]) =>
      `<line x2="${2.2 * right}" y2="${2.2 * down}" stroke="${axisColors[letter]}"/><text x="${2.8 * right}" y="${2.8 * down}">${letter}</text>`).join("")}`;
  }

  // Images were read, or something was said of them. Where none is waited for, the one that is shown stays.
  heard() {
    const waiting = this.stats.images === 0 || this.recording.read === 1 || this.player.playing;
    if (waiting || !this.recording.live) return this.changed();
    if (!this.telling) requestAnimationFrame(() => { this.telling = false; this.show(); });
    this.telling = true;
  }

  changed() {
    if (this.waiting) return;
    this.waiting = true;
    requestAnimationFrame((now) => this.update(now));
  }

  update(now) {
    this.waiting = false;
    const { player, recording } = this;
    if (recording.read === 0) return;
    const passed = this.before ? (now - this.before) / 1000 : 0;
    this.before = player.playing ? now : 0;
    if (player.playing && passed > 0) {
      player.advance(Math.min(passed, 0.25));
      this.adapt(passed);
    } else if (this.quality < 1 && !player.playing) this.quality = 1;
    this.draw();
    this.show();
    this.showAxes();
    if (player.playing) this.changed();
  }

  // Slow devices draw fewer pixels while the run plays.
  adapt(passed) {
    this.slow = (this.slow ?? 0) + (passed > 0.15 ? 3 : passed > 0.05 ? 1 : -1);
    if (this.slow < 0) this.slow = 0;
    if (this.slow < 6) return;
    this.slow = 0;
    this.quality = Math.max(0.4, 0.75 * this.quality);
  }

  draw() {
    if (!this.painter) return;
    const stage = $("stage"), ratio = Math.min(window.devicePixelRatio || 1, 2) * this.quality;
    this.drawAt(Math.max(1, Math.round(stage.clientWidth * ratio)), Math.max(1, Math.round(stage.clientHeight * ratio)));
  }

  drawAt(width, height) {
    const canvas = $("view"), place = this.player.place;
    if (canvas.width !== width || canvas.height !== height) Object.assign(canvas, { width, height });
    if (this.device.gl.isContextLost()) return;
    this.tiles(width, height).forEach((tile, i) => {
      const look = { ...this.look, tint: this.several && this.look.color === "material" ? runTints[i] : undefined };
      this.bodies[i].move(place, look);
      this.painter.draw(this.bodies[i], this.camera, look, tile);
    });
    if (this.stats.firstImage === 0) this.stats.firstImage = performance.now();
    ++this.stats.images;
  }

  // The parts of an image: two side by side, or one above the other where it is higher than wide; more in two rows.
  tiles(width, height) {
    const count = this.recording.runs.length, gap = count > 1 ? 2 : 0;
    const columns = count > 2 || (count === 2 && width >= height) ? 2 : 1, rows = Math.ceil(count / columns);
    const w = Math.floor((width - gap * (columns - 1)) / columns), h = Math.floor((height - gap * (rows - 1)) / rows);
    return this.recording.runs.map((_, i) => ({ left: (i % columns) * (w + gap),
      bottom: height - Math.floor(i / columns) * (h + gap) - h, width: w, height: h }));
  }

  show() {
    const { player, recording, plot } = this;
    if (recording.read === 0) return;
    const place = player.place, nearest = place.image + Math.round(place.share);
    $("play").textContent = player.playing ? "Pause" : "Play";
    $("play").setAttribute("aria-pressed", player.playing);
    $("loop").setAttribute("aria-pressed", player.loop);
    const known = [...$("speed").options].find((option) => Number(option.value) === player.speed);
    if (!known) $("speed").append(new Option(`${shortNumber(player.speed)} ×`, player.speed));
    $("speed").value = player.speed;
    $("time").textContent = `${player.time.toFixed(3)} s`;
    $("scrub").max = Math.max(0, recording.count - 1);
    $("scrub").value = nearest;
    $("scrub").setAttribute("aria-valuetext", `${player.time.toFixed(3)} seconds`);
    plot.draw(player.time);
    const entries = this.several
      ? recording.runs.map((run, i) => [run.facts.name, energies.reduce((sum, e) => sum + plot.at(i, place)[e], 0), runColors[i]])
      : [...energies].reverse().map((e) => [e, plot.at(0, place)[e], `var(--${e})`]);
    const work = this.several ? undefined : plot.work(place);
    if (work !== undefined) entries.push(["work of actuators", work, "var(--soft)"]);
    $("energies").replaceChildren(...entries.map(([name, joules, color]) => {
      const item = document.createElement("li");
      item.style.setProperty("--run", color);
      item.textContent = `${name} ${shortNumber(joules)} J`;
      return item;
    }));
    this.panel?.show();
    const stage = $("stage"), w = stage.clientWidth, h = stage.clientHeight, tiles = this.tiles(w, h);
    [...$("labels").children].forEach((tile, i) => {
      const run = recording.runs[i], { left, bottom, width, height } = tiles[i];
      Object.assign(tile.style, { left: `${left}px`, top: `${h - bottom - height}px`, width: `${width}px`, height: `${height}px` });
      const ended = run.end.diverged && nearest === recording.times.length - 1 || run.end.diverged && run.times[nearest] >= run.times.at(-1);
      const time = run.times[place.image] + place.share * (run.times[Math.min(place.image + 1, run.times.length - 1)] - run.times[place.image]);
      tile.firstChild.textContent = `${run.facts.name} · ${time.toFixed(3)} s${ended ? " · diverged" : ""}`;
    });
  }

  // The image at this moment as the URL of a PNG, of that size; for tests, and for whoever wants one.
  image(width, height) {
    this.drawAt(width, height);
    const url = $("view").toDataURL("image/png");
    this.changed();
    return url;
  }
}

window.addEventListener("error", (event) => {
  if (window.aspic) aspic.say(event.message);
  else $("notice").textContent = event.message;
});
window.aspic = new Page();
