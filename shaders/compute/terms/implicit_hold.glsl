// What one, two or three terrains make of a free velocity v: `r` has their indices and takes the rest.

// Coulomb's law on one surface: P(v) = keep·v_t + c·n.
bool on_one(vec3 x, float m, vec3 v, inout Reaction r) {
  uint t = r.held[0];
  precise vec4 g = gap_at_start(t, x);
  precise vec3 v_r = relative_velocity(t, AT_END, v);
  precise float u = dot3(v_r, g.xyz);
  precise float c = least_speed(g);
  precise vec3 v_t = v_r - u * g.xyz;
  precise float slip = norm3(v_t);
  precise float loss = terrains[t].friction * (c - u);
  precise float keep = slip_kept(slip, loss);
  precise vec3 left = c * g.xyz;
  r.freedom = FREE_NONE;
  if (keep > 0.0) {
    left = keep * v_t + left;
    precise float stiffness = m * (exact_div(1.0, keep > least_turn ? keep : least_turn) - 1.0);
    r.freedom = FREE_PLANE;
    r.axis = g.xyz;
    r.stiffness = stiffness;
    if (slip > 0.0) {
      precise float q = exact_div(1.0, slip);
      precise vec3 across = q * cross3(g.xyz, v_t);
      r.across = across;
    }
  }
  r.v = absolute_velocity(t, left);
  return u < c;
}

// Two surfaces leave the line along both; both normal impulses bear on the friction there. The last choice is taken
// even if one would have to pull, which only friction can ask for; it does not.
bool between_two(vec3 x, vec3 v, bool last, inout Reaction r) {
  uint i = r.held[0], j = r.held[1];
  precise vec4 a = gap_at_start(i, x);
  precise vec4 b = gap_at_start(j, x);
  precise vec3 line = cross3(a.xyz, b.xyz);
  precise float sine2 = dot3(line, line);
  precise float cosine = dot3(a.xyz, b.xyz);
  if (!(sine2 > least_wedge)) return false;
  precise float c_a = least_speed_of(i, a);
  precise float c_b = least_speed_of(j, b);
  precise float short_a = c_a - dot3(v, a.xyz);
  precise float short_b = c_b - dot3(v, b.xyz);
  precise float lack_a = short_a - cosine * short_b;
  precise float lack_b = short_b - cosine * short_a;
  precise float normal_a = exact_div(lack_a, sine2);
  precise float normal_b = exact_div(lack_b, sine2);
  if (!last && (normal_a < 0.0 || normal_b < 0.0)) return false;
  precise float loss_a = terrains[i].friction * (normal_a > 0.0 ? normal_a : 0.0);
  precise float loss_b = terrains[j].friction * (normal_b > 0.0 ? normal_b : 0.0);
  precise float loss = loss_a + loss_b;
  precise float q = exact_div(1.0, exact_sqrt(sine2));
  precise vec3 axis = q * line;
  precise float slip = dot3(v, axis);
  // The speed from which slip is counted: the mean of theirs, weighted by the slip that the friction of each can take.
  bool moving = moves(i) || moves(j);
  precise float still = 0.0;
  if (moving && loss > 0.0) {
    precise float sum = loss_a * speed_along(i, axis) + loss_b * speed_along(j, axis);
    still = exact_div(sum, loss);
  }
  if (moving) slip = slip - still;
  precise float keep = slip_kept(abs(slip), loss);
  precise float off_a = c_a - cosine * c_b;
  precise float off_b = c_b - cosine * c_a;
  precise vec3 left = exact_div(off_a, sine2) * a.xyz + exact_div(off_b, sine2) * b.xyz;
  r.freedom = FREE_NONE;
  if (keep > 0.0) {
    left = (keep * slip) * axis + left;
    r.freedom = FREE_LINE;
  }
  if (moving) left = still * axis + left;
  r.axis = axis;
  r.v = left;
  return true;
}

// Three surfaces leave one point.
bool among_three(vec3 x, inout Reaction r) {
  precise vec4 a = gap_at_start(r.held[0], x);
  precise vec4 b = gap_at_start(r.held[1], x);
  precise vec4 c = gap_at_start(r.held[2], x);
  precise vec3 bc = cross3(b.xyz, c.xyz);
  precise vec3 ca = cross3(c.xyz, a.xyz);
  precise vec3 ab = cross3(a.xyz, b.xyz);
  precise float volume = dot3(a.xyz, bc);
  if (!(volume * volume > least_wedge)) return false;
  precise float c_a = least_speed_of(r.held[0], a);
  precise float c_b = least_speed_of(r.held[1], b);
  precise float c_c = least_speed_of(r.held[2], c);
  precise vec3 sum = (c_a * bc + c_b * ca) + c_c * ab;
  precise vec3 left = exact_div(1.0, volume) * sum;
  r.freedom = FREE_NONE;
  r.v = left;
  return true;
}

bool hold(vec3 x, float m, vec3 v, bool last, inout Reaction r) {
  if (r.count == 1u) return on_one(x, m, v, r);
  if (r.count == 2u) return between_two(x, v, last, r);
  return among_three(x, r);
}
