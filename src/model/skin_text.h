#pragma once
// A mesh as one line of text, which scenes keep (docs/meshes.md, "The skin").
#include <optional>
#include <string>
#include <string_view>

#include "model/triangle_mesh.h"

namespace aspic {

/// Steps in a unit, to which vertices are rounded.
inline constexpr double skin_steps = 2048.0;

/// Vertices are rounded to steps, in which each is written as the difference from the one
/// before, as the corners of triangles are; numbers are of digits in base 32, the lowest first, after a bit
/// for the sign.
std::string to_skin_text(const TriangleMesh& mesh);

/// The mesh of such a text, of which blanks and line ends are passed over; nothing if it is none: a character
/// that is no digit, a number that is cut short or beyond ±2³¹, numbers that are missing or too many, a
/// corner that is no vertex.
std::optional<TriangleMesh> mesh_of_skin_text(std::string_view text);

}  // namespace aspic
