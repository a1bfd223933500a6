// Adds the normal forces of contacts to the forces of a particle; with them, the velocity v₁ with which the step would end, and how
// much of the normal forces S falls to the particle, which friction goes by.
#include "compute/layout.glsl"
#include "compute/common.glsl"
#include "compute/control.glsl"
#include "compute/terms/body_contact.glsl"
#include "compute/contact_sums.glsl"

layout(std430, binding = BINDING_START_STATE) restrict readonly buffer StartState { Particle start_state[]; };
layout(std430, binding = BINDING_OUT_STATE) restrict buffer OutState { Particle out_state[]; };
layout(std430, binding = BINDING_CONTACT_VALUES) restrict writeonly buffer Values { vec4 values[]; };

void main() {
  uint n = item_index();
  if (n >= contact_count || halted()) return;
  ContactParticle own = listed[n];
  uint i = own.listed;
  precise vec3 f = out_state[i].velocity.xyz;
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
  out_state[i].velocity.xyz = f;
  Particle start = start_state[i];
  precise float hw = time_step * start.position.w;
  precise vec3 v_1 = start.velocity.xyz + hw * f;
  values[i] = vec4(v_1, S);
}
