// Spring classes by number. With ASPIC_ACTUATED rest lengths follow signals (docs/actuation.md): constants of all classes,
// and the rest lengths that the host made for each stage of the next steps (src/gpu_solver/lengths.h), lie in the buffer of
// BINDING_INCIDENT_START, whose first words say where; kernels first say which stage is at hand.
#ifdef ASPIC_ACTUATED
#define INCIDENT_HEAD LENGTHS_HEAD
#ifndef BINDING_LENGTHS
#define BINDING_LENGTHS BINDING_INCIDENT_START
#endif
layout(std430, binding = BINDING_LENGTHS) restrict readonly buffer IncidentStart { uint incident_start[]; };

uint lengths_at;  // first of the row at hand

// `stage`: of those of a step.
void use_lengths(uint step, uint stage) {
  uint row = (step - incident_start[LENGTHS_FIRST_STEP]) * incident_start[LENGTHS_STAGES] + stage;
  lengths_at = incident_start[LENGTHS_ROWS] + row * incident_start[LENGTHS_CLASSES];
}

SpringClass spring_class(uint c) {
  uint at = incident_start[LENGTHS_CONSTANTS] + 3u * c;
  return SpringClass(uintBitsToFloat(incident_start[at]), uintBitsToFloat(incident_start[at + 1u]),
                     uintBitsToFloat(incident_start[lengths_at + c]), incident_start[at + 2u]);
}
#else
#define INCIDENT_HEAD 0u
void use_lengths(uint step, uint stage) {}
SpringClass spring_class(uint c) { return spring_classes[c]; }
#endif
