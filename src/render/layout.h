#pragma once
// shaders/render/layout.glsl as C++.
#include <cstddef>
#include <cstdint>
#include <glm/mat4x4.hpp>
#include <glm/vec4.hpp>

#include "device/layout.h"

namespace aspic::render_layout {

using uint = std::uint32_t;
using glm::mat4;
using glm::uvec4;
using glm::vec4;

#include "render/layout.glsl"

static_assert(sizeof(Bounds) == 32 && sizeof(LightBox) == 32);
static_assert(offsetof(Frame, lights) == 256 && offsetof(Frame, eye) == 256 + 64 * LIGHTS);
static_assert(offsetof(Frame, shadow_spheres) == 256 + 64 * LIGHTS + 128);
static_assert(sizeof(Frame) == 256 + 64 * LIGHTS + 128 + 16 * MAX_SHADOW_SPHERES + 16);

}  // namespace aspic::render_layout
