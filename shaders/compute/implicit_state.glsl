// Implicit Euler: the state that a step begins with.
layout(std430, binding = BINDING_STATE_A) restrict buffer StateA { Particle state_a[]; };
layout(std430, binding = BINDING_STATE_B) restrict buffer StateB { Particle state_b[]; };

Particle state(uint i) {
  if (parity == 0u) return state_a[i];
  return state_b[i];
}
