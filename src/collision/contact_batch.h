#pragma once
// Queries of many candidate groups whose cache entries are valid, in columns that a backend may evaluate in
// vector lanes.
#include <array>
#include <cstddef>
#include <cstdint>

#include "physics/contact/pairs.h"

namespace aspic::collision {

using namespace physics;

/// Most triangles of a cache entry.
inline constexpr std::size_t most_cached = 14;

/// Queries of a batch.
inline constexpr std::size_t batch_room = 128;
/// Entries behind the last query that may be read and written: a multiple of any number of lanes.
inline constexpr std::size_t batch_behind = 16;
template <class Value>
using BatchLane = std::array<Value, batch_room + batch_behind>;

/// A vector, or four numbers that are loaded together.
template <class Value>
using Row = std::array<Value, 4>;

/// Queries and answers, by place in the batch.
template <class T>
struct ContactBatch {
  enum Answer : std::int32_t {
    apart,     ///< no contact
    contacts,  ///< one contact, in the columns below
    undecided  ///< needs a query of its own: the entry is not enough, or other sides may be in contact
  };

  std::size_t count = 0;
  alignas(64) BatchLane<std::int32_t> candidate_group, pair;
  alignas(
      64) std::array<BatchLane<std::int32_t>, 2> own;  ///< points that carry the point, as in SurfacePoint
  alignas(64) std::array<BatchLane<T>, 2> weight;      ///< of these
  alignas(64) BatchLane<std::int32_t> cached;          ///< number of cached triangles
  alignas(64) BatchLane<T> limit;                      ///< other triangles are no nearer than this [m]

  alignas(64) BatchLane<std::int32_t> answer, triangle;
  alignas(64) BatchLane<T> b, c;              ///< of the nearest place
  alignas(64) std::array<BatchLane<T>, 3> n;  ///< as in ContactPoint
  alignas(64) BatchLane<T> d, static_force, normal_force;
};

/// The data that queries read.
template <class T>
struct ContactTables {
  const Row<T>*x, *v, *normal;      ///< by point [m], [m/s]
  const Row<std::uint32_t>* faces;  ///< by triangle: the points of its corners, and its side
  const std::uint32_t* cache;       ///< first triangle of the first group's entry
  std::size_t entry_size;           ///< numbers from one entry to the next
  const PairConstants<T>* pairs;
  T rounding;   ///< upper bound of the rounding error of a distance [m]
  bool at_end;  ///< as ContactSearch::set_at_end()
};

/// Fills in the answers of a batch, with the bits of queries one by one.
template <class T>
using ContactBatchKernel = void (*)(const ContactTables<T>&, ContactBatch<T>&);

}  // namespace aspic::collision
