#pragma once
// Covering sets: few rows in which every two values of any two factors meet. What depends on at most two
// factors at once fails in a row of such a set if it fails in any row of the product.
// Source: Cohen, Dalal, Fredman, Patton, The AETG System, IEEE Transactions on Software Engineering 23, 1997.
#include <cstddef>
#include <functional>
#include <span>
#include <vector>

namespace aspic::test {

/// A value of each factor, by index, in the order of the factors.
using CoveringRow = std::vector<std::size_t>;

/// Rows in which every pair of values occurs that occurs in any row allowed. `sizes`: values of each factor,
/// each ≥ 1. Chosen greedily in a fixed order: the same rows everywhere, after those of `first`, which may be
/// of fewer values.
std::vector<CoveringRow> cover_pairs(std::span<const std::size_t> sizes,
                                     const std::function<bool(const CoveringRow&)>& allowed,
                                     std::vector<CoveringRow> first = {});

/// Every row of the product that is allowed, the last factor fastest.
std::vector<CoveringRow> all_rows(std::span<const std::size_t> sizes,
                                  const std::function<bool(const CoveringRow&)>& allowed);

}  // namespace aspic::test
