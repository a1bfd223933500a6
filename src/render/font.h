#pragma once
// Letters as images: DejaVu Sans, embedded, rasterized at the height they are shown at.
#include <cstddef>
#include <map>
#include <string_view>
#include <vector>

namespace aspic {

/// One rasterized character.
struct Glyph {
  int atlas_x = 0, atlas_y = 0;  ///< its place in the atlas [pixels]
  int width = 0, height = 0;     ///< of its image [pixels], 0 for blanks
  int left = 0, top = 0;         ///< from the pen to the image's top left; y down, so `top` is mostly < 0
  float advance = 0.0f;          ///< to the next pen position [pixels]
};

/// The characters of one text height: Latin, Greek and Cyrillic letters, and a few mathematical signs.
class Font {
 public:
  /// `pixel_height`: from the highest ascender to the lowest descender, 6…256.
  explicit Font(int pixel_height);

  int pixel_height() const { return pixel_height_; }
  int ascent() const { return ascent_; }            ///< from the top of a line to its baseline [pixels]
  int line_height() const { return line_height_; }  ///< from baseline to baseline [pixels]
  /// The character, or the question mark's where the font sheet lacks it.
  const Glyph& glyph(char32_t character) const;
  /// Width of a line of UTF-8 text, kerning left out [pixels].
  float width_of(std::string_view text) const;

  /// Coverage 0…255, row by row from the top.
  const std::vector<std::byte>& atlas() const { return atlas_; }
  int atlas_width() const { return atlas_width_; }
  int atlas_height() const { return atlas_height_; }

 private:
  int pixel_height_, ascent_ = 0, line_height_ = 0;
  int atlas_width_ = 0, atlas_height_ = 0;
  std::map<char32_t, Glyph> glyphs_;
  std::vector<std::byte> atlas_;
};

/// Takes the first character off UTF-8 text; U+FFFD for what is not UTF-8. `text` must not be empty.
char32_t next_character(std::string_view& text);

}  // namespace aspic
