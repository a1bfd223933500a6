#include "device/device_state.h"

#include <algorithm>

#include "device/layout.h"
#include "model/cell_blocks.h"
#include "model/springs.h"

namespace aspic {
namespace {

layout::Lattices table_of(const Model& model, IncidentWords kind, const std::vector<WalkedRun>& walked) {
  layout::Lattices table{};
  for (const WalkedRun& run : walked) table.listed_count += run.end - run.first;
  if (kind != IncidentWords::beside_lattices && kind != IncidentWords::beside_cells) return table;
  for (std::size_t r = 1; r < walked.size(); ++r)
    table.unlisted[table.unlisted_count++] = {walked[r - 1].end, walked[r].first - walked[r - 1].end, 0, 0};
  std::size_t n = 0;
  for (const LatticeDirection& o : lattice_directions())
    table.directions[n++].word =
        static_cast<std::uint32_t>((o.di + 2) | (o.dj + 2) << 3 | (o.dk + 2) << 6) | o.spring_class << 9;
  for (const Body& body : model.bodies) {
    if (!body.box()) continue;
    layout::GpuLattice& lattice = table.lattices[table.lattice_count++];
    lattice.first_particle = body.first_particle;
    lattice.first_class = body.first_class;
    lattice.planes = static_cast<std::uint32_t>(body.box()->plane_count());
    lattice.rows = static_cast<std::uint32_t>(body.box()->row_count());
    lattice.row_size = static_cast<std::uint32_t>(body.box()->row_size());
  }
  return table;
}

CellBlocks blocks_of(const Model& model, IncidentWords kind) {
  return kind == IncidentWords::beside_cells ? cell_blocks(model, MAX_LATTICES) : CellBlocks();
}

/// The buffers of bodies of cells, none of which need more than a block.
Status make_cells(gl::Context& context, const Model& model, const CellBlocks& cells, SpringBuffers& made) {
  layout::Cells table{};
  std::vector<std::uint32_t> words;
  words.reserve(cells.words());
  const auto append = [&](const std::vector<std::uint32_t>& part) {
    const auto first = static_cast<std::uint32_t>(words.size());
    words.insert(words.end(), part.begin(), part.end());
    return first;
  };
  append(cells.map);
  table.plain_first = append(cells.plain);
  table.mixed_first = append(cells.mixed);
  table.patterns_first = append(cells.patterns);
  table.halves_first = append(cells.halves);
  table.plain_count = cells.plain_blocks();
  table.mixed_count = cells.mixed_blocks();
  std::size_t n = 0;
  for (const CellBody& taken : cells.bodies) {
    const Body& body = model.bodies[taken.body];
    table.cell_bodies[n++] = {body.first_particle,
                              body.first_particle + body.particle_count - 1,
                              body.first_class,
                              taken.first_block,
                              taken.first_block + taken.block_count - 1,
                              taken.row_blocks,
                              taken.plane_blocks,
                              0};
  }
  ASPIC_TRY(made.cells, gl::Buffer::of(context, "cells", words));
  ASPIC_TRY(made.cell_bodies,
            gl::Buffer::of(context, "bodies of cells", std::span(&table, 1), gl::BufferKind::uniform));
  made.class_width = cells.class_width;
  made.blocks = {cells.plain_blocks(), cells.mixed_blocks()};
  return {};
}

}  // namespace

bool has_lattices(const Model& model) {
  const auto lattices = std::ranges::count_if(model.bodies, [](const Body& body) { return body.box(); });
  return lattices > 0 && lattices <= MAX_LATTICES;
}

bool has_cells(const Model& model) {
  const auto lattices = std::ranges::count_if(model.bodies, [](const Body& body) { return body.box(); });
  return lattices <= MAX_LATTICES &&
         std::ranges::any_of(model.bodies, [](const Body& body) { return has_cells(body); });
}

std::uint64_t spring_buffer_bytes(const Model& model, IncidentWords kind) {
  const bool listed = kind == IncidentWords::springs;
  const CellBlocks cells = blocks_of(model, kind);
  return sizeof(layout::Lattices) + incident_counts(model, kind, cells.taken(model)).bytes() +
         (listed ? spring_count(model) * sizeof(layout::uvec2) : 0) +
         (cells.any() ? sizeof(layout::Cells) + cells.words() * sizeof(std::uint32_t) : 0);
}

Result<std::shared_ptr<const SpringBuffers>> make_spring_buffers(gl::Context& context, const Model& model,
                                                                 IncidentWords kind) {
  auto made = std::make_shared<SpringBuffers>();
  made->context = &context;
  made->kind = kind;
  if (kind == IncidentWords::springs) {
    ASPIC_TRY(const auto springs, packed_springs(model));
    ASPIC_TRY(made->springs, gl::Buffer::of(context, "springs", springs));
  }
  const CellBlocks cells = blocks_of(model, kind);
  const std::vector<bool> taken = cells.taken(model);
  const std::vector<WalkedRun> walked = walked_runs(model, kind, taken);
  const layout::Lattices table = table_of(model, kind, walked);
  made->listed = table.listed_count;
  ASPIC_TRY(made->lattices,
            gl::Buffer::of(context, "lattices", std::span(&table, 1), gl::BufferKind::uniform));
  if (cells.any()) ASPIC_CHECK(make_cells(context, model, cells, *made));
  ASPIC_TRY(const IncidentSprings rows, incident_springs(model, kind, taken));
  ASPIC_TRY(made->incident_start, gl::Buffer::of(context, "incident spring rows", rows.start));
  ASPIC_TRY(made->incident, gl::Buffer::of(context, "incident springs", rows.words));
  made->starts = rows.start;
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
