#include "render/section.h"

#include <glad/gl.h>

#include <algorithm>
#include <array>

#include "gpu/pass.h"
#include "render/colour_map.h"
#include "render/light_maps.h"

namespace aspic {
namespace {

using render_layout::SectionDraw;

constexpr std::uint32_t tetrahedra_of_cell = 6, corners = 4;
/// Cells that are looked at together at most: 4 MiB of tetrahedra if all are crossed.
constexpr std::uint32_t most_cells = (4u << 20) / (sizeof(std::uint32_t) * tetrahedra_of_cell * corners);

/// Of a box; 0: the body is none, or has no inside.
std::uint32_t cells_of(const Body& body) {
  if (body.style != SurfaceStyle::flesh || !body.box()) return 0;
  std::uint32_t cells = 1;
  for (const int along : body.box()->cells()) cells *= static_cast<std::uint32_t>(along);
  return cells;
}

}  // namespace

DrawSettings drawn_springs(const ViewSettings& view) {
  DrawSettings draw = view.draw;
  if (view.cut.inside == CutInside::springs && !draws_springs(draw)) draw.structural = draw.shear = true;
  return draw;
}

double section_depth(const CutSettings& cut, double spacing) {
  return cut.inside == CutInside::springs ? spacing : 0.0;
}

SkinsCut::SkinsCut(const CutSettings& cut) : on_(cut.on()) {
  if (on_) glEnable(GL_CLIP_DISTANCE0);
}

SkinsCut::~SkinsCut() {
  if (on_) glDisable(GL_CLIP_DISTANCE0);
}

Result<std::unique_ptr<SectionPainter>> SectionPainter::create(gl::Context& context,
                                                               const gl::ShaderLibrary& library) {
  std::unique_ptr<SectionPainter> painter(new SectionPainter(context));
  const auto drawing = [&](std::string_view fragment, std::span<const gl::Define> defines = {}) {
    return gl::Program::graphics(context, library, {"render/section.vert", fragment, "render/section.geom"},
                                 defines);
  };
  const gl::Define picked[] = {{"PICKED", "1"}};
  ASPIC_TRY(painter->crossed_, gl::Program::compute(context, library, "render/section.comp"));
  ASPIC_TRY(painter->colour_, drawing("render/section.frag"));
  ASPIC_TRY(painter->thickness_, drawing("render/thickness.frag"));
  ASPIC_TRY(painter->identities_, drawing("render/pick_section.frag", picked));
  return painter;
}

Status SectionPainter::prepare(const Model& model) {
  std::uint32_t most = 0;
  for (const Body& body : model.bodies) most = std::max(most, cells_of(body));
  most = std::min(most, most_cells);
  if (most <= cells_) return {};
  constexpr std::uint64_t bytes_of_cell = std::uint64_t{tetrahedra_of_cell} * corners * sizeof(std::uint32_t);
  ASPIC_TRY(tetrahedra_,
            gl::Buffer::create(*context_, "cells that are cut", sizeof(SectionDraw) + bytes_of_cell * most));
  cells_ = most;
  return {};
}

void SectionPainter::draw_body(const gl::Program& program, const Body& body,
                               const gl::Buffer& particles) const {
  const std::uint32_t cells = cells_of(body);
  if (cells == 0) return;
  std::array<std::uint32_t, 4> size = {};
  std::ranges::copy(body.box()->particles, size.begin());
  const gl::Pass find(crossed_, {{BINDING_PARTICLES, &particles}, {BINDING_SECTION, &tetrahedra_}},
                      gl::ReadBy::vertex_draw | gl::ReadBy::indirect);
  for (const gl::Program* p : {&crossed_, &program}) {
    p->set(LOCATION_FIRST, body.first_particle);
    p->set(LOCATION_LATTICE, size);
  }
  for (std::uint32_t first = 0; first < cells; first += cells_) {
    const std::uint32_t count = std::min(cells_, cells - first);
    SectionDraw empty = {};
    empty.instances = 1;
    empty.first_index = sizeof(SectionDraw) / sizeof(std::uint32_t);
    tetrahedra_.upload_items(std::span(&empty, 1));
    crossed_.set(LOCATION_CELL, first);
    crossed_.set(LOCATION_COUNT, count);
    find.dispatch_for(count);
    glUseProgram(program.id());
    glDrawElementsIndirect(GL_LINES_ADJACENCY, GL_UNSIGNED_INT, nullptr);
  }
}

void SectionPainter::draw(SectionUse use, const Model& model, const ModelBuffers& buffers,
                          const gl::Buffer& particles, ViewColour colour) const {
  if (cells_ == 0) return;
  const gl::Program& program = use == SectionUse::colour      ? colour_
                               : use == SectionUse::thickness ? thickness_
                                                              : identities_;
  const gl::VertexArray array = buffers.listed_array(particles, tetrahedra_);
  array.bind();
  glBindBuffer(GL_DRAW_INDIRECT_BUFFER, tetrahedra_.id());
  for (std::size_t i = 0; i < model.bodies.size(); ++i) {
    if (use == SectionUse::colour)
      program.set(LOCATION_BASE_COLOUR,
                  with_alpha(colour == ViewColour::material ? body_colour(i) : neutral_body_colour(), 1.0));
    draw_body(program, model.bodies[i], particles);
  }
  glBindBuffer(GL_DRAW_INDIRECT_BUFFER, 0);
}

}  // namespace aspic
