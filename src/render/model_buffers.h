#pragma once
// A model's data on the device for drawing, and the data derived from its particles for each image.
#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "base/result.h"
#include "device/device_state.h"
#include "gpu/buffer.h"
#include "gpu/vertex_array.h"
#include "model/model.h"
#include "render/ball_buffers.h"
#include "render/layout.h"
#include "render/programs.h"
#include "render/rods.h"
#include "render/surface.h"

namespace aspic {

/// Springs of one class, as a run of index pairs.
struct SpringRun {
  SpringClass constants;
  bool cords = false;  ///< of a body whose surface is its cords
  std::uint32_t first_index = 0, index_count = 0;
};

/// Draws one body's skin, or one run of springs, from the array that is bound.
void draw_triangles(const Surface::Part& part);
void draw_lines(const SpringRun& run);

/// Buffers of one model. Their context must outlive them and be current.
class ModelBuffers {
 public:
  /// Error (scene_rejected): no device memory, or larger than the device's buffers.
  static Result<ModelBuffers> create(gl::Context& context, const Model& model);

  /// What drawing springs needs; many images do without. Does nothing the second time. `model` as in
  /// create(). Error (scene_rejected): no device memory.
  Status prepare_lines(gl::Context& context, const Model& model);
  /// What colors by strain or force need: a particle's springs, those of `state` where it has them. Errors:
  /// as make_spring_buffers; no_device (more springs at one particle than a kernel may loop over).
  Status prepare_incident(gl::Context& context, const Model& model, const DeviceState& state);
  /// Gives springs their rest lengths at a step, with these numbers in the inputs' channels, and in the place
  /// of their damping those without actuation where a color shows `actuation`. After both of the above; does
  /// nothing where no rest length changes and none is shown.
  void set_rest_lengths(const Model& model, std::uint64_t step, std::span<const double> channels,
                        bool actuation);

  /// The vertices of the skin at these particles' positions, with what compute_quantity() found before.
  void compute_skin(const RenderPrograms& programs, const gl::Buffer& particles);
  /// The colored quantity of each particle; the frame block must be bound. Strain and force want
  /// prepare_incident() with the same state before.
  void compute_quantity(const RenderPrograms& programs, const DeviceState& state);
  /// Waits for the device: least and largest value that compute_quantity() found on particles and launched
  /// balls, and on springs too if they are shown. The first is larger where there was none.
  std::array<double, 2> extremes(bool springs) const;
  /// The map of each light, fitted to particles and balls, and the turn of each ball; the frame block must be
  /// bound.
  void compute_light_boxes(const RenderPrograms& programs, const DeviceState& state);

  /// Turns the balls as they were found to be at this step.
  void set_ball_turns(const std::vector<std::array<float, 4>>& turns, std::uint64_t step) {
    balls_->set_turns(turns, step);
  }

  /// Inputs of the skin's shaders, of those that need positions of it alone, and of the particles' and the
  /// springs'.
  gl::VertexArray shaded_skin_array() const;
  gl::VertexArray skin_array(const gl::Buffer& particles) const { return array(particles, &skin_indices_); }
  gl::VertexArray particle_array(const gl::Buffer& particles) const { return array(particles, nullptr); }
  /// The particles that a buffer of 32-bit indices names; `places`, unless null: three floats of each, as
  /// ATTRIBUTE_NORMAL.
  gl::VertexArray listed_array(const gl::Buffer& particles, const gl::Buffer& indices,
                               const gl::Buffer* places = nullptr) const {
    return array(particles, &indices, places);
  }
  gl::VertexArray spring_array(const gl::Buffer& particles) const {
    return array(particles, &spring_indices_);
  }

  std::uint32_t particle_count() const { return particle_count_; }
  /// The skin of each body, as use_coarse_skin() says.
  const std::vector<Surface::Part>& parts() const { return coarse_ ? coarse_parts_ : parts_; }
  /// From now on skins of fewer triangles, where a body has many.
  void use_coarse_skin(bool coarse) { coarse_ = coarse; }
  const BallBuffers& balls() const { return *balls_; }
  const DeviceMesh& rods() const { return rods_; }
  /// Empty before prepare_lines().
  const std::vector<SpringRun>& springs() const { return springs_; }
  /// Typical distance between neighbors [m]; 1 without springs.
  double spacing() const { return spacing_; }
  const gl::Buffer& light_boxes() const { return light_boxes_; }
  /// SkinVertex each, in the order of Surface::fan_vertex, then of Surface::mesh_corners.
  const gl::Buffer& skin() const { return skin_; }
  const gl::Buffer& quantity() const { return quantity_; }

 private:
  ModelBuffers() = default;
  void compute_fans(const RenderPrograms& programs, const gl::Buffer& particles);
  gl::VertexArray array(const gl::Buffer& particles, const gl::Buffer* indices,
                        const gl::Buffer* places = nullptr) const;

  std::uint32_t particle_count_ = 0, skin_vertices_ = 0, mesh_vertices_ = 0, class_bits_ = 0;
  double spacing_ = 1.0;
  std::vector<Surface::Part> parts_, coarse_parts_;
  bool coarse_ = false, lines_ready_ = false, shows_actuation_ = false;
  std::optional<BallBuffers> balls_;
  DeviceMesh rods_;
  std::vector<SpringRun> springs_;
  gl::Buffer skin_, skin_indices_, skin_corners_, fan_vertex_, fan_start_, fan_own_, fan_;
  gl::Buffer mesh_corners_, mesh_places_, mesh_start_, mesh_fan_;
  gl::Buffer spring_indices_, spring_classes_;
  std::shared_ptr<const SpringBuffers> own_springs_;  // for states that bring none
  gl::Buffer quantity_, extremes_, bounds_, light_boxes_;
};

}  // namespace aspic
