#include "render/frame_block.h"

#include <algorithm>
#include <cassert>
#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>

#include "model/terrain.h"
#include "render/color_map.h"
#include "render/light_maps.h"

namespace aspic {
namespace {

/// Towards the sun: from behind on the left of the default camera, so that light shines through bodies; from
/// the right where that would leave a slope in the dark.
glm::vec3 sun_over(const std::vector<Terrain>& terrain) {
  const auto least_slant = [&](const glm::vec3& sun) {
    float least = 1.0f;
    for (const Terrain& t : terrain)
      if (const auto flat = terrain_row(t.shape).flat)
        least = std::min(least, glm::dot(sun, to_glm(flat(t.geometry).normal)));
    return least;
  };
  const glm::vec3 left = glm::normalize(glm::vec3(-0.60f, 0.78f, -0.12f));
  const glm::vec3 right = glm::normalize(glm::vec3(0.35f, 0.85f, -0.38f));
  return least_slant(left) >= 0.5f || least_slant(left) >= least_slant(right) ? left : right;
}

/// A rotation that looks along `direction`: z of the result grows away from the light.
glm::mat4 light_rotation(const glm::vec3& towards_light) {
  const glm::vec3 up = std::abs(towards_light.y) > 0.999f ? glm::vec3(1, 0, 0) : glm::vec3(0, 1, 0);
  const glm::vec3 z = -towards_light;
  const glm::vec3 x = glm::normalize(glm::cross(up, z));
  const glm::vec3 y = glm::cross(z, x);
  return glm::transpose(glm::mat4(glm::mat3(x, y, z)));
}

}  // namespace

render_layout::Frame frame_block(const Model& model, const Camera& camera, int width, int height,
                                 const FrameContent& content) {
  render_layout::Frame block = {};
  block.view = camera.view();
  block.projection = camera.projection();
  block.view_projection = camera.projection() * camera.view();
  block.clip_to_world = glm::inverse(block.view_projection);
  const glm::vec3 to_sun = sun_over(model.terrain);
  block.lights[LIGHT_SUN] = light_rotation(to_sun);
  // The sky's light falls on a slope squarely, as far as shadow goes: contact darkens there, not downhill.
  glm::vec3 above(0, 1, 0);
  for (const Terrain& t : model.terrain) {
    const auto flat = terrain_row(t.shape).flat;
    if (!flat) continue;
    above = to_glm(flat(t.geometry).normal);
    break;
  }
  block.lights[LIGHT_SKY] = light_rotation(above);
  block.eye = glm::vec4(camera.eye(), camera.target_distance());
  block.viewer = camera.orthographic() ? glm::vec4(-camera.axis(), 0) : glm::vec4(camera.eye(), 1);
  block.sun = glm::vec4(to_sun, 0);
  const auto w = static_cast<float>(width), h = static_cast<float>(height);
  block.viewport = glm::vec4(w, h, 1.0f / w, 1.0f / h);
  const Color tint = content.view.color == ViewColor::material ? body_color(0) : neutral_body_color();
  const bool solid = content.view.draw.solid && content.has_flesh;
  for (std::size_t i = 0; i < 3; ++i)
    block.shadow_tint[static_cast<int>(i)] = solid ? 0.10f + 0.22f * tint[i] : 0.15f;
  block.quantity_range = quantity_scale(content.range);
  for (const Terrain& t : model.terrain) {
    if (!content.shadows || !content.view.terrain || !terrain_row(t.shape).ball ||
        block.shadow_sphere_count == MAX_SHADOW_SPHERES)
      continue;
    const Geometry<double> ball = terrain_at(t, model.simulation.timestep, content.step).geometry;
    block.shadow_spheres[block.shadow_sphere_count++] = glm::vec4(to_glm(ball.vectors[0]), ball.numbers[0]);
  }
  static_assert(COLOR_ACTUATION == static_cast<std::uint32_t>(ViewColor::actuation));
  block.color_mode = static_cast<std::uint32_t>(content.view.color);
  block.particle_count = model.particle_count();
  block.cut = glm::vec4(0, 0, 0, 1);
  if (const CutSettings& cut = content.view.cut; cut.on()) {
    block.cut = glm::vec4(to_glm((1.0 / length(cut.normal)) * cut.normal), cut.offset);
    const bool alone = cut.inside == CutInside::springs && !draws_springs(content.view.draw);
    block.section = glm::vec4(cut.offset - content.section_depth, alone ? 1.0 : 0.0,
                              cut.inside == CutInside::springs ? 1.0 : 0.0, 0);
  }
  block.see_through = content.view.draw.particles || draws_springs(content.view.draw) ? 1.0f : 0.0f;
  return block;
}

glm::vec4 quantity_scale(const QuantityRange& range) {
  const double width = range[1] - range[0];
  return {range[0], width != 0.0 ? 1.0 / width : 0.0, 0.0, 0.0};
}

render_layout::Frame frame_around(const render_layout::Frame& whole, double x, double y, double width,
                                  double height, int side) {
  assert(width > 0.0 && height > 0.0 && side >= 1);
  // The middle of the pixel, so that it is that of the small image's middle pixel.
  const glm::dvec3 middle(2.0 * (std::floor(x) + 0.5) / width - 1.0,
                          1.0 - 2.0 * (std::floor(y) + 0.5) / height, 0.0);
  const glm::dvec3 share(width / side, height / side, 1.0);
  const glm::dmat4 around = glm::translate(glm::scale(glm::dmat4(1.0), share), -middle);
  render_layout::Frame block = whole;
  block.projection = glm::mat4(around * glm::dmat4(whole.projection));
  const glm::dmat4 view_projection = around * glm::dmat4(whole.projection) * glm::dmat4(whole.view);
  block.view_projection = glm::mat4(view_projection);
  block.clip_to_world = glm::mat4(glm::inverse(view_projection));
  const auto pixels = static_cast<float>(side);
  block.viewport = glm::vec4(pixels, pixels, 1.0f / pixels, 1.0f / pixels);
  return block;
}

}  // namespace aspic
