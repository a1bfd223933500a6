#pragma once
// Finds every action, scene, section and value of a scene by name.
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace aspic::app {

struct PanelParts;

/// Whether a text has every word of a query in it, in any case; the words are separated by blanks.
bool holds_words(std::string_view text, std::string_view query);

/// How well a name fits a query that it or `more` holds, the least the best: 0 if its last part, behind a
/// full stop, begins with the first word; 1 if each word begins a word of the name; 2 if the name has them
/// anywhere; 3 if only `more` has. Nothing: they do not have all words.
std::optional<int> fit_of(std::string_view name, std::string_view more, std::string_view query);

class Palette {
 public:
  void open();
  void close() { open_ = false; }
  bool is_open() const { return open_; }
  /// Once for each image, between Gui::begin and end; sizes in window units.
  void draw(const PanelParts& parts, double width, double height);

 private:
  struct Hit;
  std::vector<Hit> find(const PanelParts& parts);
  bool value_row(const PanelParts& parts, const Hit& hit, bool marked, bool entered);

  bool open_ = false, just_opened_ = false;
  bool back_to_query_ = false;  // a value was entered
  int typed_row_ = -1;          // whose value had the keyboard in the last image
  std::string query_;
  int chosen_ = 0;  // of the hits
};

}  // namespace aspic::app
