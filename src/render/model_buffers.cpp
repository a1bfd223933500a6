#include "render/model_buffers.h"

#include <algorithm>
#include <array>
#include <cassert>

#include "gpu/loop_bound.h"
#include "gpu/pass.h"

namespace aspic {
namespace {

using gl::Reader;

/// Invocations that find the particles' bounds; more particles are shared out among them.
constexpr std::uint32_t most_bounding_invocations = 4096;

/// Incident springs of every particle: where each list begins, and (neighbour, class) pairs.
struct Incident {
  std::vector<std::uint32_t> start, ends;
};

Incident incident_springs(const Model& model) {
  Incident result;
  result.start.assign(std::size_t{model.particle_count()} + 1, 0);
  for (const Spring& s : model.springs) {
    ++result.start[s.a + 1];
    ++result.start[s.b + 1];
  }
  for (std::size_t i = 1; i < result.start.size(); ++i) result.start[i] += result.start[i - 1];
  std::vector<std::uint32_t> next(result.start.begin(), result.start.end() - 1);
  result.ends.resize(4 * model.springs.size());
  const auto put = [&](std::uint32_t at, std::uint32_t other, std::uint32_t spring_class) {
    const std::size_t slot = 2 * std::size_t{next[at]++};
    result.ends[slot] = other;
    result.ends[slot + 1] = spring_class;
  };
  for (const Spring& s : model.springs) {
    put(s.a, s.b, s.spring_class);
    put(s.b, s.a, s.spring_class);
  }
  return result;
}

/// The longest of the lists that begin at `start`.
std::uint64_t longest(const std::vector<std::uint32_t>& start) {
  std::uint32_t most = 0;
  for (std::size_t i = 1; i < start.size(); ++i) most = std::max(most, start[i] - start[i - 1]);
  return most;
}

/// Index pairs sorted by class, and where each class's run lies.
std::vector<std::uint32_t> spring_pairs(const Model& model, std::vector<SpringRun>& runs) {
  std::vector<std::uint32_t> count(model.spring_classes.size(), 0);
  for (const Spring& s : model.springs) count[s.spring_class] += 2;
  std::uint32_t first = 0;
  for (std::size_t c = 0; c < count.size(); ++c) {
    runs.push_back({model.spring_classes[c], false, first, count[c]});
    first += count[c];
  }
  for (const Body& body : model.bodies)
    for (std::uint32_t c = 0; c < body.class_count; ++c)
      runs[body.first_class + c].cords = body.style == SurfaceStyle::cords;
  std::vector<std::uint32_t> next;
  for (const SpringRun& run : runs) next.push_back(run.first_index);
  std::vector<std::uint32_t> pairs(first);
  for (const Spring& s : model.springs) {
    pairs[next[s.spring_class]++] = s.a;
    pairs[next[s.spring_class]++] = s.b;
  }
  return pairs;
}

}  // namespace

Result<ModelBuffers> ModelBuffers::create(gl::Context& context, const Model& model) {
  ModelBuffers b;
  b.particle_count_ = model.particle_count();
  gl::BufferFiller fill(context);
  const Surface surface = make_surface(model);
  for (const Status& ok :
       {gl::check_loop("normals", "the faces at one particle", longest(surface.fan_start)),
        gl::check_loop("bounds", "particles",
                       LIGHTS * (std::uint64_t{b.particle_count_} / most_bounding_invocations + 1))}) {
    if (!ok) return ok.error();
  }
  b.parts_ = surface.parts;
  b.coarse_parts_ = surface.coarse_parts;
  b.skin_vertices_ = static_cast<std::uint32_t>(surface.fan_vertex.size());
  fill(b.skin_indices_, "skin indices", surface.indices);
  fill(b.fan_vertex_, "skin vertices", surface.fan_vertex);
  fill(b.fan_start_, "skin fan starts", surface.fan_start);
  fill(b.fan_, "skin fans", surface.fan);

  double least = 0.0;
  for (const SpringClass& c : model.spring_classes) {
    if (c.rest_length > 0.0 && (least == 0.0 || c.rest_length < least)) least = c.rest_length;
  }
  if (least > 0.0) b.spacing_ = least;

  fill(b.normals_, "normals", std::vector<std::array<float, 4>>(b.particle_count_));
  fill(b.quantity_, "coloured quantity", std::vector<float>(b.particle_count_, 0.0f));
  fill(b.bounds_, "light bounds", std::vector<render_layout::Bounds>(LIGHTS));
  fill(b.light_boxes_, "light boxes", std::vector<render_layout::LightBox>(LIGHTS));
  if (!fill.status()) return fill.status().error();
  auto balls = BallBuffers::create(context, model);
  if (!balls) return balls.error();
  b.balls_ = std::move(*balls);
  auto rods = Rods::create(context, model);
  if (!rods) return rods.error();
  b.rods_ = std::move(*rods);
  return b;
}

Status ModelBuffers::prepare_springs(gl::Context& context, const Model& model) {
  if (springs_ready_) return {};
  gl::BufferFiller fill(context);
  std::vector<SpringRun> runs;
  fill(spring_indices_, "spring indices", spring_pairs(model, runs));
  const Incident incident = incident_springs(model);
  if (const Status ok = gl::check_loop("quantity", "the springs of one particle", longest(incident.start));
      !ok) {
    return ok;
  }
  fill(spring_start_, "incident spring starts", incident.start);
  fill(spring_ends_, "incident springs", incident.ends);
  std::vector<std::array<float, 4>> classes;
  for (const SpringClass& c : model.spring_classes) {
    classes.push_back({static_cast<float>(c.stiffness), static_cast<float>(c.damping),
                       static_cast<float>(c.rest_length), c.cord ? 1.0f : 0.0f});
  }
  fill(spring_classes_, "spring classes", classes);
  if (!fill.status()) return fill.status();
  springs_ = std::move(runs);
  springs_ready_ = true;
  return {};
}

Status ModelBuffers::upload(gl::Context& context, const Model& model, const State& state,
                            gl::Buffer& particles) {
  assert(state.position.size() == model.particle_count() && state.velocity.size() == model.particle_count());
  std::vector<std::array<float, 8>> items(state.position.size());
  const auto narrow = [](double v) { return static_cast<float>(v); };
  for (std::size_t i = 0; i < items.size(); ++i) {
    const Vec3& x = state.position[i];
    const Vec3& v = state.velocity[i];
    items[i] = {narrow(x.x), narrow(x.y), narrow(x.z), narrow(model.inverse_mass[i]),
                narrow(v.x), narrow(v.y), narrow(v.z), narrow(model.mass[i])};
  }
  const std::uint64_t bytes = std::uint64_t{particle_stride} * items.size();
  if (particles.id() == 0 || particles.bytes() < bytes) {
    auto made = gl::Buffer::create(context, "particles to draw", bytes);
    if (!made) return made.error();
    particles = std::move(*made);
  }
  particles.upload_items(std::span<const std::array<float, 8>>(items));
  return {};
}

void ModelBuffers::compute_normals(const RenderPrograms& programs, const gl::Buffer& particles) {
  programs.normals.set(LOCATION_COUNT, skin_vertices_);
  gl::Pass(programs.normals,
           {{BINDING_PARTICLES, &particles},
            {BINDING_FAN_START, &fan_start_},
            {BINDING_FAN, &fan_},
            {BINDING_FAN_VERTEX, &fan_vertex_},
            {BINDING_NORMALS, &normals_}},
           Reader::vertex_draw | Reader::read_back)
      .dispatch_for(skin_vertices_);
}

void ModelBuffers::compute_quantity(const RenderPrograms& programs, const gl::Buffer& particles) {
  gl::Pass(programs.quantity,
           {{BINDING_PARTICLES, &particles},
            {BINDING_SPRING_START, &spring_start_},
            {BINDING_SPRING_ENDS, &spring_ends_},
            {BINDING_SPRING_CLASSES, &spring_classes_},
            {BINDING_QUANTITY, &quantity_}},
           Reader::vertex_draw | Reader::read_back)
      .dispatch_for(particle_count_);
}

void ModelBuffers::compute_light_boxes(const RenderPrograms& programs, const DeviceState& state) {
  std::array<render_layout::Bounds, LIGHTS> empty;
  empty.fill({glm::uvec4(0xffffffffu), glm::uvec4(0u)});
  bounds_.upload_items(std::span<const render_layout::Bounds>(empty));
  gl::Pass(programs.bounds, {{BINDING_PARTICLES, state.particles}, {BINDING_BOUNDS, &bounds_}},
           Reader::compute_pass | Reader::copy)
      .dispatch_for(std::min(particle_count_, most_bounding_invocations));
  balls_->prepare(programs, state, bounds_);
  gl::Pass(programs.light_boxes, {{BINDING_BOUNDS, &bounds_}, {BINDING_LIGHT_BOXES_OUT, &light_boxes_}},
           Reader::uniform)
      .dispatch_for(LIGHTS);
}

gl::VertexArray ModelBuffers::array(const gl::Buffer& particles, const gl::Buffer* indices) const {
  const gl::Attribute attributes[] = {{ATTRIBUTE_POSITION, &particles, 4, particle_stride, 0},
                                      {ATTRIBUTE_VELOCITY, &particles, 4, particle_stride, 16},
                                      {ATTRIBUTE_NORMAL, &normals_, 4, 16, 0},
                                      {ATTRIBUTE_QUANTITY, &quantity_, 1, 4, 0}};
  return gl::VertexArray::create(attributes, indices);
}

}  // namespace aspic
