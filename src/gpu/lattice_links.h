#pragma once
// The neighbors of lattice particles as GLSL.
#include <string>

namespace aspic::gl {

/// compute/lattice_links.glsl: EACH_LINK for ASPIC_LATTICE_RUN 4, from lattice_directions().
std::string lattice_links();

}  // namespace aspic::gl
