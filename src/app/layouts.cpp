#include "app/layouts.h"

#include <algorithm>
#include <iterator>
#include <utility>

namespace aspic::app {

namespace {

constexpr std::string_view standard_open[] = {"Simulation", "Springs", "Scene", "Energy", "View"};
constexpr std::string_view lecture_sections[] = {"Scene", "Simulation", "View", "Energy"};
constexpr std::string_view lecture_open[] = {"Energy"};
constexpr std::string_view lab_open[] = {"Simulation", "Springs",     "Contact",
                                         "Recording",  "Performance", "Energy"};
constexpr std::string_view video_open[] = {"View", "Recording"};

constexpr LayoutRow rows[] = {
    {.name = window_layouts[0],
     .title = "Standard",
     .summary = "Shows motion, springs, scenes, energy and view; closes all other sections.",
     .open = standard_open},
    {.name = window_layouts[1],
     .title = "Lecture",
     .summary = "For lectures: large text, one panel with few sections, a large clock.",
     .open = lecture_open,
     .sections = lecture_sections,
     .clock = true,
     .text_size = 1.4,
     .sides = 1},
    {.name = window_layouts[2],
     .title = "Lab",
     .summary = "For measuring: values of springs and contact, performance, energies and files.",
     .open = lab_open},
    {.name = window_layouts[3],
     .title = "Video",
     .summary = "Shows the image alone, as in a video. Keys: Ctrl+R video, Tab panels",
     .open = video_open,
     .panels = false,
     .readout = false},
};
static_assert(std::size(rows) == std::size(window_layouts));

}  // namespace

std::span<const LayoutRow> layouts() {
  return rows;
}

const LayoutRow* find_layout(std::string_view name) {
  const auto* const found = std::ranges::find(rows, name, &LayoutRow::name);
  return found == std::end(rows) ? nullptr : found;
}

void Layouts::choose(const LayoutRow& row) {
  if (&row == row_) return;
  left_[std::string(row_->name)] = std::exchange(shown(), row.at_first());
  row_ = &row;
  const auto known = left_.find(std::string(row.name));
  if (known == left_.end()) return;
  shown() = std::move(known->second);
  left_.erase(known);
}

void Layouts::restore(const LayoutRow& row, const Layout& shown_then, std::map<std::string, Layout> left) {
  row_ = &row;
  shown() = shown_then;
  left_ = std::move(left);
}

void Layouts::choose_next() {
  choose(rows[static_cast<std::size_t>(row_ - rows + 1) % std::size(rows)]);
}

}  // namespace aspic::app
