#pragma once
// shaders/compute/layout.glsl as C++: the structs the kernels read, with their sizes and offsets held by the
// compiler. tests/gpu_solver/layout_gl_test.cpp compares them with what the driver says.
#include <cstddef>

#include "device/layout.h"
#include "model/implicit.h"
#include "model/integrator.h"
#include "model/shapes/shape.h"

namespace aspic::layout {

#include "compute/layout.glsl"

static_assert(GEOMETRY_SIZE == geometry_size && SAME_SURFACE_SHARE == same_surface_share);
static_assert(sizeof(BallContacts) == 32 && offsetof(BallContacts, items) == 28);
static_assert(sizeof(BallItem) == 128 && offsetof(BallItem, acts) == 32 && offsetof(BallItem, linear) == 96);
static_assert(sizeof(BallWork) == 64 && offsetof(BallWork, word_groups) == 16);
static_assert(sizeof(BallFacePair) == 80 && offsetof(BallFacePair, linear) == 32 &&
              sizeof(BallFaceCount) == 8);
static_assert(sizeof(CandidateGroup) == 88 && offsetof(CandidateGroup, carrier_weight0) == 36);
static_assert(sizeof(ContactRecord) == 96 && sizeof(ContactParticle) == 32);
static_assert(sizeof(BallBody) == 16 && offsetof(BallBody, launch_step) == 8);
static_assert(offsetof(Simulation, ball_count) == 116 && offsetof(Simulation, ball_restitution) == 128);
static_assert(sizeof(Stage) == 16 && sizeof(Control) == 32 && offsetof(Control, passes) == 16);
static_assert(sizeof(Pull) == 32 && offsetof(Pull, stiffness) == 16 && offsetof(Pull, particle) == 24);
static_assert(sizeof(Solve) == 192 && offsetof(Solve, lambda) == 64 && offsetof(Solve, converged) == 120 &&
              offsetof(Solve, moved) == 160);
static_assert(sizeof(Terrain) == 80 && offsetof(Terrain, mass) == 48 && offsetof(Terrain, shape) == 64);
static_assert(offsetof(Simulation, contact_distance) == 16 && offsetof(Simulation, particle_count) == 32);
static_assert(offsetof(Simulation, class_bits) == 48 && offsetof(Simulation, time_step) == 64);
static_assert(offsetof(Simulation, stages) == 176);
static_assert(offsetof(Simulation, spring_classes) == 240);
static_assert(offsetof(Simulation, terrains) == 240 + 16 * MAX_SPRING_CLASSES);
// OpenGL 4.3 guarantees uniform blocks of 16 KiB.
static_assert(sizeof(Simulation) == 240 + 16 * MAX_SPRING_CLASSES + 80 * MAX_TERRAINS &&
              sizeof(Simulation) <= 16384);

}  // namespace aspic::layout
