// What a reader changes of a simulation, and what is said of its bits.
class LivePanel {
  constructor(page) {
    Object.assign(this, { page, recording: page.recording, shown: new Map(), pending: new Map() });
    $("live").hidden = false;
    document.body.classList.add("live");
    $("restart").addEventListener("click", () => this.from(() => this.recording.restart()));
    $("restore").addEventListener("click", () => this.from(() => this.recording.create()));
    $("controls").replaceChildren(...this.recording.live.controls.map((group) => this.group(group)));
  }

  group({ title, open, rows }) {
    const details = document.createElement("details"), summary = document.createElement("summary");
    details.open = open;
    summary.textContent = title;
    details.append(summary, ...rows.flatMap((row) => this.fields(row)));
    return details;
  }

  // A row of the parameter table, as one field, or one for each component.
  fields(row) {
    if (row.words) return [this.chooser(row)];
    if (typeof row.value === "boolean") return [this.box(row)];
    if (!Array.isArray(row.value)) return [this.number(row, row.label, row.value, (x) => x, (value) => value)];
    return row.value.map((x, i) => this.number(row, `${row.label} ${"xyz"[i]}`, x,
      (own) => this.recording.values.get(row.path).map((old, j) => (j === i ? own : old)), (value) => value[i]));
  }

  labeled(row, text, ...parts) {
    const label = document.createElement("label"), name = document.createElement("span");
    label.className = "control";
    label.title = row.meaning;
    name.textContent = text;
    if (row.unit) {
      const unit = document.createElement("i");
      unit.textContent = row.unit;
      name.append(" ", unit);
    }
    label.append(name, ...parts);
    return label;
  }

  chooser(row) {
    const select = document.createElement("select");
    select.append(...row.words.map((word) => new Option(word)));
    select.addEventListener("change", () => this.set(row.path, select.value));
    this.shown.set(row.path, [() => { select.value = this.recording.values.get(row.path); }]);
    return this.labeled(row, row.label, select);
  }

  box(row) {
    const box = Object.assign(document.createElement("input"), { type: "checkbox" });
    box.addEventListener("change", () => this.set(row.path, box.checked));
    this.shown.set(row.path, [() => { box.checked = this.recording.values.get(row.path); }]);
    return this.labeled(row, row.label, box);
  }

  // A slider and a field; `toValue` makes the row's value of the number, `ofValue` the number of the row's value.
  number(row, text, start, toValue, ofValue) {
    const slider = Object.assign(document.createElement("input"), { type: "range", min: 0, max: 1000, ariaLabel: `${text}, slider` });
    const field = Object.assign(document.createElement("input"), { type: "text", inputMode: "decimal", ariaLabel: text });
    const span = spanOf(row, start);
    slider.addEventListener("input", () => {
      const x = Number(span.value(slider.value / 1000).toPrecision(3));
      this.set(row.path, toValue(row.integer ? Math.round(x) : clamp(x, row.min, row.max)));
    });
    field.addEventListener("change", () => {
      const x = Number(field.value.replace(",", "."));
      const legal = field.value.trim() !== "" && x >= row.min && x <= row.max && !(row.above && x === row.min) && (!row.integer || Number.isInteger(x));
      this.recording.refused = legal ? "" : `${text}: ${row.allowed}.`;
      if (legal) this.set(row.path, toValue(x));
      else this.page.changed();
    });
    const show = () => {
      const x = ofValue(this.recording.values.get(row.path));
      slider.value = 1000 * span.place(x);
      if (document.activeElement !== field) field.value = shownNumber(x);
    };
    this.shown.set(row.path, [...(this.shown.get(row.path) ?? []), show]);
    return this.labeled(row, text, slider, field);
  }

  // Slides are many; they take effect once an image.
  set(path, value) {
    if (this.pending.size === 0) requestAnimationFrame(() => this.apply());
    this.pending.set(path, value);
    this.recording.values.set(path, value);
    for (const show of this.shown.get(path)) show();
  }

