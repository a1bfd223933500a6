#include "support/covering.h"

#include <numeric>
#include <utility>

namespace aspic::test {
namespace {

/// Marks for the pairs of values of different factors.
class PairMarks {
 public:
  explicit PairMarks(std::span<const std::size_t> sizes) : first_(sizes.size() + 1, 0) {
    std::partial_sum(sizes.begin(), sizes.end(), first_.begin() + 1);
    marks_.assign(first_.back() * first_.back(), 0);
  }

  /// Calls f with the mark of each pair in a row.
  template <class F>
  void for_each(const CoveringRow& row, const F& f) {
    for (std::size_t a = 0; a < row.size(); ++a) {
      char* const of_a = &marks_[(first_[a] + row[a]) * first_.back()];
      for (std::size_t b = a + 1; b < row.size(); ++b) f(of_a[first_[b] + row[b]]);
    }
  }

 private:
  std::vector<std::size_t> first_;  // number of a factor's first value among all values; their count
  std::vector<char> marks_;
};

}  // namespace

std::vector<CoveringRow> all_rows(std::span<const std::size_t> sizes,
                                  const std::function<bool(const CoveringRow&)>& allowed) {
  std::vector<CoveringRow> rows;
  CoveringRow row(sizes.size(), 0);
  for (;;) {
    if (allowed(row)) rows.push_back(row);
    std::size_t factor = sizes.size();
    while (factor > 0 && ++row[factor - 1] == sizes[factor - 1]) row[--factor] = 0;
    if (factor == 0) return rows;
  }
}

std::vector<CoveringRow> cover_pairs(std::span<const std::size_t> sizes,
                                     const std::function<bool(const CoveringRow&)>& allowed,
                                     std::vector<CoveringRow> first) {
  const std::vector<CoveringRow> candidates = all_rows(sizes, allowed);
  PairMarks missing(sizes);
  for (const CoveringRow& row : candidates) missing.for_each(row, [](char& mark) { mark = 1; });
  std::vector<CoveringRow> chosen = std::move(first);
  for (const CoveringRow& row : chosen) missing.for_each(row, [](char& mark) { mark = 0; });
  for (;;) {
    const CoveringRow* best = nullptr;
    int most = 0;
    for (const CoveringRow& row : candidates) {
      int gained = 0;
      missing.for_each(row, [&](const char mark) { gained += mark; });
      if (gained <= most) continue;
      most = gained;
      best = &row;
    }
    if (!best) return chosen;
    chosen.push_back(*best);
    missing.for_each(*best, [](char& mark) { mark = 0; });
  }
}

}  // namespace aspic::test
