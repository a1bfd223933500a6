#pragma once
// Other programs that simulate the same lattice, as contestants of a benchmark (README.md).
#include <memory>
#include <string>
#include <vector>

#include "cli/bench.h"

namespace aspic::peers {

using cli::Contestant, cli::Measurement;

/// A program of bench/peers/peers.txt.
struct PeerProgram {
  std::string name;
  int largest = 0;  ///< particles per edge
  std::vector<std::string> words;
};

/// The peers of those names, all for none. Error (usage): there is no such peer, or this program was not
/// built in a checkout.
Result<std::vector<PeerProgram>> find_peers(const std::vector<std::string>& names);

/// The lattice that peers simulate too. Error (usage): the scene is something else than a cube of equal
/// springs in free fall with explicit Euler; the sentence says what.
struct PeerLattice {
  double edge = 0.0, height = 0.0;  ///< of the cube and of its center [m]
  double mass = 0.0, stiffness = 0.0, damping = 0.0, timestep = 0.0, gravity = 0.0;
  std::uint64_t most_steps = 0;  ///< before anything touches the ground
};
Result<PeerLattice> peer_lattice(const ModelSettings& settings, const Model& model);

/// Starts a peer, has it checked against the reference, and makes it ready with `size` particles per edge.
/// One that fails its check never runs. Error (io): it cannot be started or does not answer.
Result<std::unique_ptr<Contestant>> make_peer_contestant(const PeerProgram& program,
                                                         const ModelSettings& settings,
                                                         const PeerLattice& lattice, const Measurement& like);

}  // namespace aspic::peers
