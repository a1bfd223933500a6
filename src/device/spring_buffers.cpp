#include "device/spring_buffers.h"

#include <algorithm>

namespace aspic {

Result<std::shared_ptr<const SpringBuffers>> make_spring_buffers(gl::Context& context, const Model& model,
                                                                 IncidentWords kind) {
  auto made = std::make_shared<SpringBuffers>();
  made->context = &context;
  made->kind = kind;
  gl::BufferFiller fill(context);
  if (kind == IncidentWords::springs) {
    ASPIC_TRY(const auto springs, packed_springs(model));
    fill(made->springs, "springs", springs);
  }
  ASPIC_TRY(const IncidentSprings rows, incident_springs(model, kind));
  fill(made->incident_start, "incident spring rows", rows.start);
  fill(made->incident, "incident springs", rows.words);
  ASPIC_CHECK(fill.status());
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
