#include "device/device_state.h"

#include <algorithm>

namespace aspic {

Result<std::shared_ptr<const SpringBuffers>> make_spring_buffers(gl::Context& context, const Model& model,
                                                                 IncidentWords kind) {
  auto made = std::make_shared<SpringBuffers>();
  made->context = &context;
  made->kind = kind;
  if (kind == IncidentWords::springs) {
    ASPIC_TRY(const auto springs, packed_springs(model));
    ASPIC_TRY(made->springs, gl::Buffer::of(context, "springs", springs));
  }
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
