#pragma once
// Points whose short lists hold, many at a time, so that a backend may find their first contacts side by
// side.
#include <array>
#include <cstddef>
#include <cstdint>

#include "physics/contact/pairs.h"

namespace aspic::collision {

using namespace physics;

/// Triangles in a short list, at most.
inline constexpr std::size_t most_listed = 14;

/// So many are looked at together,
inline constexpr std::size_t batch_room = 128;
/// and as many may be read and written behind the last: a multiple of any number of lanes.
inline constexpr std::size_t batch_behind = 16;
template <class Value>
using BatchLane = std::array<Value, batch_room + batch_behind>;

/// Of a vector, or four numbers that are asked for together.
template <class Value>
using Row = std::array<Value, 4>;

/// What is asked, and the answers, by place in the batch.
template <class T>
struct ContactBatch {
  enum Answer : std::int32_t {
    apart,     ///< no contact
    contacts,  ///< one, which is in the columns below
    unsure     ///< to be looked at alone: its list does not hold, or it may touch second sides, too
  };

  std::size_t count = 0;
  alignas(64) BatchLane<std::int32_t> encounter, pair;
  alignas(
      64) std::array<BatchLane<std::int32_t>, 2> own;  ///< points that carry the point, as in SurfacePoint
  alignas(64) std::array<BatchLane<T>, 2> weight;      ///< of these
  alignas(64) BatchLane<std::int32_t> listed;          ///< so many triangles
  alignas(64) BatchLane<T> limit;  ///< triangles that the short list leaves out are no nearer than this [m]

  alignas(64) BatchLane<std::int32_t> answer, triangle;
  alignas(64) BatchLane<T> b, c;              ///< of the nearest place
  alignas(64) std::array<BatchLane<T>, 3> n;  ///< as in ContactPoint
  alignas(64) BatchLane<T> d, static_force, normal_force;
};

/// Where the answers come from.
template <class T>
struct ContactTables {
  const Row<T>*x, *v, *normal;      ///< by point [m], [m/s]
  const Row<std::uint32_t>* faces;  ///< by triangle: the points of its corners, and its side
  const std::uint32_t* list;        ///< first triangle of the first encounter's list
  std::size_t list_size;            ///< numbers from one list to the next
  const PairConstants<T>* pairs;
  T pad;        ///< distances are wrong by less [m]
  bool at_end;  ///< as BodyContact::set_at_end()
};

/// Fills in the answers to a batch, to the same bits as BodyContact does without it.
template <class T>
using ContactBatchKernel = void (*)(const ContactTables<T>&, ContactBatch<T>&);

}  // namespace aspic::collision
