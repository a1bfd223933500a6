#include "render/arrows.h"

#include <fmt/format.h>
#include <glad/gl.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "render/layout.h"
#include "render/mesh.h"
#include "render/overlay_text.h"
#include "render/quantity.h"

namespace aspic {
namespace {

struct ArrowRow {
  ArrowKind kind;
  bool ArrowSettings::*wanted;
  Color color;
  std::string_view name;
};
constexpr ArrowRow rows[] = {
    {ArrowKind::normal, &ArrowSettings::contacts, {0.95f, 0.95f, 0.95f}, "contact normal"},
    {ArrowKind::contact, &ArrowSettings::contacts, {1.00f, 0.33f, 0.02f}, "contact force"},
    {ArrowKind::springs, &ArrowSettings::springs, {0.30f, 0.10f, 0.95f}, "springs"},
    {ArrowKind::external, &ArrowSettings::external, {0.22f, 0.60f, 0.04f}, "gravity and pull"},
    {ArrowKind::net, &ArrowSettings::net, {1.00f, 0.75f, 0.04f}, "net force"},
};

/// Normals show a direction alone.
constexpr double normal_share = 0.15;  // of the room

/// A point as the vertex shader takes it.
struct Vertex {
  std::array<float, 4> from, along, color;
};

/// A length and its unit, the largest of m, cm, mm that is not above `room`.
std::pair<double, std::string_view> round_length(double room) {
  for (const auto& unit : {std::pair<double, std::string_view>{1.0, "m"}, {0.01, "cm"}})
    if (room >= unit.first) return unit;
  return {0.001, "mm"};
}

}  // namespace

double arrow_scale(const ViewSettings& view, const ArrowSet& set) {
  if (view.arrow_scale) return *view.arrow_scale;
  double largest = 0.0;
  for (const Arrow& arrow : set.arrows)
    if (arrow.kind != ArrowKind::normal) largest = std::max(largest, length(arrow.value));
  return largest > set.noise && std::isfinite(largest) ? round_up(largest / set.room) : 0.0;
}

Legend arrow_legend(const ViewSettings& view, const ArrowSet& set) {
  Legend legend;
  if (!view.arrows.any()) return legend;
  const double scale = arrow_scale(view, set);
  const auto [unit, name] = round_length(set.room);
  legend.title =
      scale > 0.0 ? fmt::format("arrows: 1 {} = {} N", name, short_number(unit * scale)) : "arrows";
  for (const ArrowRow& row : rows)
    if (view.arrows.*row.wanted) legend.entries.push_back({row.color, std::string(row.name)});
  return legend;
}

ArrowPainter::ArrowPainter(const std::shared_ptr<RenderProgram::Source>& source)
    : context_(&source->context),
      program_(source, {"render/arrows.vert", "render/arrows.frag", "render/arrows.geom"}) {}

Status ArrowPainter::draw(const ViewSettings& view, const ArrowSet& set) {
  const double scale = arrow_scale(view, set);
  std::vector<Vertex> vertices;
  for (const Arrow& arrow : set.arrows) {
    const bool normal = arrow.kind == ArrowKind::normal;
    if (!normal && !(scale > 0.0)) continue;
    const Vec3 along = (normal ? normal_share * set.room : 1.0 / scale) * arrow.value;
    const Color& c = std::ranges::find(rows, arrow.kind, &ArrowRow::kind)->color;
    vertices.push_back({four(arrow.from, 1.0), four(along, normal ? 0.0 : 1.0), {c[0], c[1], c[2], 1.0f}});
  }
  if (vertices.empty()) return {};
  const std::uint64_t bytes = sizeof(Vertex) * vertices.size();
  if (vertices_.bytes() < bytes) {
    ASPIC_TRY(vertices_, gl::Buffer::create(*context_, "arrows", 2 * bytes));
  }
  vertices_.upload_items(vertices);
  const gl::Attribute attributes[] = {{ATTRIBUTE_POSITION, &vertices_, 4, sizeof(Vertex), 0},
                                      {ATTRIBUTE_VELOCITY, &vertices_, 4, sizeof(Vertex), 16},
                                      {ATTRIBUTE_COLOR, &vertices_, 4, sizeof(Vertex), 32}};
  const gl::VertexArray array = gl::VertexArray::create(attributes);
  array.bind();
  glUseProgram(program_.id());
  glEnable(GL_BLEND);
  glBlendFunc(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA);
  glDepthMask(GL_FALSE);
  for (const bool hidden : {true, false}) {
    glDepthFunc(hidden ? GL_GREATER : GL_LEQUAL);
    program_.set(LOCATION_BASE_COLOR, std::array{1.0f, 1.0f, 1.0f, hidden ? 0.40f : 1.0f});
    glDrawArrays(GL_POINTS, 0, static_cast<GLsizei>(vertices.size()));
  }
  glDepthMask(GL_TRUE);
  glDisable(GL_BLEND);
  return {};
}

}  // namespace aspic
