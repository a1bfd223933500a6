// The quantities of one spring that colors show: e from its end b to a, their relative velocity u, and k, c, r and whether it is a cord.
struct SpringQuantity {
  float strain;    // (L − r)/r
  float strength;  // k(L − r) + damping [N], positive where it pulls its ends together; 0 of a slack cord
  float energy;    // ½k(L − r)² [J]; 0 of a slack cord
  float actuation; // r/r₀ − 1, where the host gives r₀ in the place of c: where colors show it
};

SpringQuantity spring_quantity(vec3 e, vec3 u, float k, float c, float r, bool cord) {
  float L = length(e);
  float stretch = L - r;
  bool acts = L > 0.0 && !(cord && stretch < 0.0);
  return SpringQuantity(stretch / r, acts ? k * stretch + c * dot(u, e) / L : 0.0, acts ? 0.5 * k * stretch * stretch : 0.0,
                        color_mode == COLOR_ACTUATION ? r / c - 1.0 : 0.0);
}

// The one that a color shows.
float chosen_of(SpringQuantity q) {
  if (color_mode == COLOR_STRAIN) return abs(q.strain);
  if (color_mode == COLOR_SIGNED_STRAIN) return q.strain;
  if (color_mode == COLOR_ACTUATION) return q.actuation;
  return color_mode == COLOR_FORCE ? abs(q.strength) : q.energy;
}
