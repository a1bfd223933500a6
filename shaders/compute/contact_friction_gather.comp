// Adds the friction of contacts to the forces of a particle.
#include "compute/layout.glsl"
#include "compute/common.glsl"
#include "compute/control.glsl"
#include "compute/terms/body_contact.glsl"
#include "compute/contact_sums.glsl"

layout(std430, binding = BINDING_OUT_STATE) restrict buffer OutState { Particle out_state[]; };

void main() {
  uint n = item_index();
  if (n >= contact_count || halted()) return;
  ContactParticle own = listed[n];
  uint i = own.listed;
  precise vec3 f = out_state[i].velocity.xyz;
  FOR_CONTACTS(own.own_first, own.own_count) {
    precise float weight = weight_of_carrier(e, i);
    f = f + weight * records[r].friction.xyz;
  }
  FOR_CONTACTS(own.visit_first, own.visit_count) {
    if (!is_corner(r, i)) continue;
    precise float weight = weight_of_corner(r, i);
    f = f - weight * records[r].friction.xyz;
  }
  out_state[i].velocity.xyz = f;
}
