// The clock of the page: simulated time, at a speed.
const speeds = [1 / 16, 1 / 8, 1 / 4, 1 / 2, 1, 2, 4];

class Player {
  constructor(recording) {
    Object.assign(this, { recording, time: recording.start, playing: false, loop: false, speed: recording.facts.speed });
  }

  get last() { return this.recording.times[Math.max(this.recording.read - 1, 0)]; }
  get place() { return this.recording.place(this.time); }
  get complete() { return this.recording.complete; }

  toggle() {
    if (!this.playing && this.time >= this.recording.end) this.time = this.recording.start;
    this.playing = !this.playing;
  }

  seek(time) { this.time = clamp(time, this.recording.start, this.last); }

  // By images, from the one that is shown or was passed last.
  step(images) {
    this.playing = false;
    const { image, share } = this.place, from = images < 0 && share > 0 ? image + 1 : image;
    this.time = this.recording.times[clamp(from + images, 0, this.recording.read - 1)];
  }

  // Goes on by so many seconds of the reader's.
  advance(seconds) {
    const { start, end } = this.recording;
    this.time += seconds * this.speed;
    if (this.time < this.last) return;
    if (!this.complete) this.time = this.last;  // waits for more to be read
    else if (this.loop && end > start) this.time = start + ((this.time - start) % (end - start));
    else {
      this.time = end;
      this.playing = false;
    }
  }

  faster(by) {
    const nearest = speeds.reduce((best, s, i) => (Math.abs(Math.log(s / this.speed)) < Math.abs(Math.log(speeds[best] / this.speed)) ? i : best), 0);
    this.speed = speeds[clamp(nearest + by, 0, speeds.length - 1)];
  }
}
