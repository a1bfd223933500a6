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
  for (const Body& body : model.bodies)
    if (body.lattice_edge > 0)
      table.lattices[table.lattice_count++] = {body.first_particle, body.lattice_edge, body.first_class, 0};
  return table;
}

}  // namespace

bool has_lattices(const Model& model) {
  const auto lattices =
      std::ranges::count_if(model.bodies, [](const Body& body) { return body.lattice_edge > 0; });
  return lattices > 0 && lattices <= MAX_LATTICES;
}

std::uint64_t spring_buffer_bytes(const Model& model, IncidentWords kind) {
  const bool listed = kind == IncidentWords::springs;
  return sizeof(layout::Lattices) + incident_counts(model, kind).bytes() +
         (listed ? spring_count(model) * sizeof(layout::uvec2) : 0);
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
  const layout::Lattices table = table_of(model, kind);
  ASPIC_TRY(made->lattices,
            gl::Buffer::of(context, "lattices", std::span(&table, 1), gl::BufferKind::uniform));
  ASPIC_TRY(const IncidentSprings rows, incident_springs(model, kind));
  ASPIC_TRY(made->incident_start, gl::Buffer::of(context, "incident spring rows", rows.start));
  ASPIC_TRY(made->incident, gl::Buffer::of(context, "incident springs", rows.words));
  return std::shared_ptr<const SpringBuffers>(std::move(made));
}

bool same_springs(const Model& a, const Model& b) {
  const auto same_lattice = [](const Body& one, const Body& other) {
    return one.lattice_edge == other.lattice_edge &&
           (one.lattice_edge == 0 ||
            (one.first_particle == other.first_particle && one.first_class == other.first_class));
  };
  return a.particle_count() == b.particle_count() && class_bits(a) == class_bits(b) &&
         a.listed_springs == b.listed_springs && std::ranges::equal(a.bodies, b.bodies, same_lattice);
}

}  // namespace aspic
