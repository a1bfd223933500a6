// What contacts give a particle: as a carrier first, then as a corner, contacts ascending. An includer defines TAKE(weight,
// record), which adds a contact's part to a carrier, and GIVE(weight, record) for a corner; both expect contacts with a normal force.
// The host bounds both lists.
#ifndef COUNTS  // whether a contact counts
#define COUNTS(record) (records[record].normal.w > 0.0)
#endif
layout(std430, binding = BINDING_CONTACT_LISTED) restrict readonly buffer Listed { ContactParticle listed[]; };
layout(std430, binding = BINDING_CONTACT_WORDS) restrict readonly buffer Words { uint words[]; };

#define FOR_CONTACTS(first, count)                                                    \
  for (uint n_e = 0u; n_e < (count); ++n_e)                                           \
    for (uint e = words[(first) + n_e], r = first_record(e), end = r + records[r].corner.w; r < end; ++r) \
      if (COUNTS(r))

// A particle's weight among the carriers of a candidate group's point.
float weight_of_carrier(uint e, uint i) {
  return candidate_groups[e].carrier0 == i ? candidate_groups[e].carrier_weight0 : candidate_groups[e].carrier_weight1;
}

bool is_corner(uint r, uint i) { return any(equal(records[r].corner.xyz, uvec3(i))); }

// And among the corners of a contact's triangle.
float weight_of_corner(uint r, uint i) {
  uvec4 corner = records[r].corner;
  return corner.x == i ? records[r].share.x : corner.y == i ? records[r].share.y : records[r].share.z;
}
