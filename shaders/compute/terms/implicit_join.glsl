// Which terrains hold a particle together: one by one they join those that hold it so far.
const uint NO_TWIN = 0xffffffffu;

// The terrain among those that hold the particle which is one surface with terrain t, or NO_TWIN.
uint twin_of(uint t, vec3 x, Reaction r) {
  for (uint k = 0u; k < r.count; ++k) {
    uint s = r.held[k];
    precise vec4 a = gap_at_start(t, x);
    precise vec4 b = gap_at_start(s, x);
    precise vec3 line = cross3(a.xyz, b.xyz);
    if (dot3(line, line) > least_wedge || !(dot3(a.xyz, b.xyz) > 0.0)) continue;
    precise float difference = least_speed_of(t, a) - least_speed_of(s, b);
    precise float apart = time_step * abs(difference);
    precise float one = SAME_SURFACE_SHARE * contact_distance;
    if (apart <= one) return s;
  }
  return NO_TWIN;
}

// Which of two terrains that are one surface holds a particle.
bool outranks(uint t, uint s) {
  precise float difference = terrains[t].friction - terrains[s].friction;
  return difference > 0.0 || (difference == 0.0 && t < s);
}

// The fewest of those that hold the particle already, and terrain t in place of `twin`, with which none is crossed and
// none pulls.
Reaction joined(vec3 x, float m, vec3 v, Reaction so_far, uint t, uint twin) {
  uint others[3] = uint[3](0u, 0u, 0u), count = 0u;
  for (uint k = 0u; k < so_far.count; ++k) {
    if (so_far.held[k] != twin) others[count++] = so_far.held[k];
  }
  if (count == 3u) return so_far;
  uint subsets = 1u << count;
  for (uint subset = 0u; subset < subsets; ++subset) {
    Reaction next = no_reaction(v);
    for (uint k = 0u; k < count; ++k) {
      if (((subset >> k) & 1u) != 0u) next.held[next.count++] = others[k];
    }
    next.held[next.count++] = t;
    bool crossing = !hold(x, m, v, subset + 1u == subsets, next);
    for (uint k = 0u; k < count && !crossing; ++k) crossing = crosses(others[k], x, next);
    if (!crossing) return next;
  }
  return so_far;
}
