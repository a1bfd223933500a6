// What is drawn, as arrays for the device: skins, springs' ends, terrain, rods.

const ownNormal = 0xffffffff;  // in place of a vertex's last neighbor

// Meshes that follow particles. Each vertex has two texels after those of the particles: where it is, its normal.
class Meshes {
  constructor(facts) {
    this.list = facts.bodies.flatMap(({ mesh }) => mesh ?? []);
    this.end = facts.particles;  // of the texels
    for (const mesh of this.list) {
      const { vertices, at } = mesh, part = (axis, high, v) => (high ? at[axis][v] : 1 - at[axis][v]);
      mesh.first = this.end;
      this.end += 2 * vertices;
      mesh.weights = mesh.corners.map((_, n) => Float32Array.from({ length: vertices }, (__, v) => part(0, n & 4, v) * part(1, n & 2, v) * part(2, n & 1, v)));
    }
  }

  // Trilinear means of the cells' corners, colors too; then normals: means of the triangles, weighted by area (src/model/skin.h).
  move(texels) {
    for (const mesh of this.list) {
      const begin = 4 * mesh.first, { vertices } = mesh;
      texels.fill(0, begin, begin + 8 * vertices);
      mesh.corners.forEach((corner, n) => {
        const weights = mesh.weights[n];
        for (let v = 0, to = begin; v < vertices; ++v, to += 8)
          for (let c = 0, from = 4 * corner[v]; c < 4; ++c) texels[to + c] += weights[v] * texels[from + c];
      });
      this.turn(mesh, texels, begin);
    }
  }

  turn({ vertices, triangles, corner: [first, second, third] }, texels, begin) {
    for (let t = 0; t < triangles; ++t) {
      const a = begin + 8 * first[t], b = begin + 8 * second[t], c = begin + 8 * third[t];
      const x = texels[a], y = texels[a + 1], z = texels[a + 2];
      const ux = texels[b] - x, uy = texels[b + 1] - y, uz = texels[b + 2] - z;
      const vx = texels[c] - x, vy = texels[c + 1] - y, vz = texels[c + 2] - z;
      const nx = uy * vz - uz * vy, ny = uz * vx - ux * vz, nz = ux * vy - uy * vx;
      for (let at = a, k = 0; k < 3; ++k, at = k === 1 ? b : c) {
        texels[at + 4] += nx;
        texels[at + 5] += ny;
        texels[at + 6] += nz;
      }
    }
    for (let v = 0, n = begin + 4; v < vertices; ++v, n += 8) {
      const size = Math.hypot(texels[n], texels[n + 1], texels[n + 2]);
      if (size === 0) texels[n + 1] = 1;
      else for (let c = 0; c < 3; ++c) texels[n + c] /= size;
    }
  }
}

// The skins of a run by body: each vertex is a particle with its neighbors along the quads of its group of normals: along
// the side from a quad's corner 0 to 1 the next and the one before, likewise from corner 0 to 3; itself where there is none. Of a mesh
// it is the vertex's own texel, with that of its normal.
function skins(facts) {
  const vertices = [], indices = [], parts = [];
  for (const body of facts.bodies) {
    const first = indices.length;
    let quad = 0;
    if (body.mesh) {
      const { first: texel, vertices: count, triangles, corner } = body.mesh, from = vertices.length / 5;
      for (let v = 0; v < count; ++v) vertices.push(texel + 2 * v, texel + 2 * v + 1, 0, 0, ownNormal);
      for (let t = 0; t < triangles; ++t) for (const list of corner) indices.push(from + list[t]);
    }
    for (const quads of body.groups) {
      const known = new Map();
      const vertex = (particle) => {
        if (!known.has(particle)) {
          known.set(particle, vertices.length / 5);
          vertices.push(particle, particle, particle, particle, particle);
        }
        return known.get(particle);
      };
      for (const end = quad + quads; quad < end; ++quad) {
        const q = body.quads.map((corner) => corner[quad]), [a, b, c, d] = q.map(vertex);
        for (const [from, to, p, n] of [[a, b, q[0], q[1]], [d, c, q[3], q[2]]]) {
          vertices[5 * from + 1] = n;
          vertices[5 * to + 2] = p;
        }
        for (const [from, to, p, n] of [[a, d, q[0], q[3]], [b, c, q[1], q[2]]]) {
          vertices[5 * from + 3] = n;
          vertices[5 * to + 4] = p;
        }
        indices.push(a, b, c, a, c, d);
      }
    }
    parts.push({ body, first, count: indices.length - first });
  }
  return { vertices: Uint32Array.from(vertices), indices: Uint32Array.from(indices), parts };
}

