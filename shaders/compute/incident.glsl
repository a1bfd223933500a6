// The springs of each particle in ascending neighbour index, one word a spring: neighbour << class_bits | class.
layout(std430, binding = BINDING_INCIDENT_START) restrict readonly buffer IncidentStart { uint incident_start[]; };
layout(std430, binding = BINDING_INCIDENT) restrict readonly buffer Incident { uint incident[]; };

uint neighbour_of(uint word) { return word >> class_bits; }
SpringClass class_of(uint word) { return spring_classes[word & ((1u << class_bits) - 1u)]; }