  // At the moment that is shown; at the end of a run from its start.
  apply() {
    const { recording, page: { player } } = this, changes = [...this.pending];
    if (recording.read === 0) return void requestAnimationFrame(() => this.apply());  // it has just begun again
    this.pending.clear();
    const atEnd = recording.done && player.time >= recording.end - 1e-9;
    const image = atEnd ? 0 : player.place.image;
    recording.change(changes, image);
    player.time = recording.times[image];
    if (atEnd) player.playing = true;
    this.page.changed();
  }

  from(act) {
    act();
    this.pending.clear();
    const { player } = this.page;
    player.time = this.recording.start;
    player.playing = true;
    this.page.changed();
  }

  // Sentences about the run.
  show() {
    const { recording } = this, { same, other } = recording.bits;
    for (const [path, all] of this.shown) if (!this.pending.has(path)) for (const show of all) show();
    const pace = recording.rate > 0 ? ` ${Math.round(recording.rate).toLocaleString("en")} steps a second, ${shortNumber(Number((recording.rate * recording.timestep).toPrecision(2)))} × real time.` : "";
    $("bits").textContent = this.said(same, other) + (recording.done ? pace : ` Computing: ${recording.times.at(-1)?.toFixed(2) ?? 0} s of ${recording.end.toFixed(2)} s.${pace}`);
    $("refused").textContent = recording.refused;
    const ended = recording.diverged && this.page.player.time >= recording.end - 1e-9;
    $("notice").textContent = recording.error || (ended ? `The simulation ${recording.diverged}.` : this.page.fault);
    const there = recording.machine, here = recording.run.end, last = there.steps.at(-1);
    const hash = here.steps.includes(last) && !recording.changed ? recording.run.hashes[here.steps.indexOf(last)] : "";
    $("hashes").replaceChildren(...rowsOf([
      ["original machine", there.hash], ["this browser", hash === "" ? (recording.changed ? "another run" : "…") : hash],
      ["step", `${last}`]]));
    $("verdict").className = other === null && (hash === "" || hash === there.hash) ? "" : "differs";
    $("verdict").textContent = hash === "" ? "" : hash === there.hash ? "the same" : "different";
  }

  said(same, other) {
    const { recording } = this, count = (n) => `${n} frame${n === 1 ? "" : "s"}`;
    const why = recording.live.sheets ? " Browsers keep denormal numbers, which Aspic sets to zero. They occur in nets and cloth." : "";
    if (other !== null) return `The bits differ from those of the original machine from step ${other} on.${why}`;
    if (!recording.changed) return `The bits equal those of the original machine in ${same === recording.machine.steps.length ? "all" : "the first"} ${count(same)}.`;
    return `You changed values at ${recording.times[Math.min(recording.changedFrom, recording.times.length - 1)].toFixed(3)} s. Until then the bits equal those of the original machine.`;
  }
}

// Where numbers lie on a slider, and which ones it has: all that are legal, where those are few; else about the scene's own.
function spanOf(row, start) {
  const linear = (low, high) => ({ value: (s) => low + s * (high - low), place: (x) => clamp((x - low) / (high - low), 0, 1) });
  if (row.channel !== undefined || (row.max - row.min <= 1 && !row.above)) return linear(row.min, row.max);
  if (row.min < 0) return linear(Math.max(row.min, -2 * Math.max(10, Math.abs(start))), Math.min(row.max, 2 * Math.max(10, Math.abs(start))));
  if (row.unit === "" || start === 0) return linear(row.min, Math.min(row.max, Math.max(row.integer ? 10 : 1, 3 * start, row.unit === "" ? 0 : 100)));
  const low = Math.log(Math.max(start / 100, row.min)), high = Math.log(Math.min(start * 100, row.max));
  return { value: (s) => Math.exp(low + s * (high - low)), place: (x) => (x > 0 ? clamp((Math.log(x) - low) / (high - low), 0, 1) : 0) };
}

const shownNumber = (x) => String(Number(x.toPrecision(6)));