// Positions and normals (six numbers a vertex) of a terrain's surface, whose points go round in u and, of a torus, in v.
function terrainMesh(terrain) {
  const { rings, sectors, quantum, numbers, turn } = terrain.surface, strip = sectors + 1, count = (rings + 1) * strip;
  const points = Array.from({ length: count }, (_, i) =>
    plus(terrain.place, [0, 1, 2].map((c) => numbers[c * count + i] * quantum)));
  const round = Array.from({ length: strip }, (_, s) => length(minus(points[s], points[rings * strip + s])));
  const closed = Math.max(...round) < 4 * quantum;
  const ringOf = (r) => (closed ? (r + rings) % rings : clamp(r, 0, rings));
  const at = (r, s) => points[ringOf(r) * strip + ((s + sectors) % sectors)];
  const normals = points.map((_, i) => {
    const r = Math.floor(i / strip), s = i % strip;
    return times(turn, cross(minus(at(r, s + 1), at(r, s - 1)), minus(at(r + 1, s), at(r - 1, s))));
  });
  const vertices = new Float32Array(6 * count), indices = [];
  points.forEach((x, i) => {
    // At a pole the points of a ring are one: its normal is the mean of those of the ring next to it.
    let n = normals[i];
    if (length(n) < 40 * quantum * quantum) {
      const next = (i < strip ? 1 : rings - 1) * strip;
      n = normals.slice(next, next + sectors).reduce(plus);
    }
    vertices.set([...x, ...unit(n)], 6 * i);
  });
  for (let r = 0; r < rings; ++r)
    for (let s = 0; s < sectors; ++s) {
      const a = r * strip + s, b = a + 1, c = a + strip + 1, d = a + strip;
      indices.push(...(turn > 0 ? [a, b, c, a, c, d] : [a, c, b, a, d, c]));
    }
  return { vertices, indices: Uint32Array.from(indices) };
}

// A tube with round ends along each rod [from, to, radius].
function rodMesh(rods) {
  const sectors = 16, caps = 5, vertices = [], indices = [];
  for (const [ax, ay, az, bx, by, bz, radius] of rods) {
    const from = [ax, ay, az], to = [bx, by, bz], axis = unit(minus(to, from));
    const u = unit(cross(Math.abs(axis[1]) > 0.5 ? [1, 0, 0] : [0, 1, 0], axis)), v = cross(axis, u);
    const first = vertices.length / 6, rows = 2 * (caps + 1);
    for (let row = 0; row < rows; ++row) {
      // Half a sphere about `from`, half a sphere about `to`.
      const end = row <= caps ? from : to, angle = (Math.PI / 2) * (row <= caps ? row / caps - 1 : (row - caps - 1) / caps);
      for (let s = 0; s <= sectors; ++s) {
        const around = (2 * Math.PI * s) / sectors;
        const n = plus(times(Math.cos(angle), plus(times(Math.cos(around), u), times(Math.sin(around), v))), times(Math.sin(angle), axis));
        vertices.push(...plus(end, times(radius, n)), ...n);
        if (row === 0 || s === 0) continue;
        const d = first + row * (sectors + 1) + s, c = d - 1, b = d - sectors - 1, a = b - 1;
        indices.push(a, b, d, a, d, c);
      }
    }
  }
  return { vertices: Float32Array.from(vertices), indices: Uint32Array.from(indices) };
}
