#pragma once
// Meshes that bodies of cells are drawn as, in place of their cells' faces.
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "aspic/model.h"

namespace aspic {

/// A mesh whose vertices follow particles: each is where Σ weight · position over its eight particles is.
struct BodyMesh {
  std::vector<std::array<std::uint32_t, 8>> corners;    ///< by vertex: particles, global indices
  std::vector<std::array<double, 8>> weights;           ///< by vertex: of these; their sum is 1
  std::vector<std::array<std::uint32_t, 3>> triangles;  ///< vertices, counterclockwise seen from outside
};
/// The mesh that is drawn on the body at an index of particle_ranges(); empty for most.
ASPIC_API BodyMesh body_mesh(const Model& model, std::size_t body);

}  // namespace aspic
