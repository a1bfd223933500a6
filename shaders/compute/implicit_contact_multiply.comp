// Implicit Euler, conjugate gradients: the matrix of the contacts of a candidate group times the direction.
#include "compute/layout.glsl"
#include "compute/common.glsl"
#include "compute/implicit_control.glsl"
#include "compute/terms/body_contact.glsl"

layout(std430, binding = BINDING_SEARCH) restrict readonly buffer Search { vec4 search[]; };

vec3 direction(uint i) { return prescribing ? search[CONTACT_AT(CONTACT_PRESCRIBED, i)].xyz : search[i].xyz; }

void multiply(CandidateGroup of, uint record) {
  ContactRecord contact = records[record];
  uvec4 t = contact.corner;
  precise vec3 own = over_carriers(of, direction(of.carrier0), direction(of.carrier1));
  precise vec3 other = over_corners(contact.share.xyz, direction(t.x), direction(t.y), direction(t.z));
  precise vec3 c = own - other;
  precise vec3 n = contact.normal.xyz;
  precise float along = dot3(n, c), turned = dot3(contact.turn.xyz, c);
  precise vec3 rest = (c - along * n) - turned * contact.turn.xyz;
  precise vec3 product = (contact.answer.w * along) * n + contact.turn.w * rest;
  records[record].answer.xyz = product;
}

void main() {
  uint n = item_index();
  if (n >= contact_count || enter() != PHASE_CG || solve.in_contact == 0u) return;
  uint first = first_record(n), end = first + records[first].corner.w;
  CandidateGroup of = candidate_groups[n];
  for (uint r = first; r < end; ++r) multiply(of, r);
}
