#include "device/device_state.h"

#include <algorithm>

#include "device/layout.h"
#include "model/springs.h"

namespace aspic {
namespace {

layout::Lattices table_of(const Model& model, IncidentWords kind) {
  layout::Lattices table{};
  table.listed_count = model.particle_count();
  if (kind != IncidentWords::beside_lattices) return table;
  table.listed_count -= lattice_particles(model);
  std::size_t n = 0;
  for (const LatticeDirection& o : lattice_directions())
    table.directions[n++].word =
        static_cast<std::uint32_t>((o.di + 2) | (o.dj + 2) << 3 | (o.dk + 2) << 6) | o.spring_class << 9;
  for (const Body& body : model.bodies) {
    if (!body.box()) continue;
    layout::Lattice& lattice = table.lattices[table.lattice_count++];
    lattice.first_particle = body.first_particle;
    lattice.first_class = body.first_class;
    lattice.planes = static_cast<std::uint32_t>(body.box()->plane_count());
    lattice.rows = static_cast<std::uint32_t>(body.box()->row_count());
    lattice.row_size = static_cast<std::uint32_t>(body.box()->row_size());
  }
  return table;
}

/// Of words whose low `bits` say something else.
std::vector<SliceWords> slices_of(const IncidentSprings& rows, std::uint32_t bits) {
  std::vector<SliceWords> slices;
  for (std::size_t s = 0; s < rows.start.size(); ++s) {
    SliceWords& slice = slices.emplace_back(SliceWords{rows.start[s]});
    const std::uint32_t end = s + 1 < rows.start.size() ? rows.start[s + 1] : rows.start[s];
    std::uint32_t lowest = no_spring, highest = 0;
    for (std::uint32_t w = rows.start[s]; w < end; ++w) {
      if (rows.words[w] == no_spring) continue;
      lowest = std::min(lowest, rows.words[w] >> bits);
      highest = std::max(highest, rows.words[w] >> bits);
    }
    if (lowest <= highest) slice.named = {lowest, std::uint64_t{highest} + 1};
  }
  return slices;
}

std::vector<IndexRange> ends_of(std::span<const std::array<std::uint32_t, 2>> springs, std::uint32_t bits) {
  std::vector<IndexRange> units((springs.size() + spring_unit - 1) / spring_unit);
  for (std::size_t s = 0; s < springs.size(); ++s) {
    const auto [a, packed] = springs[s];
    units[s / spring_unit].take({a, std::uint64_t{packed >> bits} + 1});  // a < b
  }
  return units;
}

}  // namespace

bool has_lattices(const Model& model) {
  const auto lattices = std::ranges::count_if(model.bodies, [](const Body& body) { return body.box(); });
  return lattices > 0 && lattices <= MAX_LATTICES;
}

std::uint64_t spring_buffer_bytes(const Model& model, IncidentWords kind) {
  const bool listed = kind == IncidentWords::springs;
  return sizeof(layout::Lattices) + incident_counts(model, kind).bytes() +
         (listed ? spring_count(model) * sizeof(layout::uvec2) : 0);
}

void IndexRange::take(const IndexRange& other) {
  if (other.count() == 0) return;
  *this = count() == 0 ? other : IndexRange{std::min(first, other.first), std::max(end, other.end)};
}

Result<std::shared_ptr<const SpringBuffers>> make_spring_buffers(gl::Context& context, const Model& model,
                                                                 IncidentWords kind, gl::BufferKind buffers) {
  auto made = std::make_shared<SpringBuffers>();
  made->context = &context;
  made->kind = kind;
  if (kind == IncidentWords::springs) {
    ASPIC_TRY(const auto springs, packed_springs(model));
    ASPIC_TRY(made->springs, gl::Buffer::of(context, "springs", springs, buffers));
    made->spring_ends = ends_of(springs, class_bits(model));
  }
  const layout::Lattices table = table_of(model, kind);
  ASPIC_TRY(made->lattices,
            gl::Buffer::of(context, "lattices", std::span(&table, 1), gl::BufferKind::uniform));
  ASPIC_TRY(const IncidentSprings rows, incident_springs(model, kind));
  ASPIC_TRY(made->incident_start, gl::Buffer::of(context, "incident spring rows", rows.start));
  ASPIC_TRY(made->incident, gl::Buffer::of(context, "incident springs", rows.words, buffers));
  made->slices = slices_of(rows, kind == IncidentWords::springs ? 1u : class_bits(model));
  return std::shared_ptr<const SpringBuffers>(std::move(made));
}

bool same_springs(const Model& a, const Model& b) {
  const auto same_lattice = [](const Body& one, const Body& other) {
    return one.lattice == other.lattice && (!one.lattice || (one.first_particle == other.first_particle &&
                                                             one.first_class == other.first_class));
  };
  return a.particle_count() == b.particle_count() && class_bits(a) == class_bits(b) &&
         a.listed_springs == b.listed_springs && std::ranges::equal(a.bodies, b.bodies, same_lattice);
}

}  // namespace aspic
