#include "render/moving_part.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <optional>

#include "render/camera.h"

namespace aspic {
namespace {

/// Shares of a complete image, or of two boxes, above which one box replaces them.
constexpr double nearly_whole = 0.75, nearly_joined = 1.15;

/// Looks at single points through an image's camera.
class Lens {
 public:
  explicit Lens(const render_layout::Frame& frame)
      : view_projection_(frame.view_projection),
        width_(static_cast<double>(frame.viewport.x)),
        height_(static_cast<double>(frame.viewport.y)),
        pixels_(0.5 * height_ * static_cast<double>(frame.projection[1][1])),
        nearest_(1e-3 * static_cast<double>(frame.eye.w)),
        parallel_(frame.projection[3][3] != 0.0f) {}

  gl::PixelBox whole() const { return {0, 0, static_cast<int>(width_), static_cast<int>(height_)}; }

  /// Widens the box by everything within `radius` [m] and `margin` [pixels] of the point.
  void add(const glm::dvec3& point, double radius, double margin) {
    const glm::dvec4 clip = view_projection_ * glm::dvec4(point, 1.0);
    const double w = parallel_ ? clip.w : clip.w - radius;
    if (!parallel_ && !(w > nearest_)) {
      everywhere_ = true;
      return;
    }
    // A sphere beside the line of sight looks longer, by less than the image's own angle makes it.
    const double x = clip.x / clip.w, y = clip.y / clip.w;
    const double pad = margin + radius * pixels_ / w * (1.0 + std::abs(x) + std::abs(y));
    const glm::dvec2 at(0.5 * width_ * (1.0 + x), 0.5 * height_ * (1.0 + y));
    lower_ = glm::min(lower_, at - pad);
    upper_ = glm::max(upper_, at + pad);
  }

  /// The boxes that add() has widened; starts over.
  gl::PixelBox take() {
    const auto pixel = [](double at, double most) { return static_cast<int>(std::clamp(at, 0.0, most)); };
    const gl::PixelBox box =
        everywhere_ ? whole()
                    : gl::PixelBox{pixel(std::floor(lower_.x), width_), pixel(std::floor(lower_.y), height_),
                                   pixel(std::ceil(upper_.x), width_), pixel(std::ceil(upper_.y), height_)};
    lower_ = glm::dvec2(1e300);
    upper_ = glm::dvec2(-1e300);
    everywhere_ = false;
    return box;
  }

 private:
  glm::dmat4 view_projection_;
  double width_, height_;
  double pixels_;   // of a meter at a distance of one meter
  double nearest_;  // what is nearer may lie anywhere [m]
  bool parallel_;   // sight lines, of an orthographic camera
  glm::dvec2 lower_ = glm::dvec2(1e300), upper_ = glm::dvec2(-1e300);
  bool everywhere_ = false;
};

glm::dvec3 place(const layout::vec4& v) {
  return {v.x, v.y, v.z};
}

void add(Lens& lens, const Extent& extent, double margin) {
  for (int corner = 0; corner < 8; ++corner)
    lens.add({corner & 1 ? extent.upper.x : extent.lower.x, corner & 2 ? extent.upper.y : extent.lower.y,
              corner & 4 ? extent.upper.z : extent.lower.z},
             0.0, margin);
}

/// Where a light's map falls on a plane (shaders/render/light_boxes.comp and terrain.vert).
void add_shadow(Lens& lens, const render_layout::Frame& frame, std::size_t light, const MovingThings& things,
                const FlatPart& plane) {
  const glm::dmat3 to_light(glm::mat3(frame.lights[light]));
  Extent box;
  for (const layout::Particle& p : things.particles) box.add(to_light * place(p.position));
  for (const layout::Ball& ball : things.balls) {
    if (ball.velocity.w == 0.0f) continue;
    const glm::dvec3 center = to_light * place(ball.position);
    box.add(center - static_cast<double>(ball.position.w));
    box.add(center + static_cast<double>(ball.position.w));
  }
  if (box.empty()) box.add(glm::dvec3(0.0));
  const glm::dvec3 size = box.upper - box.lower, center = 0.5 * (box.lower + box.upper);
  const double margin = light == LIGHT_SKY ? SKY_MAP_MARGIN : SUN_MAP_MARGIN;
  const double half = 1.001 * (margin * std::max(size.x, size.y) + MAP_BORDER);
  const glm::dmat3 to_world = glm::transpose(to_light);
  const glm::dvec3 towards = to_world * glm::dvec3(0, 0, -1);
  const glm::dvec3 n(plane.normal.x, plane.normal.y, plane.normal.z);
  const glm::dvec3 at(plane.point.x, plane.point.y, plane.point.z);
  const double slant = glm::dot(n, towards);
  if (slant < 0.049) return;
  for (const double x : {-half, half}) {
    for (const double y : {-half, half}) {
      const glm::dvec3 start = to_world * (center + glm::dvec3(x, y, 0.0));
      lens.add(start - glm::dot(n, start - at) / slant * towards, 0.0, things.margin);
    }
  }
}

/// Joins boxes that overlap much.
void join(std::vector<gl::PixelBox>& boxes) {
  const auto around = [](const gl::PixelBox& a, const gl::PixelBox& b) {
    return gl::PixelBox{std::min(a.left, b.left), std::min(a.bottom, b.bottom), std::max(a.right, b.right),
                        std::max(a.top, b.top)};
  };
  std::erase_if(boxes, [](const gl::PixelBox& box) { return box.empty(); });
  for (std::size_t i = 0; i < boxes.size(); ++i) {
    for (std::size_t k = i + 1; k < boxes.size(); ++k) {
      const gl::PixelBox both = around(boxes[i], boxes[k]);
      if (static_cast<double>(both.area()) >
          nearly_joined * static_cast<double>(boxes[i].area() + boxes[k].area()))
        continue;
      boxes[i] = both;
      boxes.erase(boxes.begin() + static_cast<std::ptrdiff_t>(k));
      k = i;  // the larger box may overlap others
    }
  }
}

}  // namespace

Extent extent_of(const Mesh& mesh) {
  Extent extent;
  for (const std::array<float, 4>& v : mesh.vertices) extent.add({v[0], v[1], v[2]});
  return extent;
}

std::vector<gl::PixelBox> moving_part(const render_layout::Frame& frame, const MovingThings& things) {
  Lens lens(frame);
  std::vector<gl::PixelBox> boxes;
  for (const layout::Particle& p : things.particles)
    lens.add(place(p.position), things.particle_radius, things.margin);
  boxes.push_back(lens.take());
  for (const layout::Ball& ball : things.balls)
    if (ball.velocity.w != 0.0f)
      lens.add(place(ball.position), static_cast<double>(ball.position.w), things.margin);
  boxes.push_back(lens.take());
  for (const Extent& extent : things.extents) {
    if (extent.empty()) continue;
    add(lens, extent, things.margin);
    boxes.push_back(lens.take());
  }
  for (const FlatPart& plane : things.shadowed) {
    for (std::size_t light = 0; light < LIGHTS; ++light) {
      add_shadow(lens, frame, light, things, plane);
      boxes.push_back(lens.take());
    }
  }
  join(boxes);
  std::int64_t area = 0;
  for (const gl::PixelBox& box : boxes) area += box.area();
  if (static_cast<double>(area) > nearly_whole * static_cast<double>(lens.whole().area()))
    return {lens.whole()};
  return boxes;
}

}  // namespace aspic
