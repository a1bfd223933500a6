// A camera on a sphere around its target.
const farthest = 40;  // an orthographic camera sees as many times the target's distance before and behind it

class Camera {
  constructor(view) {
    this.view = view;
    this.reset();
  }

  reset() {
    const { position, target, fov, orthographic } = this.view, off = minus(position, target);
    this.distance = length(off);
    this.azimuth = Math.atan2(off[0], off[2]);
    this.elevation = Math.asin(clamp(off[1] / this.distance, -1, 1));
    this.target = target.slice();
    this.fov = (fov * Math.PI) / 180;
    this.orthographic = orthographic;
  }

  direction() {
    const { azimuth, elevation } = this;
    return [Math.sin(azimuth) * Math.cos(elevation), Math.sin(elevation), Math.cos(azimuth) * Math.cos(elevation)];
  }

  // The world's axes as they are seen, those that point away first: letter, to the right, down, in lengths of one that lies across.
  axes() {
    const back = this.direction(), x = unit(cross([0, 1, 0], back)), y = cross(back, x);
    return ["x", "y", "z"].map((letter, i) => [letter, x[i], -y[i], back[i]]).sort((a, b) => a[3] - b[3]);
  }

  orbit(right, up) {
    this.azimuth -= right;
    this.elevation = clamp(this.elevation + up, -1.55, 1.55);
  }

  zoom(factor) {
    this.distance = clamp(this.distance * factor, 0.02 * length(minus(this.view.position, this.view.target)), 1e4);
  }

  // By shares of the image's height.
  pan(right, up) {
    const height = 2 * this.distance * Math.tan(this.fov / 2);
    const back = this.direction(), x = unit(cross([0, 1, 0], back)), y = cross(back, x);
    this.target = plus(this.target, plus(times(-right * height, x), times(-up * height, y)));
  }

  // Uniforms for an image of that size, with everything moved along.
  frame(width, height, along) {
    const narrow = (4 / 3) * (height / width);
    const angle = narrow > 1 ? Math.min(2 * Math.atan(narrow * Math.tan(this.fov / 2)), 3.1) : this.fov;
    const target = plus(this.target, along), back = this.direction(), aspect = width / height;
    const up = Math.abs(back[1]) > 0.99999 ? [0, 0, -1] : [0, 1, 0], d = this.distance;
    const eye = plus(target, times(this.orthographic ? farthest * d : d, back));
    const half = d * Math.tan(angle / 2);
    const projection = this.orthographic
      ? orthographic(aspect * half, half, 2 * farthest * d)
      : perspective(angle, aspect, d / 200, farthest * d);
    const view = lookAt(eye, target, up), all = product(projection, view);
    return { target, view, projection, view_projection: all, clip_to_world: inverse(all), eye: [...eye, d],
      viewer: this.orthographic ? [...back, 0] : [...eye, 1], viewport: [width, height, 1 / width, 1 / height] };
  }
}
