#include "render/model_buffers.h"

#include <glad/gl.h>

#include <algorithm>
#include <array>
#include <bit>

#include "device/particles.h"
#include "gpu/loop_bound.h"
#include "gpu/pass.h"
#include "model/actuation.h"
#include "model/springs.h"
#include "render/software_rasterizer.h"

namespace aspic {
namespace {

using gl::ReadBy;

/// Extremes of no value at all.
constexpr std::array<std::uint32_t, EXTREMES> no_extremes = {0xffffffffu, 0u, 0xffffffffu, 0u};

/// Whether a state brings the words that name neighbors.
bool has_neighbors(const DeviceState& state) {
  return state.springs && (state.springs->kind == IncidentWords::neighbors ||
                           state.springs->kind == IncidentWords::beside_lattices);
}

/// The longest of the lists that begin at `start`.
std::uint64_t longest(const std::vector<std::uint32_t>& start) {
  std::uint32_t most = 0;
  for (std::size_t i = 1; i < start.size(); ++i) most = std::max(most, start[i] - start[i - 1]);
  return most;
}

/// Index pairs sorted by class, and where each class's run lies.
std::vector<std::uint32_t> spring_pairs(const Model& model, std::vector<SpringRun>& runs) {
  std::uint32_t first = 0;
  for (const std::uint64_t springs : springs_by_class(model)) {
    const auto indices = static_cast<std::uint32_t>(2 * springs);
    runs.push_back({model.spring_classes[runs.size()], false, first, indices});
    first += indices;
  }
  for (const Body& body : model.bodies)
    for (std::uint32_t c = 0; c < body.class_count; ++c)
      runs[body.first_class + c].cords = body.style == SurfaceStyle::cords;
  std::vector<std::uint32_t> next;
  for (const SpringRun& run : runs) next.push_back(run.first_index);
  std::vector<std::uint32_t> pairs(first);
  for (const Spring& s : springs_of(model)) {
    pairs[next[s.spring_class]++] = s.a;
    pairs[next[s.spring_class]++] = s.b;
  }
  return pairs;
}

}  // namespace

Result<ModelBuffers> ModelBuffers::create(gl::Context& context, const Model& model) {
  // Passes over images see complete states.
  ASPIC_CHECK(gl::Buffer::check_size(context, "particle state",
                                     std::uint64_t{model.particle_count()} * sizeof(layout::Particle)));
  ModelBuffers b;
  b.particle_count_ = model.particle_count();
  b.class_bits_ = class_bits(model);
  const Surface surface = make_surface(model);
  for (const Status& ok :
       {gl::check_loop("skin", "the faces at one particle", longest(surface.fan_start)),
        gl::check_loop("skin", "the triangles at one vertex of a mesh", longest(surface.mesh_start)),
        gl::check_loop(
            "bounds", "particles",
            LIGHTS * (std::uint64_t{b.particle_count_} / software::most_bounding_invocations + 1))}) {
    if (!ok) return ok.error();
  }
  b.parts_ = surface.parts;
  b.coarse_parts_ = surface.coarse_parts;
  b.mesh_vertices_ = static_cast<std::uint32_t>(surface.mesh_corners.size());
  b.skin_vertices_ = static_cast<std::uint32_t>(surface.fan_vertex.size()) + b.mesh_vertices_;
  ASPIC_TRY(b.skin_,
            gl::Buffer::create(context, "skin", sizeof(render_layout::SkinVertex) * b.skin_vertices_));
  ASPIC_TRY(b.skin_indices_, gl::Buffer::of(context, "skin indices", surface.indices));
  ASPIC_TRY(b.skin_corners_, gl::Buffer::of(context, "skin corners", surface.corners));
  ASPIC_TRY(b.fan_vertex_, gl::Buffer::of(context, "skin vertices", surface.fan_vertex));
  ASPIC_TRY(b.fan_start_, gl::Buffer::of(context, "skin fan starts", surface.fan_start));
  ASPIC_TRY(b.fan_own_, gl::Buffer::of(context, "skin fans' own ends", surface.fan_own));
  ASPIC_TRY(b.fan_, gl::Buffer::of(context, "skin fans", surface.fan));
  ASPIC_TRY(b.mesh_corners_, gl::Buffer::of(context, "mesh corners", surface.mesh_corners));
  ASPIC_TRY(b.mesh_places_, gl::Buffer::of(context, "mesh places", surface.mesh_places));
  ASPIC_TRY(b.mesh_start_, gl::Buffer::of(context, "mesh fan starts", surface.mesh_start));
  ASPIC_TRY(b.mesh_fan_, gl::Buffer::of(context, "mesh fans", surface.mesh_fan));

  double least = 0.0;
  for (const SpringClass& c : model.spring_classes) {
    if (c.rest_length > 0.0 && (least == 0.0 || c.rest_length < least)) least = c.rest_length;
  }
  if (least > 0.0) b.spacing_ = least;

  ASPIC_TRY(b.quantity_,
            gl::Buffer::of(context, "colored quantity", std::vector<float>(b.particle_count_, 0.0f)));
  ASPIC_TRY(b.extremes_, gl::Buffer::of(context, "extremes", no_extremes));
  ASPIC_TRY(b.bounds_, gl::Buffer::of(context, "light bounds", std::vector<render_layout::Bounds>(LIGHTS)));
  ASPIC_TRY(b.light_boxes_,
            gl::Buffer::of(context, "light boxes", std::vector<render_layout::LightBox>(LIGHTS)));
  ASPIC_TRY(b.balls_, BallBuffers::create(context, model));
  ASPIC_TRY(b.rods_, DeviceMesh::create(context, "rods", rod_mesh(model)));
  return b;
}

Status ModelBuffers::prepare_lines(gl::Context& context, const Model& model) {
  if (lines_ready_) return {};
  ASPIC_CHECK(check_spring_words(model));
  std::vector<SpringRun> runs;
  ASPIC_TRY(spring_indices_, gl::Buffer::of(context, "spring indices", spring_pairs(model, runs)));
  springs_ = std::move(runs);
  lines_ready_ = true;
  return {};
}

Status ModelBuffers::prepare_incident(gl::Context& context, const Model& model, const DeviceState& state) {
  if (spring_classes_.id() == 0) {
    ASPIC_CHECK(gl::check_loop("quantity", "the springs of one particle", highest_degree(model)));
    std::vector<layout::SpringClass> classes;
    for (const SpringClass& c : model.spring_classes) classes.push_back(rounded(c));
    ASPIC_TRY(spring_classes_, gl::Buffer::of(context, "spring classes", classes));
  }
  if (has_neighbors(state))
    return gl::Buffer::check_size(context, "incident springs", state.springs->incident.bytes());
  if (own_springs_) return {};
  ASPIC_TRY(own_springs_, make_spring_buffers(context, model,
                                              has_lattices(model) ? IncidentWords::beside_lattices
                                                                  : IncidentWords::neighbors));
  return {};
}

void ModelBuffers::set_rest_lengths(const Model& model, std::uint64_t step, std::span<const double> channels,
                                    bool actuation) {
  // Once it was shown the dampings have to come back.
  if (model.actuation.empty() && !actuation && !shows_actuation_) return;
  shows_actuation_ = actuation;
  const std::vector<double> lengths = rest_lengths(model, step, 0.0, channels);
  std::vector<layout::SpringClass> classes;
  for (std::size_t c = 0; c < lengths.size(); ++c) {
    SpringClass now = model.spring_classes[c];
    if (actuation) now.damping = now.rest_length;
    now.rest_length = lengths[c];
    classes.push_back(rounded(now));
    if (c < springs_.size()) springs_[c].constants = now;
  }
  if (spring_classes_.id() != 0) spring_classes_.upload_items(std::span<const layout::SpringClass>(classes));
}

void ModelBuffers::compute_skin(const RenderPrograms& programs, const gl::Buffer& particles) {
  const std::uint32_t fans = skin_vertices_ - mesh_vertices_;
  if (fans > 0) compute_fans(programs, particles);
  if (mesh_vertices_ == 0) return;
  for (const RenderProgram* const program : {&programs.mesh_skin, &programs.mesh_normals}) {
    program->set(LOCATION_COUNT, mesh_vertices_);
    program->set(LOCATION_FIRST, fans);
  }
  gl::Pass(programs.mesh_skin,
           {{BINDING_PARTICLES, &particles},
            {BINDING_SKIN_CORNERS, &mesh_corners_},
            {BINDING_SKIN_PLACES, &mesh_places_},
            {BINDING_QUANTITY, &quantity_},
            {BINDING_SKIN, &skin_}},
           ReadBy::compute_pass)
      .dispatch_for(mesh_vertices_);
  gl::Pass(programs.mesh_normals,
           {{BINDING_FAN_START, &mesh_start_}, {BINDING_FAN, &mesh_fan_}, {BINDING_SKIN, &skin_}},
           ReadBy::vertex_draw | ReadBy::read_back)
      .dispatch_for(mesh_vertices_);
}

void ModelBuffers::compute_fans(const RenderPrograms& programs, const gl::Buffer& particles) {
  programs.skin.set(LOCATION_COUNT, skin_vertices_ - mesh_vertices_);
  gl::Pass(programs.skin,
           {{BINDING_PARTICLES, &particles},
            {BINDING_FAN_START, &fan_start_},
            {BINDING_FAN, &fan_},
            {BINDING_FAN_VERTEX, &fan_vertex_},
            {BINDING_FAN_OWN, &fan_own_},
            {BINDING_QUANTITY, &quantity_},
            {BINDING_SKIN, &skin_}},
           ReadBy::vertex_draw | ReadBy::read_back)
      .dispatch_for(skin_vertices_ - mesh_vertices_);
}

void ModelBuffers::compute_quantity(const RenderPrograms& programs, const DeviceState& state) {
  extremes_.upload_items(no_extremes);
  const std::uint32_t balls = balls_->shows(state) ? balls_->count() : 0;
  programs.quantity.set(LOCATION_CLASS_BITS, class_bits_);
  programs.quantity.set(LOCATION_COUNT, balls);
  programs.quantity.set(LOCATION_FIRST, state.first_ball);
  std::vector<gl::Binding> bindings = {
      {BINDING_PARTICLES, state.particles}, {BINDING_QUANTITY, &quantity_}, {BINDING_EXTREMES, &extremes_}};
  if (balls > 0) bindings.push_back({BINDING_BALLS, state.balls});
  if (const SpringBuffers* springs = has_neighbors(state) ? state.springs : own_springs_.get()) {
    bindings.push_back({BINDING_INCIDENT_START, &springs->incident_start});
    bindings.push_back({BINDING_INCIDENT, &springs->incident});
    bindings.push_back({BINDING_LATTICES, &springs->lattices, gl::BufferKind::uniform});
    bindings.push_back({BINDING_SPRING_CLASSES, &spring_classes_});
  }
  gl::Pass(programs.quantity, std::move(bindings),
           ReadBy::compute_pass | ReadBy::vertex_draw | ReadBy::read_back)
      .dispatch_for(std::max(particle_count_, balls));
}

std::array<double, 2> ModelBuffers::extremes(bool springs) const {
  const auto found = extremes_.download_items<std::uint32_t>(EXTREMES);
  // The inverse of ordered() in shaders/render/ordered.glsl.
  const auto value = [](std::uint32_t bits) {
    const bool negative = (bits & 0x80000000u) == 0u;
    return static_cast<double>(std::bit_cast<float>(negative ? ~bits : bits & 0x7fffffffu));
  };
  std::uint32_t low = found[EXTREMES_BODIES], high = found[EXTREMES_BODIES + 1];
  if (springs) {
    low = std::min(low, found[EXTREMES_SPRINGS]);
    high = std::max(high, found[EXTREMES_SPRINGS + 1]);
  }
  if (low > high) return {1.0, 0.0};
  return {value(low), value(high)};
}

void ModelBuffers::compute_light_boxes(const RenderPrograms& programs, const DeviceState& state) {
  std::array<render_layout::Bounds, LIGHTS> empty;
  empty.fill({glm::uvec4(0xffffffffu), glm::uvec4(0u)});
  bounds_.upload_items(empty);
  gl::Pass(programs.bounds, {{BINDING_PARTICLES, state.particles}, {BINDING_BOUNDS, &bounds_}},
           ReadBy::compute_pass | ReadBy::copy)
      .dispatch_for(std::min(particle_count_, software::most_bounding_invocations));
  balls_->prepare(programs, state, bounds_);
  gl::Pass(programs.light_boxes, {{BINDING_BOUNDS, &bounds_}, {BINDING_LIGHT_BOXES_OUT, &light_boxes_}},
           ReadBy::uniform)
      .dispatch_for(LIGHTS);
}

namespace {

void draw_elements(GLenum mode, std::uint32_t first, std::uint32_t count) {
  glDrawElements(mode, static_cast<GLsizei>(count), GL_UNSIGNED_INT,
                 reinterpret_cast<const void*>(sizeof(GLuint) * std::uintptr_t{first}));
}

}  // namespace

void draw_triangles(const Surface::Part& part) {
  draw_elements(GL_TRIANGLES, part.first_index, part.index_count);
}

void draw_lines(const SpringRun& run) {
  draw_elements(GL_LINES, run.first_index, run.index_count);
}

gl::VertexArray ModelBuffers::shaded_skin_array() const {
  constexpr std::uint32_t stride = sizeof(render_layout::SkinVertex);
  const gl::Attribute attributes[] = {{ATTRIBUTE_POSITION, &skin_, 4, stride, 0},
                                      {ATTRIBUTE_NORMAL, &skin_, 4, stride, 16},
                                      {ATTRIBUTE_QUANTITY, &skin_, 1, stride, 28}};
  return gl::VertexArray::create(attributes, &skin_corners_);
}

gl::VertexArray ModelBuffers::array(const gl::Buffer& particles, const gl::Buffer* indices,
                                    const gl::Buffer* places) const {
  constexpr std::uint32_t stride = sizeof(layout::Particle);
  const gl::Attribute attributes[] = {{ATTRIBUTE_POSITION, &particles, 4, stride, 0},
                                      {ATTRIBUTE_VELOCITY, &particles, 4, stride, 16},
                                      {ATTRIBUTE_QUANTITY, &quantity_, 1, 4, 0},
                                      {ATTRIBUTE_NORMAL, places, 3, 12, 0}};
  return gl::VertexArray::create(std::span(attributes).first(places ? 4 : 3), indices);
}

}  // namespace aspic
