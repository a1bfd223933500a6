#include "render/ball_buffers.h"

#include <glad/gl.h>

#include <algorithm>
#include <array>
#include <cassert>
#include <vector>

#include "gpu/pass.h"
#include "render/color_map.h"
#include "render/layout.h"

namespace aspic {
namespace {

using gl::ReadBy;
using Four = std::array<float, 4>;

std::vector<Four> unturned(std::uint32_t count) {
  return std::vector<Four>(count, Four{0.0f, 0.0f, 0.0f, 1.0f});
}

/// White where they are footballs; else each in its own hue, after those of the bodies.
std::vector<Four> colors_of(const Model& model) {
  const bool football = std::ranges::any_of(model.bodies, &Body::footballs);
  std::vector<Four> colors;
  for (std::size_t i = 0; i < model.balls.size(); ++i) {
    const Color c = football ? Color{0.86f, 0.86f, 0.84f} : body_color(model.bodies.size() + i);
    colors.push_back({c[0], c[1], c[2], 1.0f});
  }
  return colors;
}

}  // namespace

Result<BallBuffers> BallBuffers::create(gl::Context& context, const Model& model) {
  BallBuffers b;
  b.count_ = model.ball_count();
  b.timestep_ = model.simulation.timestep;
  ASPIC_TRY(b.turns_, gl::Buffer::of(context, "turns of balls", unturned(b.count_)));
  ASPIC_TRY(b.colors_, gl::Buffer::of(context, "colors of balls", colors_of(model)));
  return b;
}

void BallBuffers::prepare(const RenderPrograms& programs, const DeviceState& state,
                          const gl::Buffer& bounds) {
  if (!shows(state)) return;
  const bool back = turned_to_ && state.step < *turned_to_;
  if (back) turns_.upload_items(unturned(count_));
  const std::uint64_t steps = turned_to_ && !back ? state.step - *turned_to_ : 0;
  turned_to_ = state.step;
  programs.balls_turn.set(LOCATION_COUNT, count_);
  programs.balls_turn.set(LOCATION_FIRST, state.first_ball);
  programs.balls_turn.set(LOCATION_ELAPSED, static_cast<float>(static_cast<double>(steps) * timestep_));
  gl::Pass(programs.balls_turn,
           {{BINDING_BALLS, state.balls}, {BINDING_TURNS, &turns_}, {BINDING_BOUNDS, &bounds}},
           ReadBy::compute_pass | ReadBy::vertex_draw | ReadBy::read_back | ReadBy::copy)
      .dispatch_for(count_);
}

void BallBuffers::set_turns(const std::vector<Four>& turns, std::uint64_t step) {
  assert(turns.size() == count_);
  turns_.upload_items(turns);
  turned_to_ = step;
}

void BallBuffers::draw(const gl::Program& program, const DeviceState& state) const {
  if (!shows(state)) return;
  constexpr std::uint32_t stride = sizeof(layout::Ball);
  const std::uint32_t first = stride * state.first_ball;
  const gl::Attribute attributes[] = {{ATTRIBUTE_POSITION, state.balls, 4, stride, first},
                                      {ATTRIBUTE_VELOCITY, state.balls, 4, stride, first + 16},
                                      {ATTRIBUTE_TURN, &turns_, 4, 16, 0},
                                      {ATTRIBUTE_COLOR, &colors_, 4, 16, 0}};
  const gl::VertexArray points = gl::VertexArray::create(attributes);
  points.bind();
  glUseProgram(program.id());
  glDrawArrays(GL_POINTS, 0, static_cast<GLsizei>(count_));
}

}  // namespace aspic
