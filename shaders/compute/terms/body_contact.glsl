// Shared by the kernels of contact between bodies (docs/contact.md): candidate groups, which are points and triangles that the
// host found near each other, and the contacts made of them.
layout(location = LOCATION_CONTACT_COUNT) uniform uint contact_count;

layout(std430, binding = BINDING_CANDIDATE_GROUPS) restrict readonly buffer CandidateGroups { CandidateGroup candidate_groups[]; };
layout(std430, binding = BINDING_CONTACT_RECORDS) restrict buffer Records { ContactRecord records[]; };

uint first_record(uint candidate_group) { return candidate_group * CONTACT_RECORDS; }

// f = max(0, rest − c·u) with the normal speed u of the point relative to the face.
float normal_force_of(CandidateGroup of, float rest, float u) {
  precise float f = rest - of.contact_damping * u;
  return f > 0.0 ? f : 0.0;
}

// Σ weight·y over the carriers of a point; of one carrier its own.
vec3 over_carriers(CandidateGroup of, vec3 y_0, vec3 y_1) {
  if (of.carrier0 == of.carrier1) return y_0;
  precise vec3 sum = of.carrier_weight0 * y_0 + of.carrier_weight1 * y_1;
  return sum;
}

// Σ weight·y over the corners of a triangle.
vec3 over_corners(vec3 share, vec3 y_0, vec3 y_1, vec3 y_2) {
  precise vec3 sum = (share.x * y_0 + share.y * y_1) + share.z * y_2;
  return sum;
}
