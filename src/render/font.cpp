#include "render/font.h"

#include <cassert>
#include <cmath>
#include <cstddef>
#include <new>
#include <span>

// Compiled here rather than linked from libstb, which leaves out a glyph for which there is no memory: here
// that is an exception.
#define STB_TRUETYPE_IMPLEMENTATION
#define STBTT_STATIC
#define STBTT_malloc(size, context) ((void)(context), ::operator new(size))
#define STBTT_free(memory, context) ((void)(context), ::operator delete(memory))
#include <stb_truetype.h>

#include "base/embedded_file.h"
#include "base/printable.h"

namespace aspic {

std::span<const EmbeddedFile> embedded_fonts();  // generated: one

namespace {

std::vector<char32_t> character_set() {
  std::vector<char32_t> set;
  for (char32_t c = 0x20; c <= 0x7e; ++c) set.push_back(c);
  for (char32_t c = 0xa0; c <= 0x17f; ++c) set.push_back(c);
  for (char32_t c = 0x386; c <= 0x3ce; ++c) set.push_back(c);
  for (char32_t c = 0x400; c <= 0x45f; ++c) set.push_back(c);
  for (const char32_t c : U"ȘșȚțẞґҐ‘’“”„−–—…≤≥∞√≈₀₁₂ₜ") {
    if (c != 0) set.push_back(c);
  }
  return set;
}

}  // namespace

char32_t next_character(std::string_view& text) {
  const Utf8Character c = first_character(text);
  text.remove_prefix(c.size);
  return c.valid ? c.code : 0xfffd;
}

Font::Font(int pixel_height) : pixel_height_(pixel_height) {
  assert(pixel_height >= 6 && pixel_height <= 256);
  stbtt_fontinfo info;
  const auto* file = reinterpret_cast<const unsigned char*>(embedded_fonts().front().text.data());
  [[maybe_unused]] const int read = stbtt_InitFont(&info, file, stbtt_GetFontOffsetForIndex(file, 0));
  assert(read != 0);
  const float scale = stbtt_ScaleForPixelHeight(&info, static_cast<float>(pixel_height));
  int ascent = 0, descent = 0, gap = 0;
  stbtt_GetFontVMetrics(&info, &ascent, &descent, &gap);
  ascent_ = static_cast<int>(std::lround(scale * static_cast<float>(ascent)));
  line_height_ = static_cast<int>(std::lround(1.22f * static_cast<float>(pixel_height)));

  // Shelves: rows of glyphs of a common height, in a sheet of fixed width.
  const std::vector<char32_t> set = character_set();
  atlas_width_ = 32 * pixel_height;
  const int shelf = pixel_height + pixel_height / 2;
  int x = 0, y = 0;
  for (const char32_t character : set) {
    Glyph glyph;
    int x0 = 0, y0 = 0, x1 = 0, y1 = 0, advance = 0, bearing = 0;
    const int index = stbtt_FindGlyphIndex(&info, static_cast<int>(character));
    stbtt_GetGlyphBitmapBox(&info, index, scale, scale, &x0, &y0, &x1, &y1);
    stbtt_GetGlyphHMetrics(&info, index, &advance, &bearing);
    glyph.width = x1 - x0;
    glyph.height = y1 - y0;
    glyph.left = x0;
    glyph.top = y0;
    glyph.advance = scale * static_cast<float>(advance);
    if (x + glyph.width + 1 > atlas_width_) {
      x = 0;
      y += shelf;
    }
    glyph.atlas_x = x;
    glyph.atlas_y = y;
    x += glyph.width + 1;
    atlas_.resize(static_cast<std::size_t>(atlas_width_) * static_cast<std::size_t>(y + shelf));
    if (glyph.width > 0 && glyph.height > 0) {
      assert(glyph.height <= shelf);
      auto* out = reinterpret_cast<unsigned char*>(atlas_.data()) +
                  static_cast<std::ptrdiff_t>(y) * atlas_width_ + glyph.atlas_x;
      stbtt_MakeGlyphBitmap(&info, out, glyph.width, glyph.height, atlas_width_, scale, scale, index);
    }
    glyphs_[character] = glyph;
  }
  atlas_height_ = y + shelf;
}

const Glyph& Font::glyph(char32_t character) const {
  const auto found = glyphs_.find(character);
  return found != glyphs_.end() ? found->second : glyphs_.at(U'?');
}

float Font::width_of(std::string_view text) const {
  float width = 0.0f;
  while (!text.empty()) width += glyph(next_character(text)).advance;
  return width;
}

}  // namespace aspic
