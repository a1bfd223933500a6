// The symmetric 3×3 block of one particle on the matrix's diagonal, its inverse by Cramer's rule.
struct DiagonalBlock {
  vec3 diagonal;  // xx, yy, zz
  vec3 mixed;     // xy, xz, yz
};

DiagonalBlock block_of_mass(float m) { return DiagonalBlock(vec3(m), vec3(0.0)); }

DiagonalBlock with_spring(DiagonalBlock b, SpringJacobian H) {
  precise float w = H.along - H.across;
  precise vec3 n = H.n;
  precise vec3 diagonal = b.diagonal + (H.across + w * (n * n));
  precise vec3 mixed = b.mixed + w * vec3(n.x * n.y, n.x * n.z, n.y * n.z);
  return DiagonalBlock(diagonal, mixed);
}

DiagonalBlock inverse_of(DiagonalBlock b) {
  precise float xx = b.diagonal.x, yy = b.diagonal.y, zz = b.diagonal.z;
  precise float xy = b.mixed.x, xz = b.mixed.y, yz = b.mixed.z;
  precise vec3 diagonal = vec3(yy * zz - yz * yz, xx * zz - xz * xz, xx * yy - xy * xy);
  precise vec3 mixed = vec3(xz * yz - xy * zz, xy * yz - xz * yy, xy * xz - xx * yz);
  precise float determinant = (xx * diagonal.x + xy * mixed.x) + xz * mixed.y;
  precise float d = exact_div(1.0, determinant);
  precise vec3 inverse_diagonal = d * diagonal;
  precise vec3 inverse_mixed = d * mixed;
  return DiagonalBlock(inverse_diagonal, inverse_mixed);
}

vec3 times(DiagonalBlock b, vec3 r) {
  precise vec3 product = vec3((b.diagonal.x * r.x + b.mixed.x * r.y) + b.mixed.y * r.z,
                              (b.mixed.x * r.x + b.diagonal.y * r.y) + b.mixed.z * r.z,
                              (b.mixed.y * r.x + b.mixed.z * r.y) + b.diagonal.z * r.z);
  return product;
}
