#pragma once
// What solvers leave on the device for images: the state, and the springs of the model.
#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "gpu/buffer.h"
#include "model/incident_springs.h"

namespace aspic {

/// Nothing writes them once they are made, so solvers and images of one context may share them.
struct SpringBuffers {
  const gl::Context* context = nullptr;
  IncidentWords kind = IncidentWords::neighbors;  ///< what the incident words mean
  gl::Buffer incident_start;                      ///< BINDING_INCIDENT_START
  gl::Buffer incident;                            ///< BINDING_INCIDENT
  gl::Buffer springs;   ///< BINDING_SPRINGS: packed_springs(), with words that name springs alone
  gl::Buffer lattices;  ///< BINDING_LATTICES, if the words leave lattices out; else a table without any
  std::vector<std::uint32_t> starts;  ///< what incident_start holds
  std::uint32_t listed = 0;           ///< particles that have words
  /// BINDING_CELLS and BINDING_CELL_BODIES: what words beside cells leave out; empty handles where there is
  /// nothing.
  gl::Buffer cells, cell_bodies;
  std::uint32_t class_width = 0;             ///< CellBlocks::class_width
  std::array<std::uint32_t, 2> blocks = {};  ///< plain and mixed ones with particles

  std::uint64_t bytes() const {
    return incident_start.bytes() + incident.bytes() + springs.bytes() + lattices.bytes() + cells.bytes() +
           cell_bodies.bytes();
  }
};

/// Bytes of them, without making them.
std::uint64_t spring_buffer_bytes(const Model& model, IncidentWords kind);

/// Whether the model has lattices, and not too many for words beside them.
bool has_lattices(const Model& model);
/// Whether it has bodies of cells for words beside cells.
bool has_cells(const Model& model);

/// Errors: as incident_springs and Buffer::create. Words beside lattices and beside cells take a model for
/// which has_lattices() and has_cells().
Result<std::shared_ptr<const SpringBuffers>> make_spring_buffers(gl::Context& context, const Model& model,
                                                                 IncidentWords kind);

/// Whether both models' springs are the same words on the device; constants of their classes do not matter.
bool same_springs(const Model& a, const Model& b);

/// A state on the device. The buffers must outlive every use of it.
struct DeviceState {
  const gl::Buffer* particles = nullptr;  ///< the model's: layout::Particle each
  /// The model's balls from item first_ball on: layout::Ball each. Null draws none; not looked at where the
  /// model has none.
  const gl::Buffer* balls = nullptr;
  std::uint32_t first_ball = 0;
  std::uint64_t step = 0;  ///< steps since the run's start: how far balls have turned since the last image
  /// The model's springs, for colors that show what they do; null, or with words that name springs or leave
  /// bodies of cells out: images make their own.
  const SpringBuffers* springs = nullptr;
  /// Of the inputs that hold, for colors of springs whose rest lengths follow them.
  std::span<const double> channels = {};
};

}  // namespace aspic
