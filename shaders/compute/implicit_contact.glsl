// Contact of bodies in implicit Euler: what particles near others have of it lies behind the search directions, and is zero
// for all others. Bodies are found to be near each other in a step, or not: Solve.in_contact.
vec3 contact_of(uint which, uint i) { return search[CONTACT_AT(which, i)].xyz; }

// Before the first solve of a step.
void keep_start(uint i, Particle p, vec3 f) {
  search[CONTACT_AT(CONTACT_START_FORCE, i)] = vec4(f, p.position.w);
  search[CONTACT_AT(CONTACT_START_VELOCITY, i)] = vec4(p.velocity.xyz, 0.0);
}
