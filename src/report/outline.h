#pragma once
// A report in the order that a course suggests: its figures in place, gaps for its author's own words.
#include <span>
#include <string_view>
#include <vector>

#include "report/study.h"

namespace aspic::report {

struct OutlineRow {
  std::string_view name;                       ///< of --outline
  std::size_t most_pages;                      ///< that the course takes
  std::span<const std::string_view> sections;  ///< those of SectionRow that it is made of
  /// The chapters from these sections, which come in the order of the table. Errors: those of solvers and
  /// images; interrupted.
  Result<std::vector<Section>> (*arrange)(const Study& study, std::vector<Section> sections);
};

/// Every outline.
std::span<const OutlineRow> outlines();

}  // namespace aspic::report
