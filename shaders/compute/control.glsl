// Explicit methods: the step and stage a dispatch works on, and the words that stop it.
layout(location = LOCATION_STEP) uniform uint step_index;
layout(location = LOCATION_STAGE) uniform uint stage_index;

layout(std430, binding = BINDING_CONTROL) restrict buffer ControlBlock { Control control; };

uint steps_done() { return step_index; }

// An earlier step diverged, or is to be repeated: its start state must stay as it is. Or a loop was cut short: what
// follows would build on it.
bool halted() { return min(control.bad_step, control.full_step) < step_index || control.overrun != 0u; }

// Called by every invocation that is at work: item `i` of `count` has been carried out.
void count_item(uint i, uint count) {
  if (is_counted(i, count)) atomicAdd(control.passes, 1u);
}

void report_overrun(uint kernel) { atomicMax(control.overrun, kernel); }
