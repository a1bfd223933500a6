// What programs outside the library ask of a model.
#include <numeric>
#include <utility>

#include "aspic/body_mesh.h"
#include "aspic/model.h"
#include "base/result.h"
#include "model/model.h"
#include "model/springs.h"

namespace aspic {

Result<SharedModel> make_model(const ModelSettings& settings) {
  ASPIC_TRY(auto model, build_model(settings));
  return shared(std::move(model));
}

std::vector<ParticleRange> particle_ranges(const Model& model) {
  std::vector<ParticleRange> ranges;
  for (const Body& body : model.bodies) ranges.push_back({body.first_particle, body.particle_count});
  return ranges;
}

std::vector<std::string> input_names(const Model& model) {
  std::vector<std::string> names;
  for (const Actuator& actuator : model.actuation.actuators)
    if (actuator.signal == Signal::input) names.push_back(actuator.name);
  return names;
}

std::vector<double> particle_masses(const Model& model) {
  return {model.mass.begin(), model.mass.end()};
}

std::vector<std::uint32_t> pinned_indices(const Model& model) {
  std::vector<std::uint32_t> pinned;
  for (std::uint32_t i = 0; i < model.particle_count(); ++i)
    if (model.inverse_mass[i] == 0.0) pinned.push_back(i);
  return pinned;
}

std::vector<SpringFacts> spring_facts(const Model& model) {
  std::vector<SpringFacts> facts;
  for (const Spring& spring : springs_of(model)) {
    const SpringClass& kind = model.spring_classes[spring.spring_class];
    facts.push_back(
        {spring.a, spring.b, kind.type, kind.stiffness, kind.damping, kind.rest_length, kind.cord});
  }
  return facts;
}

std::vector<Quad> surface_quads(const Model& model, std::size_t body) {
  return surface_of(model.bodies[body]).quads;
}

BodyMesh body_mesh(const Model& model, std::size_t body) {
  const BodySkin& skin = model.bodies[body].skin;
  BodyMesh mesh = {skin.corners, {}, skin.triangles};
  for (const SkinVertex& vertex : skin.binding.vertices) mesh.weights.push_back(corner_weights(vertex.at));
  return mesh;
}

std::vector<BallFacts> ball_facts(const Model& model) {
  std::vector<BallFacts> facts;
  for (const Ball& ball : model.balls) facts.push_back({ball.radius, ball.mass, ball.launch_step});
  return facts;
}

}  // namespace aspic
