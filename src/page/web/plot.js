// Energies over time, with the moment marked: of one run as areas, one above the other, of several the sums as lines.
const energies = ["gravitational", "elastic", "kinetic"];  // from the bottom up

class Plot {
  constructor(canvas, recording) {
    Object.assign(this, { canvas, recording, version: -1 });
  }

  // The energies of all images, where there are others than before.
  count() {
    const { recording } = this;
    if (this.version === recording.version) return;
    this.version = recording.version;
    this.rows = recording.runs.map(({ end }) => {
      const lowest = Math.min(...end.gravitational);
      return { kinetic: end.kinetic, elastic: end.elastic, gravitational: end.gravitational.map((e) => e - lowest) };
    });
    this.sums = this.rows.map((row) => row.kinetic.map((_, f) => energies.reduce((sum, e) => sum + row[e][f], 0)));
    // What explodes does not press the others flat: its line leaves at the top.
    const ends = this.sums.map((sums) => 2 * sums[0]);
    this.most = Math.max(...this.sums.map((sums, i) => (this.sums.length > 1 ? Math.min(Math.max(...sums), ends[i]) : Math.max(...sums))), 1e-12);
  }

  // Where a time is [CSS pixels], and which time is at a place.
  x(time) {
    const { start, end } = this.recording;
    return end > start ? ((time - start) / (end - start)) * this.width : 0;
  }
  time(x) {
    const { start, end } = this.recording;
    return start + (clamp(x, 0, this.width) / this.width) * (end - start);
  }
  y(energy) { return this.height - 1 - (energy / this.most) * (this.height - 6); }

  // Energies of a run at a time, between its images.
  at(run, { image, share }) {
    this.count();
    const next = Math.min(image + 1, this.recording.times.length - 1), row = this.rows[run];
    return Object.fromEntries(energies.map((e) => [e, row[e][image] + share * (row[e][next] - row[e][image])]));
  }

  // The work of one run's actuators so far, between its images; undefined without any.
  work({ image, share }) {
    const work = this.recording.runs[0].end.work ?? [], next = Math.min(image + 1, work.length - 1);
    return work.length > 0 ? work[image] + share * (work[next] - work[image]) : undefined;
  }

  draw(time) {
    this.count();
    const { canvas } = this, ratio = window.devicePixelRatio || 1, style = getComputedStyle(canvas);
    this.width = canvas.clientWidth;
    this.height = canvas.clientHeight;
    const [w, h] = [Math.round(ratio * this.width), Math.round(ratio * this.height)];
    if (canvas.width !== w || canvas.height !== h) Object.assign(canvas, { width: w, height: h });
    const c = canvas.getContext("2d");
    c.setTransform(ratio, 0, 0, ratio, 0, 0);
    c.clearRect(0, 0, this.width, this.height);
    if (this.rows.length === 1) this.drawAreas(c, style);
    else this.drawLines(c);
    const x = clamp(this.x(time), 0.75, this.width - 0.75);
    c.strokeStyle = style.color;
    c.lineWidth = 1.5;
    c.beginPath();
    c.moveTo(x, 0);
    c.lineTo(x, this.height);
    c.stroke();
  }

  path(c, heights) {
    c.beginPath();
    heights.forEach((e, f) => c.lineTo(this.x(this.recording.times[f]), this.y(e)));
  }

  drawAreas(c, style) {
    let below = this.rows[0].kinetic.map(() => 0);
    for (const e of energies) {
      const above = below.map((b, f) => b + this.rows[0][e][f]);
      this.path(c, above);
      for (let f = below.length - 1; f >= 0; --f) c.lineTo(this.x(this.recording.times[f]), this.y(below[f]));
      c.fillStyle = style.getPropertyValue(`--${e}`);
      c.fill();
      below = above;
    }
  }

  drawLines(c) {
    this.sums.forEach((sums, i) => {
      this.path(c, sums);
      c.strokeStyle = runColors[i];
      c.lineWidth = 2;
      c.stroke();
    });
  }
}
