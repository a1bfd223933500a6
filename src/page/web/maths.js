// Vectors are arrays of three numbers, matrices of sixteen, column by column, as WebGL takes them.
const plus = (a, b) => [a[0] + b[0], a[1] + b[1], a[2] + b[2]];
const minus = (a, b) => [a[0] - b[0], a[1] - b[1], a[2] - b[2]];
const times = (s, a) => [s * a[0], s * a[1], s * a[2]];
const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
const length = (a) => Math.sqrt(dot(a, a));
const unit = (a) => times(1 / length(a), a);
const clamp = (x, low, high) => Math.min(Math.max(x, low), high);

function product(a, b) {
  const c = new Float32Array(16);
  for (let column = 0; column < 4; ++column)
    for (let row = 0; row < 4; ++row)
      for (let k = 0; k < 4; ++k) c[4 * column + row] += a[4 * k + row] * b[4 * column + k];
  return c;
}

// A rotation and a shift that bring the eye to the origin, looking along −z.
function lookAt(eye, target, up) {
  const z = unit(minus(eye, target)), x = unit(cross(up, z)), y = cross(z, x);
  return new Float32Array([x[0], y[0], z[0], 0, x[1], y[1], z[1], 0, x[2], y[2], z[2], 0,
    -dot(x, eye), -dot(y, eye), -dot(z, eye), 1]);
}

function perspective(angle, aspect, near, far) {
  const f = 1 / Math.tan(angle / 2), m = new Float32Array(16);
  m[0] = f / aspect;
  m[5] = f;
  m[10] = (far + near) / (near - far);
  m[11] = -1;
  m[14] = (2 * far * near) / (near - far);
  return m;
}

function orthographic(halfWidth, halfHeight, far) {
  const m = new Float32Array(16);
  m[0] = 1 / halfWidth;
  m[5] = 1 / halfHeight;
  m[10] = -2 / far;
  m[14] = -1;
  m[15] = 1;
  return m;
}

// The turn by `angle` about a unit axis, after the turn q; quaternions (x, y, z, w).
function turned(q, axis, angle) {
  const s = Math.sin(angle / 2), a = [s * axis[0], s * axis[1], s * axis[2]], w = Math.cos(angle / 2);
  const v = plus(plus(times(w, q), times(q[3], a)), cross(a, q));
  return [...v, w * q[3] - dot(a, q)];
}

// A number in few characters, as our images write it.
function shortNumber(x) {
  const size = Math.abs(x);
  if (x === 0) return "0";
  if (size >= 1e6 || size < 1e-3) return x.toExponential(2).replace("e+", "e").replace("-", "−");
  return String(Number(x.toPrecision(4))).replace("-", "−");
}

// By Gauss and Jordan, with the largest pivot.
function inverse(m) {
  const a = Array.from({ length: 4 }, (_, r) => [0, 1, 2, 3].map((c) => m[4 * c + r]).concat([0, 1, 2, 3].map((c) => Number(c === r))));
  for (let c = 0; c < 4; ++c) {
    let best = c;
    for (let r = c + 1; r < 4; ++r) if (Math.abs(a[r][c]) > Math.abs(a[best][c])) best = r;
    [a[c], a[best]] = [a[best], a[c]];
    const pivot = a[c][c];
    a[c] = a[c].map((x) => x / pivot);
    a.forEach((row, r) => {
      if (r === c) return;
      const factor = row[c];
      for (let k = 0; k < 8; ++k) row[k] -= factor * a[c][k];
    });
  }
  return Float32Array.from({ length: 16 }, (_, i) => a[i % 4][4 + (i >> 2)]);
}
