#pragma once
// Finds every action, scene and value of a scene by name.
#include <string>
#include <string_view>

namespace aspic::app {

struct PanelParts;

/// Whether a text has every word of a query in it, in any case; the words are separated by blanks.
bool holds_words(std::string_view text, std::string_view query);

class Palette {
 public:
  void open();
  void close() { open_ = false; }
  bool is_open() const { return open_; }
  /// Once for each picture, between Gui::begin and end; sizes in window units.
  void draw(const PanelParts& parts, double width, double height);

 private:
  bool open_ = false, just_opened_ = false;
  std::string query_;
  int chosen_ = 0;  // of the hits
};

}  // namespace aspic::app
