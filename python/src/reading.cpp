#include "reading.h"

#include <aspic/body_mesh.h>

namespace aspic::python {

Diverged told(const std::optional<Divergence>& divergence) {
  if (!divergence) return std::nullopt;
  return std::make_tuple(divergence->step, divergence->particle, divergence->ball,
                         body_text(*divergence) + " " + fault_text(*divergence));
}

InputRows rows_of(const Inputs& inputs) {
  InputRows rows = {{}, inputs.pinned, inputs.released, inputs.channels};
  for (const Pull& p : inputs.pulls)
    std::get<0>(rows).emplace_back(p.particle, std::make_tuple(p.anchor.x, p.anchor.y, p.anchor.z),
                                   p.stiffness, p.damping, p.ball);
  return rows;
}

Inputs inputs_of_rows(const InputRows& rows) {
  Inputs inputs = {{}, std::get<1>(rows), std::get<2>(rows), std::get<3>(rows)};
  for (const auto& [particle, anchor, stiffness, damping, ball] : std::get<0>(rows)) {
    const auto& [x, y, z] = anchor;
    inputs.pulls.push_back({particle, {x, y, z}, stiffness, damping, ball});
  }
  return inputs;
}

MeasureRow row_of(const Measures& m) {
  return {m.kinetic,       m.elastic,
          m.gravitational, std::make_tuple(m.momentum.x, m.momentum.y, m.momentum.z),
          m.max_speed,     m.min_height};
}

QuantityArrays arrays_of(StateQuantities q) {
  const std::size_t particles = q.speed.size(), springs = q.strain.size();
  const auto vectors = [&](const std::vector<Vec3>& all) {
    std::vector<double> numbers;
    numbers.reserve(3 * all.size());
    for (const Vec3& v : all) numbers.insert(numbers.end(), {v.x, v.y, v.z});
    return as_array(std::move(numbers), {particles, 3});
  };
  return QuantityArrays(as_array(std::move(q.speed), {particles}),
                        as_array(std::move(q.mean_strain), {particles}), vectors(q.force),
                        vectors(q.contact_force), as_array(std::move(q.contact), {particles}),
                        as_array(std::move(q.strain), {springs}), as_array(std::move(q.tension), {springs}));
}

Array<double> masses(const Model& model) {
  std::vector<double> all = particle_masses(model);
  const std::size_t count = all.size();
  return as_array(std::move(all), {count});
}

Array<std::uint32_t> pinned(const Model& model) {
  std::vector<std::uint32_t> all = pinned_indices(model);
  const std::size_t count = all.size();
  return as_array(std::move(all), {count});
}

SpringArrays springs(const Model& model) {
  const std::vector<SpringFacts> all = spring_facts(model);
  std::vector<std::uint32_t> ends;
  std::vector<double> stiffness, damping, rest;
  std::vector<std::uint8_t> type, cord;
  for (const SpringFacts& s : all) {
    ends.insert(ends.end(), {s.a, s.b});
    stiffness.push_back(s.stiffness);
    damping.push_back(s.damping);
    rest.push_back(s.rest_length);
    type.push_back(static_cast<std::uint8_t>(s.type));
    cord.push_back(s.cord ? 1 : 0);
  }
  const std::size_t count = all.size();
  return SpringArrays(as_array(std::move(ends), {count, 2}), as_array(std::move(stiffness), {count}),
                      as_array(std::move(damping), {count}), as_array(std::move(rest), {count}),
                      as_array(std::move(type), {count}), as_array(std::move(cord), {count}));
}

Array<std::uint32_t> surface(const Model& model, std::size_t body) {
  if (body >= particle_ranges(model).size()) throw nb::index_error("no such body");
  const std::vector<Quad> quads = surface_quads(model, body);
  std::vector<std::uint32_t> corners;
  for (const Quad& quad : quads) corners.insert(corners.end(), quad.begin(), quad.end());
  return as_array(std::move(corners), {quads.size(), 4});
}

MeshArrays mesh(const Model& model, std::size_t body) {
  if (body >= particle_ranges(model).size()) throw nb::index_error("no such body");
  const BodyMesh found = body_mesh(model, body);
  const std::size_t vertices = found.corners.size();
  std::vector<std::uint32_t> corners, triangles;
  std::vector<double> weights;
  for (std::size_t v = 0; v < vertices; ++v) {
    corners.insert(corners.end(), found.corners[v].begin(), found.corners[v].end());
    weights.insert(weights.end(), found.weights[v].begin(), found.weights[v].end());
  }
  for (const auto& triangle : found.triangles)
    triangles.insert(triangles.end(), triangle.begin(), triangle.end());
  return MeshArrays(as_array(std::move(corners), {vertices, 8}), as_array(std::move(weights), {vertices, 8}),
                    as_array(std::move(triangles), {found.triangles.size(), 3}));
}

std::vector<std::pair<std::uint32_t, std::uint32_t>> ranges(const Model& model) {
  std::vector<std::pair<std::uint32_t, std::uint32_t>> all;
  for (const ParticleRange& range : particle_ranges(model)) all.emplace_back(range.first, range.count);
  return all;
}

std::vector<std::tuple<double, double, std::uint64_t>> balls(const Model& model) {
  std::vector<std::tuple<double, double, std::uint64_t>> all;
  for (const BallFacts& ball : ball_facts(model)) all.emplace_back(ball.radius, ball.mass, ball.launch_step);
  return all;
}

void check_field(std::size_t field) {
  if (field >= state_fields.size()) throw nb::index_error("no such field");
}

}  // namespace aspic::python
