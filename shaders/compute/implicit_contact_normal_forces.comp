// Implicit Euler: normal forces of contacts on a particle where they were found, and with them the velocity v₁ with which the step
// would end, and the particle's share in them, w·S: what friction begins with.
#include "compute/layout.glsl"
#include "compute/common.glsl"
#include "compute/implicit_control.glsl"
#include "compute/terms/body_contact.glsl"
#include "compute/contact_sums.glsl"

layout(std430, binding = BINDING_SEARCH) restrict buffer Search { vec4 search[]; };

void main() {
  uint n = item_index();
  if (n >= contact_count || enter() != PHASE_CONTACT) return;
  ContactParticle own = listed[n];
  uint i = own.listed;
  precise vec4 start = search[CONTACT_AT(CONTACT_START_FORCE, i)];
  precise vec3 f = start.xyz;
  precise float S = 0.0;
  FOR_CONTACTS(own.own_first, own.own_count) {
    precise float weight = weight_of_carrier(e, i);
    precise vec3 normal_force = records[r].normal.w * records[r].normal.xyz;
    f = f + weight * normal_force;
    S = S + weight * records[r].normal.w;
  }
  FOR_CONTACTS(own.visit_first, own.visit_count) {
    if (!is_corner(r, i)) continue;
    precise float weight = weight_of_corner(r, i);
    precise vec3 normal_force = records[r].normal.w * records[r].normal.xyz;
    f = f - weight * normal_force;
    S = S + weight * records[r].normal.w;
  }
  precise float hw = time_step * start.w;
  precise vec3 v_1 = search[CONTACT_AT(CONTACT_START_VELOCITY, i)].xyz + hw * f;
  precise float share = start.w * S;
  search[i] = vec4(v_1, share);
}
