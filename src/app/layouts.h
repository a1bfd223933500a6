#pragma once
// How the window can be arranged: rows of a table to choose from, and the user's changes to each.
#include <algorithm>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <utility>

#include "command_line/window_layouts.h"

namespace aspic::app {

/// Where things are in the window.
struct Layout {
  static constexpr double side_width = 322.0, narrowest = 240.0, widest = 800.0;
  static constexpr double smallest_text = 0.75, largest_text = 2.5;

  bool panels = true;                                        ///< visible
  double left_width = side_width, right_width = side_width;  ///< of the panels at text size 1 [window units]
  double text_size = 1.0;                                    ///< factor on the display's own scale
  bool clock = false;                                        ///< the time in large figures over the image
  std::map<std::string, bool> sections;                      ///< open or not, by heading; absent: as at first
  friend bool operator==(const Layout&, const Layout&) = default;
};

/// A layout as it is at first. The sections are those of panels.cpp, by heading.
struct LayoutRow {
  std::string_view name, title, summary;
  std::span<const std::string_view> open;           ///< sections that are open
  std::span<const std::string_view> sections = {};  ///< that there are; empty: all
  bool panels = true, clock = false;
  double text_size = 1.0, side_width = Layout::side_width;
  int sides = 2;        ///< panels at the sides of the image, 1 or 2
  bool readout = true;  ///< describes the thing under the mouse

  Layout at_first() const { return {panels, side_width, side_width, text_size, clock, {}}; }
};

/// In the order of window_layouts (command_line/window_layouts.h), never empty; the first is that of a first
/// start.
std::span<const LayoutRow> layouts();
/// Null: there is none of that name.
const LayoutRow* find_layout(std::string_view name);

/// The layout that is shown, and the others as they were left.
class Layouts : public Layout {
 public:
  Layouts() : Layout(layouts().front().at_first()) {}

  const LayoutRow& row() const { return *row_; }
  /// Shows another one: as it was left, or as it is at first.
  void choose(const LayoutRow& row);
  /// The one that comes after the shown one, which goes round.
  void choose_next();
  /// Larger text, or smaller for a factor below 1.
  void scale_text(double factor) { text_size = std::clamp(factor * text_size, smallest_text, largest_text); }
  /// The shown one as it is at first.
  void reset() { shown() = row_->at_first(); }

  /// As files keep them: the shown one, and by name the others that were ever shown.
  Layout& shown() { return *this; }
  const Layout& shown() const { return *this; }
  const std::map<std::string, Layout>& left() const { return left_; }
  void restore(const LayoutRow& row, const Layout& shown, std::map<std::string, Layout> left);
  /// A section by heading that is to be scrolled into sight, once; it is no part of what files keep.
  void want(std::string_view section) { wanted_ = section; }
  std::string take_wanted() { return std::exchange(wanted_, ""); }
  friend bool operator==(const Layouts& a, const Layouts& b) {
    return a.shown() == b.shown() && a.row_ == b.row_ && a.left_ == b.left_;
  }

 private:
  const LayoutRow* row_ = &layouts().front();
  std::map<std::string, Layout> left_;
  std::string wanted_;
};

}  // namespace aspic::app
