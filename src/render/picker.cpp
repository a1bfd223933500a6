#include "render/picker.h"

#include <glad/gl.h>

#include <bit>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include "model/terrain.h"
#include "render/frame_block.h"
#include "render/light_maps.h"
#include "render/terrain_painter.h"

namespace aspic {
namespace {

/// A pixel of the image.
struct Word {
  std::uint32_t identity = 0, distance = 0;
};

/// The point at a distance along the axis, seen in the middle of a pixel of the image [pixels from left and
/// bottom].
Vec3 point_at(const render_layout::Frame& frame, int column, int row, int side, double distance) {
  const glm::dmat4 projection(frame.projection);
  const double x = 2.0 * (column + 0.5) / side - 1.0, y = 2.0 * (row + 0.5) / side - 1.0;
  // Of clip space: the distance itself, or 1 in an orthographic image.
  const double w = projection[3][3] - projection[2][3] * distance;
  const glm::dvec4 in_view((x * w + projection[2][0] * distance - projection[3][0]) / projection[0][0],
                           (y * w + projection[2][1] * distance - projection[3][1]) / projection[1][1],
                           -distance, 1.0);
  const glm::dvec4 world = glm::inverse(glm::dmat4(frame.view)) * in_view;
  return {world.x, world.y, world.z};
}

}  // namespace

Result<std::unique_ptr<Picker>> Picker::create(const std::shared_ptr<RenderProgram::Source>& source) {
  gl::Context& context = source->context;
  std::unique_ptr<Picker> p(new Picker(context));
  p->surface_ = RenderProgram(
      source, {"render/pick_surface.vert", "render/pick_surface.frag", "render/pick_surface.geom"});
  p->particles_ = RenderProgram(
      source, {"render/particles.vert", "render/pick_particles.frag", "render/pick_particles.geom"});
  p->balls_ = RenderProgram(source, {"render/balls.vert", "render/pick_balls.frag", "render/balls.geom"});
  p->terrain_ = RenderProgram(source, {"render/screen.vert", "render/pick_terrain.frag"});
  ASPIC_TRY(p->frame_,
            gl::Buffer::create(context, "pick frame", sizeof(render_layout::Frame), gl::BufferKind::uniform));
  ASPIC_TRY(p->image_,
            DrawableImage::create(context, "identities",
                                  {.format = gl::TexelFormat::rg32ui, .width = side, .height = side}, true));
  p->nothing_ = gl::VertexArray::without_inputs(context);
  for (Slot& slot : p->slots_) {
    slot.buffer = gl::pixel_buffer(context, sizeof(Word) * side * side);
  }
  return p;
}

void Picker::forget() {
  for (Slot& slot : slots_) slot.fence.reset();
  pending_ = 0;
  answer_ = {};
}

void Picker::draw_terrain(const Model& model, std::uint64_t step) const {
  nothing_.bind();
  glUseProgram(terrain_.id());
  for (std::size_t i = 0; i < model.terrain.size(); ++i) {
    terrain_.set(LOCATION_FIRST, static_cast<std::uint32_t>(i));
    set_terrain(terrain_, terrain_at(model.terrain[i], model.simulation.timestep, step));
    glDrawArrays(GL_TRIANGLES, 0, 3);
  }
}

void Picker::draw_image(const Model& model, const ModelBuffers& buffers, const DeviceState& state,
                        const ViewSettings& view, const SectionPainter* section) const {
  const DrawSettings& draw = view.draw;
  if (view.terrain) draw_terrain(model, state.step);
  if (draws_balls(draw) && buffers.balls().shows(state)) buffers.balls().draw(balls_, state);
  if (section) section->draw(SectionUse::identities, model, buffers, *state.particles, view.color);
  if (!draw.solid && !draw.particles && !draws_springs(drawn_springs(view))) return;
  const float radius =
      static_cast<float>(draw.particles ? particle_radius(buffers.spacing())
                                        : spring_radius(buffers.spacing(), SpringType::structural));
  particles_.set(LOCATION_RADIUS, radius);
  const gl::VertexArray skin = buffers.skin_array(*state.particles);
  const gl::VertexArray points = buffers.particle_array(*state.particles);
  for (std::size_t i = 0; i < model.bodies.size(); ++i) {
    const Surface::Part& part = buffers.parts()[i];
    const Body& body = model.bodies[i];
    if (draw.solid && part.index_count > 0) {
      glUseProgram(surface_.id());
      skin.bind();
      const SkinsCut cut(view.cut);
      draw_triangles(part);
    } else {
      particles_.set(LOCATION_FIRST, body.first_particle);
      glUseProgram(particles_.id());
      points.bind();
      glDrawArrays(GL_POINTS, static_cast<GLint>(body.first_particle),
                   static_cast<GLsizei>(body.particle_count));
    }
  }
}

void Picker::submit(std::uint64_t request, const Model& model, const ModelBuffers& buffers,
                    const DeviceState& state, const ViewSettings& view, const SectionPainter* section,
                    const render_layout::Frame& frame, const PickPlace& place) {
  // With all of them under way the newest gives way: only the last place of the cursor counts.
  if (pending_ == capacity) --pending_;
  Slot& slot = slots_[(first_ + pending_) % capacity];
  slot.request = request;
  slot.frame = frame_around(frame, place.x, place.y, place.width, place.height, side);
  frame_.upload_items(std::span(&slot.frame, 1));
  frame_.bind(gl::BufferKind::uniform, BINDING_FRAME);

  image_.framebuffer.bind();
  const GLuint none[4] = {0, 0, 0, 0};
  const GLfloat far = 1.0f;
  glDepthMask(GL_TRUE);
  glEnable(GL_DEPTH_TEST);
  glDepthFunc(GL_LESS);
  glDisable(GL_BLEND);
  glClearBufferuiv(GL_COLOR, 0, none);
  glClearBufferfv(GL_DEPTH, 0, &far);
  draw_image(model, buffers, state, view, section);
  glDisable(GL_DEPTH_TEST);
  glBindVertexArray(0);
  glUseProgram(0);

  glBindBuffer(GL_PIXEL_PACK_BUFFER, slot.buffer.id());
  glReadPixels(0, 0, side, side, GL_RG_INTEGER, GL_UNSIGNED_INT, nullptr);
  glBindBuffer(GL_PIXEL_PACK_BUFFER, 0);
  glBindFramebuffer(GL_FRAMEBUFFER, 0);
  slot.fence = gl::fence(context_);
  ++pending_;
}

const PickAnswer& Picker::answer() {
  while (pending_ > 0) {
    Slot& slot = slots_[first_];
    const GLenum state = glClientWaitSync(static_cast<GLsync>(slot.fence.get()), 0, 0);
    if (state != GL_ALREADY_SIGNALED && state != GL_CONDITION_SATISFIED) break;
    slot.fence.reset();
    first_ = (first_ + 1) % capacity;
    --pending_;
    read(slot);
  }
  return answer_;
}

void Picker::read(Slot& slot) {
  glBindBuffer(GL_PIXEL_PACK_BUFFER, slot.buffer.id());
  std::array<Word, std::size_t{side} * side> words;
  glGetBufferSubData(GL_PIXEL_PACK_BUFFER, 0, GLsizeiptr{sizeof(words)}, words.data());
  glBindBuffer(GL_PIXEL_PACK_BUFFER, 0);
  answer_ = {slot.request, std::nullopt};
  int nearest = pick_reach * pick_reach;
  for (int row = 0; row < side; ++row) {
    for (int column = 0; column < side; ++column) {
      const Word& word =
          words[static_cast<std::size_t>(row) * std::size_t{side} + static_cast<std::size_t>(column)];
      const std::uint32_t kind = word.identity >> PICK_KIND_SHIFT;
      const int right = column - pick_reach, up = row - pick_reach;
      const int off = right * right + up * up;
      // Terrain fills what it fills: only the very place counts, and only if nothing else is near.
      const bool counts = kind == PICK_TERRAIN ? off == 0 && !answer_.what : kind != 0u;
      if (!counts || off > nearest) continue;
      const auto distance = static_cast<double>(std::bit_cast<float>(word.distance));
      const bool over_terrain = answer_.what && answer_.what->kind == PickKind::terrain;
      if (off == nearest && answer_.what && !over_terrain && distance >= answer_.what->distance) continue;
      if (kind != PICK_TERRAIN) nearest = off;
      answer_.what = Picked{static_cast<PickKind>(kind), word.identity & ((1u << PICK_KIND_SHIFT) - 1u),
                            point_at(slot.frame, column, row, side, distance), distance};
    }
  }
}

}  // namespace aspic
