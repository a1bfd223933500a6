#include "render/section.h"

#include <glad/gl.h>

#include <algorithm>
#include <array>
#include <utility>
#include <vector>

#include "gpu/pass.h"
#include "render/color_map.h"
#include "render/light_maps.h"

namespace aspic {
namespace {

using render_layout::SectionDraw;

constexpr std::uint32_t tetrahedra_of_cell = 6, corners = 4;
/// Cells that are looked at together at most: 4 MiB of tetrahedra if all are crossed.
constexpr std::uint32_t most_cells = (4u << 20) / (sizeof(std::uint32_t) * tetrahedra_of_cell * corners);

/// The body's full cells; 0: it is no lattice, or has no inside.
std::uint32_t cells_of(const Body& body) {
  if (body.style != SurfaceStyle::flesh || !body.lattice) return 0;
  std::size_t cells = 1;
  for (const int along : body.lattice->cells()) cells *= static_cast<std::size_t>(along);
  if (!body.lattice->all_full())
    cells = static_cast<std::size_t>(std::ranges::count(body.lattice->full_cells, true));
  return static_cast<std::uint32_t>(cells);
}

/// Local indices of the corners of each full cell, in the order that the shader has them.
std::vector<std::uint32_t> corners_of(const Lattice& lattice) {
  const std::vector<std::uint32_t> numbers = particle_numbers(lattice);
  const std::array<int, 3> cells = lattice.cells();
  std::vector<std::uint32_t> all;
  for (int i = 0; i < cells[0]; ++i)
    for (int j = 0; j < cells[1]; ++j)
      for (int k = 0; k < cells[2]; ++k)
        for (int corner = 0; corner < 8 && lattice.full({i, j, k}); ++corner)
          all.push_back(numbers[lattice.index({i + (corner & 1), j + (corner >> 1 & 1), k + (corner >> 2)})]);
  return all;
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

SectionPainter::SectionPainter(const std::shared_ptr<RenderProgram::Source>& source)
    : context_(&source->context) {
  const auto drawing = [&](std::string_view fragment, std::vector<gl::Define> defines = {}) {
    return RenderProgram(source, {"render/section.vert", fragment, "render/section.geom"},
                         std::move(defines));
  };
  crossed_ = RenderProgram(source, {.compute = "render/section.comp"});
  crossed_listed_ = RenderProgram(source, {.compute = "render/section.comp"}, {{"LISTED_CELLS", "1"}});
  color_ = drawing("render/section.frag");
  thickness_ = drawing("render/thickness.frag");
  identities_ = drawing("render/pick_section.frag", {{"PICKED", "1"}});
}

Status SectionPainter::list_cells(const Model& model) {
  const auto listed = [](const Body& body) { return cells_of(body) > 0 && !body.box(); };
  std::vector<std::pair<std::uint32_t, std::optional<Lattice>>> lattices;
  for (const Body& body : model.bodies)
    lattices.emplace_back(body.particle_count, listed(body) ? body.lattice : std::nullopt);
  if (lattices == lattices_) return {};
  std::vector<float> places;
  corners_.resize(model.bodies.size());
  for (std::size_t b = 0; b < model.bodies.size(); ++b) {
    const Body& body = model.bodies[b];
    if (!listed(body)) continue;
    const std::vector<std::uint32_t> indices = corners_of(*body.lattice);
    ASPIC_TRY(corners_[b], gl::Buffer::of(*context_, "cells of a lattice", indices));
    places.resize(std::size_t{3} * model.particle_count());
    auto at = places.begin() + std::ptrdiff_t{3} * body.first_particle;
    for (std::size_t point = 0; point < body.lattice->points(); ++point) {
      const Lattice::Place place = body.lattice->place(point);
      if (body.lattice->has_particle(place)) at = std::ranges::copy(place, at).out;
    }
  }
  places_ = {};
  if (!places.empty()) {
    ASPIC_TRY(places_, gl::Buffer::of(*context_, "places in lattices", places));
  }
  lattices_ = std::move(lattices);
  return {};
}

Status SectionPainter::prepare(const Model& model) {
  ASPIC_CHECK(list_cells(model));
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

void SectionPainter::draw_body(const RenderProgram& program, const Model& model, std::size_t number,
                               const gl::Buffer& particles) const {
  const Body& body = model.bodies[number];
  const std::uint32_t cells = cells_of(body);
  if (cells == 0) return;
  std::vector<gl::Binding> bindings = {{BINDING_PARTICLES, &particles}, {BINDING_SECTION, &tetrahedra_}};
  const RenderProgram& crossed = body.box() ? crossed_ : crossed_listed_;
  std::array<std::uint32_t, 4> size = {};
  if (body.box()) {
    std::ranges::copy(body.box()->particles, size.begin());
    crossed.set(LOCATION_LATTICE, size);
  } else {
    bindings.push_back({BINDING_SECTION_CELLS, &corners_[number]});
  }
  program.set(LOCATION_LATTICE, size);
  program.set(LOCATION_FIRST, body.first_particle);
  const gl::Pass find(crossed, bindings, gl::ReadBy::vertex_draw | gl::ReadBy::indirect);
  crossed.set(LOCATION_FIRST, body.first_particle);
  for (std::uint32_t first = 0; first < cells; first += cells_) {
    const std::uint32_t count = std::min(cells_, cells - first);
    SectionDraw empty = {};
    empty.instances = 1;
    empty.first_index = sizeof(SectionDraw) / sizeof(std::uint32_t);
    tetrahedra_.upload_items(std::span(&empty, 1));
    crossed.set(LOCATION_CELL, first);
    crossed.set(LOCATION_COUNT, count);
    find.dispatch_for(count);
    glUseProgram(program.id());
    glDrawElementsIndirect(GL_LINES_ADJACENCY, GL_UNSIGNED_INT, nullptr);
  }
}

void SectionPainter::draw(SectionUse use, const Model& model, const ModelBuffers& buffers,
                          const gl::Buffer& particles, ViewColor color) const {
  if (cells_ == 0) return;
  const RenderProgram& program = use == SectionUse::color       ? color_
                                 : use == SectionUse::thickness ? thickness_
                                                                : identities_;
  const gl::VertexArray array =
      buffers.listed_array(particles, tetrahedra_, places_.bytes() > 0 ? &places_ : nullptr);
  array.bind();
  glBindBuffer(GL_DRAW_INDIRECT_BUFFER, tetrahedra_.id());
  for (std::size_t i = 0; i < model.bodies.size(); ++i) {
    if (use == SectionUse::color)
      program.set(LOCATION_BASE_COLOR,
                  with_alpha(color == ViewColor::material ? body_color(i) : neutral_body_color(), 1.0));
    draw_body(program, model, i, particles);
  }
  glBindBuffer(GL_DRAW_INDIRECT_BUFFER, 0);
}

}  // namespace aspic
