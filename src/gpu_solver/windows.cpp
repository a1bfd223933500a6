#include "gpu_solver/windows.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <iterator>

#include "gpu_solver/layout.h"

namespace aspic {
namespace {

std::uint64_t rounded_down(std::uint64_t first) {
  return first - first % window_unit;
}

/// From the unit that it begins in.
IndexRange from_unit(const IndexRange& range) {
  return {rounded_down(range.first), range.end};
}

const IndexRange& part_of(const Window& window, Over over) {
  switch (over) {
    case Over::items:
      return window.items;
    case Over::words:
      return window.words;
    case Over::springs:
      return window.springs;
    case Over::particles:
      break;
  }
  return window.particles;
}

bool fits(const Window& window, std::uint64_t block, const ElementBytes& bytes) {
  return window.items.count() * bytes.item <= block && window.particles.count() * bytes.particle <= block &&
         window.words.count() * bytes.word <= block && window.springs.count() * bytes.spring <= block;
}

Window joined(Window window, const Window& other) {
  window.items.take(other.items);
  window.particles.take(other.particles);
  window.words.take(other.words);
  window.springs.take(other.springs);
  return window;
}

/// The particles that kernels read for the neighbours of these, which are all in one lattice: two planes and
/// two rows away, and a few more where a run ends.
IndexRange near(const Body& lattice, const IndexRange& particles) {
  const std::uint64_t row = lattice.box()->row_size(), plane = lattice.box()->row_count() * row,
                      reach = 2 * plane + 2 * row + 8, first = lattice.first_particle,
                      end = first + lattice.particle_count;
  return {particles.first > first + reach ? particles.first - reach : first,
          std::min(particles.end + reach, end)};
}

/// The particle at this place among those that have words.
std::uint64_t listed_particle(const SpringBuffers& springs, std::uint64_t place) {
  const auto after = std::ranges::upper_bound(springs.walked, place, {}, &WalkedRun::place);
  const WalkedRun& run = *std::prev(after);
  return run.first + (place - run.place);
}

/// Words of these places, and the particles or springs they name.
void take_words(const SpringBuffers& springs, const IndexRange& places, Window& window) {
  if (places.count() == 0) return;
  const bool names_springs = springs.kind == IncidentWords::springs;
  IndexRange& named = names_springs ? window.springs : window.particles;
  const std::uint64_t first = places.first / SPRING_SLICE, last = (places.end - 1) / SPRING_SLICE;
  for (std::uint64_t s = first; s <= last; ++s) named.take(springs.slices[s].named);
  window.words.take({springs.slices[first].first_word, springs.slices[last + 1].first_word});
}

}  // namespace

Result<std::vector<Window>> windows_over(std::uint64_t items, std::uint64_t block_bytes,
                                         const ElementBytes& bytes, const Seen& seen,
                                         std::uint64_t unit_items) {
  std::vector<Window> windows;
  for (std::uint64_t first = 0; first < items; first += unit_items) {
    Window unit = seen({first, std::min(first + unit_items, items)});
    for (IndexRange* range : {&unit.particles, &unit.words, &unit.springs}) *range = from_unit(*range);
    if (!windows.empty()) {
      const Window both = joined(windows.back(), unit);
      if (fits(both, block_bytes, bytes)) {
        windows.back() = both;
        continue;
      }
    }
    if (!fits(unit, block_bytes, bytes))
      return advised(
          fail(ErrorCode::scene_rejected,
               "springs join particles so far apart that {} of them need more of the state than the {} "
               "bytes of the device's largest storage block.",
               unit.items.count(), block_bytes),
          {use_backend("cpu"), advice("choose another device")});
    windows.push_back(unit);
  }
  return windows;
}

Seen seen_by_lattice_runs(const Model& model, std::uint32_t run) {
  return [&model, run](IndexRange items) {
    Window window{.items = items};
    std::uint64_t runs_before = 0;
    for (const Body& body : model.bodies) {
      if (!body.box()) continue;
      const std::uint64_t runs = (body.particle_count - 1) / run + 1;
      const IndexRange mine = {std::max(items.first, runs_before), std::min(items.end, runs_before + runs)};
      if (mine.first < mine.end) {
        const std::uint64_t first = body.first_particle + (mine.first - runs_before) * run;
        window.particles.take(near(body, {first, first + mine.count() * run}));
      }
      runs_before += runs;
    }
    return window;
  };
}

TileCounts tiles_in(const Body& lattice) {
  const auto along = [&](std::size_t axis, std::uint32_t size) {
    return (static_cast<std::uint32_t>(lattice.box()->particles[axis]) + size - 1) / size;
  };
  return {along(0, TILE_I), along(1, TILE_J), along(2, TILE_K)};
}

Seen seen_by_lattice_tiles(const Model& model) {
  return [&model](IndexRange items) {
    Window window{.items = items};
    std::uint64_t tiles_before = 0;
    for (const Body& body : model.bodies) {
      if (!body.box()) continue;
      const TileCounts tiles = tiles_in(body);
      const std::uint64_t begin = tiles_before * tile_particles,
                          end = begin + std::uint64_t{tiles.all()} * tile_particles,
                          first = std::max(items.first, begin), last = std::min(items.end, end);
      tiles_before += tiles.all();
      if (first >= last) continue;
      // Complete layers of tiles: as many planes.
      const std::uint64_t layer = std::uint64_t{tiles.j} * tiles.k * tile_particles,
                          plane = body.box()->row_count() * body.box()->row_size() * TILE_I;
      window.particles.take(near(body, {body.first_particle + (first - begin) / layer * plane,
                                        body.first_particle + ((last - 1 - begin) / layer + 1) * plane}));
    }
    return window;
  };
}

Seen seen_by_blocks(const SpringBuffers& springs, std::size_t kind, std::uint32_t run) {
  return [&springs, kind, run](IndexRange items) {
    Window window{.items = items};
    const std::uint64_t runs = block_places / run;
    for (std::uint64_t record = items.first / runs; record * runs < items.end; ++record)
      window.particles.take(springs.block_particles[kind][record]);
    return window;
  };
}

Seen seen_by_listed(const SpringBuffers& springs) {
  return [&springs](IndexRange items) {
    Window window{.items = items};
    window.particles = {listed_particle(springs, items.first), listed_particle(springs, items.end - 1) + 1};
    take_words(springs, items, window);
    return window;
  };
}

Seen seen_by_particles(const Model& model, const SpringBuffers& springs) {
  return [&model, &springs](IndexRange items) {
    Window window{.items = items, .particles = items};
    IndexRange places = items;  // of the listed ones among them
    if (springs.kind == IncidentWords::beside_lattices) {
      for (const Body& body : model.bodies) {
        if (!body.box()) continue;
        const std::uint64_t first = body.first_particle, end = first + body.particle_count;
        const IndexRange mine = {std::max(items.first, first), std::min(items.end, end)};
        if (mine.first < mine.end) window.particles.take(near(body, mine));
        const auto place = [&](std::uint64_t item, std::uint64_t place_before) {
          return place_before - (std::clamp(item, first, end) - first);
        };
        places = {place(items.first, places.first), place(items.end, places.end)};
      }
    }
    take_words(springs, places, window);
    return window;
  };
}

Seen seen_by_springs(const SpringBuffers& springs) {
  return [&springs](IndexRange items) {
    Window window{.items = items, .springs = items};
    for (std::uint64_t unit = items.first / window_unit; unit * window_unit < items.end; ++unit)
      window.particles.take(springs.spring_ends[unit]);
    return window;
  };
}

void SlicedPass::dispatch(std::span<const SlicedArray> arrays, gl::ReadBy readers) const {
  std::array<gl::Binding, 8> bindings;
  assert(arrays.size() <= bindings.size());
  const auto bound = [&](const Window* window) {
    std::size_t count = 0;
    for (const SlicedArray& array : arrays) {
      if (!array.buffer || array.buffer->bytes() == 0) continue;
      gl::Binding& binding = bindings[count++] = {array.binding, array.buffer};
      if (!window) continue;
      const IndexRange& part = part_of(*window, array.over);
      binding.offset = part.first * array.element_bytes;
      binding.bytes = part.count() * array.element_bytes;
      if (binding.bytes == 0) --count;  // none of it is read
    }
    return std::span<const gl::Binding>(bindings).first(count);
  };
  if (windows_.empty()) {
    pass_.dispatch_for(items_, bound(nullptr), readers);
    return;
  }
  const auto word = [](std::uint64_t number) { return static_cast<std::uint32_t>(number); };
  for (const Window& window : windows_) {
    program().set(LOCATION_WINDOW,
                  std::array<std::uint32_t, 4>{word(window.items.first), word(window.items.end),
                                               word(window.particles.first), word(window.words.first)});
    program().set(LOCATION_FIRST_SPRING, word(window.springs.first));
    pass_.dispatch_for(word(window.items.count()), bound(&window), readers);
  }
}

}  // namespace aspic
