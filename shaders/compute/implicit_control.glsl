// Implicit Euler: where the solve is, which the last group of a reduction decides.
layout(std430, binding = BINDING_SOLVE) restrict coherent buffer SolveBlock {
  Solve solve;
  vec4 partials[];
};

// What no dispatch changes while it works, read once an invocation: the block is coherent, so that every look at it goes
// past the caches.
uint parity;       // where the state is
uint ended_steps;  // Solve.step
bool prescribing;  // Solve.prescribing; evaluate alone changes it, and does not look at it

// The phase of the dispatch; every kernel begins with it.
uint enter() {
  parity = solve.parity;
  ended_steps = solve.step;
  prescribing = solve.prescribing != 0u;
  return solve.phase;
}

uint steps_done() { return ended_steps; }

void report_overrun(uint kernel) { atomicMax(solve.overrun, kernel); }
