// The friction of a contact: the impulse that ends the slip of v₁, or as much of it as the cone allows. An includer has,
// of particles, part(i), w·S in every component, and end_velocity(i), v₁.
vec3 friction_of(CandidateGroup of, ContactRecord contact) {
  uvec4 t = contact.corner;
  precise float normal_force = contact.normal.w;
  precise vec3 own = over_carriers(of, part(of.carrier0), part(of.carrier1));
  precise vec3 other = over_corners(contact.share.xyz, part(t.x), part(t.y), part(t.z));
  precise float both = own.x + other.x;
  precise float W = exact_div(both, normal_force);
  if (!(W > 0.0)) return vec3(0.0);
  precise vec3 own_v = over_carriers(of, end_velocity(of.carrier0), end_velocity(of.carrier1));
  precise vec3 other_v = over_corners(contact.share.xyz, end_velocity(t.x), end_velocity(t.y), end_velocity(t.z));
  precise vec3 relative = own_v - other_v;
  precise vec3 n = contact.normal.xyz;
  precise vec3 slip = relative - dot3(n, relative) * n;
  precise vec3 J = exact_div(1.0, W) * slip;
  precise float size = norm3(J), cone = of.contact_friction * (time_step * normal_force);
  if (size > cone) J = exact_div(cone, size) * J;
  precise vec3 friction = exact_div(1.0, time_step) * -J;
  return friction;
}
