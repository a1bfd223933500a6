#pragma once
// What a page says of a run besides its images, as JSON, and the shapes that its terrain is drawn with.
#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "aspic/scene.h"
#include "model/model.h"
#include "page/packing.h"

namespace aspic::page {

using Json = nlohmann::ordered_json;

/// Quanta of a page's numbers.
struct Quanta {
  double position = 0.0;  ///< of particles [m]: a 4096th of the shortest spring at rest, a 1024th of more
                          ///< than 10,000 particles
  double ball_position = 0.0;  ///< [m]: the same share of the smallest radius
  double spin = 0.0;           ///< of angular velocities [rad/s]: 1/256
  double change = 0.0;         ///< of r/r₀ − 1 of actuated springs: 1/8192
};
Quanta quanta_of(const Model& model);

/// Parameters, bodies, springs, balls, terrain and the ranges of colors. `name`: what distinguishes the run
/// from others next to it; empty where it is alone. `number`: of the run, from 0.
Json run_facts(const Scene& scene, const Model& model, const std::string& name, std::size_t number);

/// The view's camera and what it shows, and the colors of its scales.
Json view_facts(const Scene& scene);

/// r/r₀ − 1 of the actuated classes at a step, three to a vector. `channels`: Inputs::channels that hold.
std::vector<Vec3> changes_of(const Model& model, std::uint64_t step, std::span<const double> channels);
/// How many vectors that are.
inline std::size_t change_vectors(const Model& model) {
  return (model.actuation.classes.size() + 2) / 3;
}

/// Appends what run_facts() counts: the listed springs (all first ends, then second ends, each as its
/// difference from the one before, then classes), of each body the quads of its surface (all first corners,
/// then the other three as differences from them) or, if it has one, its mesh (of the vertices the eight
/// particles in the same way, then x, y and z in the cell, as whole steps; then the triangles as the quads),
/// and of each terrain the surface and what is cut out of its flat part.
void append_shapes(const Model& model, std::string& bytes);

}  // namespace aspic::page
