#include "render/overlay.h"

#include <glad/gl.h>

#include <algorithm>
#include <cmath>

#include "gpu/vertex_array.h"
#include "render/axes.h"
#include "render/layout.h"

namespace aspic {
namespace {

// In heights of the text.
constexpr float margin = 0.9f;
constexpr float padding = 0.75f;
constexpr float column_gap = 0.9f;
constexpr float corner = 0.55f;
constexpr float bar_width = 15.0f;
constexpr float bar_height = 0.75f;

constexpr std::array<float, 4> bright = {0.93f, 0.95f, 0.97f, 1.0f};
constexpr std::array<float, 4> dim = {0.42f, 0.49f, 0.57f, 1.0f};
constexpr std::array<float, 4> alarming = {0.95f, 0.30f, 0.12f, 1.0f};
constexpr std::array<float, 4> backdrop = {0.006f, 0.009f, 0.014f, 0.66f};

constexpr float glyph_shape = 0.0f, panel_shape = 1.0f, scale_shape = 2.0f;

}  // namespace

FactsPanel facts_panel(const Font& font, const std::vector<OverlayLine>& lines) {
  const auto em = static_cast<float>(font.pixel_height());
  const auto step = static_cast<float>(font.line_height());
  float labels = 0.0f, values = 0.0f;
  for (const OverlayLine& line : lines) {
    labels = std::max(labels, font.width_of(line.label));
    values = std::max(values, font.width_of(line.value));
  }
  if (labels > 0.0f) labels += column_gap * em;
  const float left = std::round(margin * em), inset = std::round(padding * em);
  return {left, left, std::ceil(labels + values) + 2 * inset,
          static_cast<float>(lines.size()) * step + 2 * inset - (step - em), labels};
}

int text_height_in(int image_height) {
  return std::clamp(static_cast<int>(std::lround(image_height / 42.0)), 11, 256);
}

std::vector<OverlayLine> fitted_lines(const std::vector<OverlayLine>& lines, float room,
                                      const std::function<float(std::string_view)>& width) {
  std::vector<OverlayLine> result;
  for (const OverlayLine& line : lines) {
    OverlayLine part = line;
    part.label.clear();
    std::string_view rest = line.label;
    while (!rest.empty()) {
      const std::string_view word = rest.substr(0, rest.find(' '));
      rest.remove_prefix(std::min(word.size() + 1, rest.size()));
      const std::string longer = (part.label.empty() ? "" : part.label + " ") + std::string(word);
      if (part.label.empty() || width(longer) <= room) {
        part.label = longer;
        continue;
      }
      result.push_back({part.label, "", line.alarm, line.tint});
      part.label = word;
    }
    result.push_back(part);
  }
  return result;
}

Status OverlayPainter::prepare_font(int pixel_height) {
  if (font_ && font_->pixel_height() == pixel_height) return {};
  auto font = std::make_unique<Font>(pixel_height);
  ASPIC_TRY(auto texture, gl::Texture::create(*context_, "glyphs",
                                              {.format = gl::TexelFormat::r8,
                                               .width = font->atlas_width(),
                                               .height = font->atlas_height()}));
  texture.upload(font->atlas());
  glyphs_ = std::move(texture);
  font_ = std::move(font);
  return {};
}

void OverlayPainter::rectangle(float x, float y, float width, float height, const std::array<float, 4>& uv,
                               const std::array<float, 4>& tint, const std::array<float, 4>& shape) {
  const auto vertex = [&](bool right, bool low) {
    pending_.push_back(
        {{x + (right ? width : 0.0f), y + (low ? height : 0.0f), right ? uv[2] : uv[0], low ? uv[3] : uv[1]},
         tint,
         shape});
  };
  for (const auto& [right, low] :
       {std::pair(false, false), {false, true}, {true, false}, {true, false}, {false, true}, {true, true}})
    vertex(right, low);
}

void OverlayPainter::panel(float x, float y, float width, float height, float opacity) {
  const float w = 0.5f * width, h = 0.5f * height;
  const auto em = static_cast<float>(font_->pixel_height());
  rectangle(x, y, width, height, {-w, -h, w, h}, {backdrop[0], backdrop[1], backdrop[2], opacity},
            {panel_shape, w, h, corner * em});
}

void OverlayPainter::text(float x, float y, std::string_view utf8, const std::array<float, 4>& tint) {
  float pen = x;
  const float baseline = std::round(y) + static_cast<float>(font_->ascent());
  while (!utf8.empty()) {
    const Glyph& g = font_->glyph(next_character(utf8));
    const float left = std::round(pen) + static_cast<float>(g.left);
    const auto u = static_cast<float>(g.atlas_x), v = static_cast<float>(g.atlas_y);
    const auto w = static_cast<float>(g.width), h = static_cast<float>(g.height);
    if (g.width > 0)
      rectangle(left, baseline + static_cast<float>(g.top), w, h, {u, v, u + w, v + h}, tint,
                {glyph_shape, 0, 0, 0});
    pen += g.advance;
  }
}

void OverlayPainter::facts(const std::vector<OverlayLine>& all, float image_width) {
  const auto em = static_cast<float>(font_->pixel_height());
  float widest_value = 0.0f;
  for (const OverlayLine& line : all) widest_value = std::max(widest_value, font_->width_of(line.value));
  const std::vector<OverlayLine> lines =
      fitted_lines(all, image_width - widest_value - (2.0f * (margin + padding) + column_gap) * em,
                   [this](std::string_view label) { return font_->width_of(label); });
  const FactsPanel box = facts_panel(*font_, lines);
  // Colors are darker than the text that the usual backdrop is for.
  const bool tinted =
      std::ranges::any_of(lines, [](const OverlayLine& line) { return line.tint.has_value(); });
  panel(box.left, box.top, box.width, box.height, tinted ? 0.92f : backdrop[3]);
  const float inset = std::round(padding * em);
  const float x = box.left + inset;
  float y = box.top + inset;
  for (const OverlayLine& line : lines) {
    const std::array<float, 4> own = line.tint ? with_alpha(*line.tint, 1.0) : dim;
    text(x, y, line.label, line.alarm ? alarming : own);
    text(x + box.labels, y, line.value, line.alarm ? alarming : bright);
    y += static_cast<float>(font_->line_height());
  }
}

float OverlayPainter::scale(const Legend& legend, float image_width, float bottom) {
  const auto em = static_cast<float>(font_->pixel_height());
  const auto step = static_cast<float>(font_->line_height());
  const float inset = std::round(padding * em);
  const bool bar = legend.entries.empty();
  float width = font_->width_of(legend.title);
  for (const Legend::Entry& entry : legend.entries)
    width = std::max(width, 1.6f * em + font_->width_of(entry.name));
  if (bar) width = std::max(width, bar_width * em);
  width = std::ceil(width);
  const float rows = 1.0f + (bar ? 1.0f : static_cast<float>(legend.entries.size()));
  const float height =
      rows * step + (bar ? std::round((bar_height + 0.3f) * em) : 0.0f) + 2 * inset - (step - em);
  const float left = std::round(image_width - margin * em - width - 2 * inset);
  const float top = std::round(bottom - margin * em - height);
  panel(left, top, width + 2 * inset, height, backdrop[3]);
  const float x = left + inset;
  float y = top + inset;
  text(x, y, legend.title, bright);
  y += step;
  for (const Legend::Entry& entry : legend.entries) {
    const float size = std::round(0.8f * em);
    const std::array<float, 4> tint = {entry.color[0], entry.color[1], entry.color[2], 1.0f};
    const float h = 0.5f * size;
    rectangle(x, y + std::round(0.12f * em), size, size, {-h, -h, h, h}, tint,
              {panel_shape, h, h, 0.25f * size});
    text(x + 1.6f * em, y, entry.name, bright);
    y += step;
  }
  const float taken = bottom - top;
  if (!bar) return taken;
  rectangle(x, y, width, std::round(bar_height * em), {0, 0, 1, 0}, bright, {scale_shape, 0, 0, 0});
  y += std::round((bar_height + 0.3f) * em);
  text(x, y, legend.marks[0], bright);
  text(x + 0.5f * (width - font_->width_of(legend.marks[1])), y, legend.marks[1], bright);
  text(x + width - font_->width_of(legend.marks[2]), y, legend.marks[2], bright);
  return taken;
}

void OverlayPainter::line(const std::array<float, 2>& from, const std::array<float, 2>& to, float width,
                          const std::array<float, 4>& tint) {
  const float dx = to[0] - from[0], dy = to[1] - from[1], size = std::hypot(dx, dy);
  const float r = 0.5f * width, half = 0.5f * size + r;
  const float ux = size > 0.0f ? dx / size : 1.0f, uy = size > 0.0f ? dy / size : 0.0f;
  const float x = 0.5f * (from[0] + to[0]), y = 0.5f * (from[1] + to[1]);
  // Turned about its middle, with a pixel around it to fade in.
  const auto vertex = [&](float along, float aside) {
    const float a = along * (half + 1.0f), b = aside * (r + 1.0f);
    pending_.push_back({{x + a * ux - b * uy, y + a * uy + b * ux, a, b}, tint, {panel_shape, half, r, r}});
  };
  for (const auto& [along, aside] :
       {std::pair(-1.0f, -1.0f), {-1.0f, 1.0f}, {1.0f, -1.0f}, {1.0f, -1.0f}, {-1.0f, 1.0f}, {1.0f, 1.0f}})
    vertex(along, aside);
}

void OverlayPainter::axes(const Camera& camera, float image_width) {
  const auto em = static_cast<float>(font_->pixel_height());
  const float reach = static_cast<float>(axes_reach) * em;
  const std::array<float, 2> middle = {image_width - margin * em - reach, margin * em + reach};
  line(middle, middle, 2.0f * reach, {backdrop[0], backdrop[1], backdrop[2], 0.45f});
  for (const AxisArm& arm : axes_seen(camera)) {
    const auto at = [&](double share) {
      const auto length = static_cast<float>(share * axis_length) * em;
      return std::array{middle[0] + static_cast<float>(arm.right) * length,
                        middle[1] + static_cast<float>(arm.down) * length};
    };
    line(middle, at(1.0), static_cast<float>(axis_width) * em, with_alpha(arm.color, 1.0));
    const std::array<float, 2> letter = at(axis_letter_at);
    const std::string_view word(&arm.letter, 1);
    text(letter[0] - 0.5f * font_->width_of(word), letter[1] - 0.5f * em, word, bright);
  }
}

Status OverlayPainter::draw(const gl::Framebuffer& image, const std::vector<OverlayLine>& lines,
                            std::span<const Legend> legends, const Camera* camera, int text_height) {
  if (lines.empty() && !camera && std::ranges::all_of(legends, &Legend::empty)) return {};
  ASPIC_CHECK(
      prepare_font(text_height > 0 ? std::clamp(text_height, 11, 256) : text_height_in(image.height())));
  pending_.clear();
  if (!lines.empty()) facts(lines, static_cast<float>(image.width()));
  auto bottom = static_cast<float>(image.height());
  for (const Legend& legend : legends)
    if (!legend.empty()) bottom -= scale(legend, static_cast<float>(image.width()), bottom);
  if (camera) axes(*camera, static_cast<float>(image.width()));

  const std::uint64_t bytes = pending_.size() * sizeof(Vertex);
  if (vertices_.bytes() < bytes) {
    ASPIC_TRY(vertices_, gl::Buffer::create(*context_, "overlay", 2 * bytes));
  }
  vertices_.upload_items(pending_);
  const gl::Attribute attributes[] = {{0, &vertices_, 4, sizeof(Vertex), 0},
                                      {1, &vertices_, 4, sizeof(Vertex), 16},
                                      {2, &vertices_, 4, sizeof(Vertex), 32}};
  const gl::VertexArray array = gl::VertexArray::create(attributes);
  image.bind();
  array.bind();
  glUseProgram(program_.id());
  glyphs_.bind(UNIT_GLYPHS);
  glDisable(GL_DEPTH_TEST);
  glDisable(GL_CULL_FACE);
  glEnable(GL_BLEND);
  glBlendFunc(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA);
  glDrawArrays(GL_TRIANGLES, 0, static_cast<GLsizei>(pending_.size()));
  glDisable(GL_BLEND);
  glBindVertexArray(0);
  return {};
}

}  // namespace aspic
