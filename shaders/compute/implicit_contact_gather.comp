// Implicit Euler: the forces of contacts on a particle at the trial, and their part of its diagonal block.
#include "compute/layout.glsl"
#include "compute/common.glsl"
#include "compute/implicit_control.glsl"
#include "compute/terms/implicit_springs.glsl"
#include "compute/implicit_block.glsl"
#include "compute/terms/body_contact.glsl"
#define COUNTS(record) (records[record].answer.w > 0.0 || records[record].turn.w > 0.0)
#include "compute/contact_sums.glsl"

layout(std430, binding = BINDING_SEARCH) restrict buffer Search { vec4 search[]; };

DiagonalBlock with_contact(DiagonalBlock b, uint r, float weight) {
  precise float square = weight * weight;
  precise float along = square * records[r].answer.w, across = square * records[r].turn.w;
  DiagonalBlock sum = with_spring(b, SpringJacobian(along, across, records[r].normal.xyz));
  precise float turned = -across;
  return with_spring(sum, SpringJacobian(turned, 0.0, records[r].turn.xyz));
}

void main() {
  uint n = item_index();
  uint phase = enter();
  if (n >= contact_count || (phase != PHASE_CONTACT && phase != PHASE_EVALUATE) || solve.in_contact == 0u) return;
  ContactParticle own = listed[n];
  uint i = own.listed;
  precise vec3 f = vec3(0.0);
  DiagonalBlock block = block_of_mass(0.0);
  FOR_CONTACTS(own.own_first, own.own_count) {
    precise float weight = weight_of_carrier(e, i);
    f = f + weight * records[r].answer.xyz;
    block = with_contact(block, r, weight);
  }
  FOR_CONTACTS(own.visit_first, own.visit_count) {
    if (!is_corner(r, i)) continue;
    precise float weight = weight_of_corner(r, i);
    f = f - weight * records[r].answer.xyz;
    block = with_contact(block, r, weight);
  }
  search[CONTACT_AT(CONTACT_FORCE, i)] = vec4(f, 0.0);
  search[CONTACT_AT(CONTACT_DIAGONAL, i)] = vec4(block.diagonal, 0.0);
  search[CONTACT_AT(CONTACT_MIXED, i)] = vec4(block.mixed, 0.0);
}
