// Implicit Euler, conjugate gradients: the matrix of contacts times the direction, for a particle.
#include "compute/layout.glsl"
#include "compute/common.glsl"
#include "compute/implicit_control.glsl"
#include "compute/terms/body_contact.glsl"
#define COUNTS(record) (records[record].answer.w > 0.0 || records[record].turn.w > 0.0)
#include "compute/contact_sums.glsl"

layout(std430, binding = BINDING_SEARCH) restrict buffer Search { vec4 search[]; };

void main() {
  uint n = item_index();
  if (n >= contact_count || enter() != PHASE_CG || solve.in_contact == 0u) return;
  ContactParticle own = listed[n];
  uint i = own.listed;
  precise vec3 sum = vec3(0.0);
  FOR_CONTACTS(own.own_first, own.own_count) {
    precise float weight = weight_of_carrier(e, i);
    sum = sum + weight * records[r].answer.xyz;
  }
  FOR_CONTACTS(own.visit_first, own.visit_count) {
    if (!is_corner(r, i)) continue;
    precise float weight = weight_of_corner(r, i);
    sum = sum - weight * records[r].answer.xyz;
  }
  search[CONTACT_AT(CONTACT_PRODUCT, i)] = vec4(sum, 0.0);
}
