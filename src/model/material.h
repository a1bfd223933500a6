#pragma once
// Materials, and the spring constants that bodies make of them (docs/physics.md, section 2).
#include <optional>
#include <string>
#include <string_view>

#include "aspic/settings.h"
#include "base/result.h"

namespace aspic {

/// Young's modulus of the infinite lattice with springs of stiffness k in all its directions at spacing s, in
/// k/s.
inline constexpr double lattice_modulus = 7.3125;

/// The scene's material of that name, which is not empty; nullptr: it has none.
const MaterialSettings* find_material(const ModelSettings& settings, std::string_view name);

/// What a body's material is: itself, or the one that it names. Error (scene_rejected): there is none of that
/// name.
Result<MaterialSettings> material_of(const ModelSettings& settings, const MaterialSettings& of_body);

/// "…, which the scene does not have; …": about a name that find_material() does not find.
std::string unknown_material(const ModelSettings& settings, std::string_view name);

/// Springs between particles of `mass` [kg] in a lattice of spacing s [m]: k = E·s/7.3125, c = 2ζ√(k·m/2).
SpringSettings lattice_springs(const MaterialSettings& material, double spacing, double mass);

/// c = 2ζ√(k·m/2): the share ζ of critical damping between two such masses.
double damping_of(const MaterialSettings& material, double stiffness, double mass);

/// A cloth's mass of a particle and springs: those of a sheet with Young's modulus E and the thickness,
/// isotropic with Poisson's ratio 1/3. `along_width` and `along_height` are stiffnesses of the structural
/// springs; bending springs have a twentieth of them.
struct SheetSprings {
  double mass = 0.0;  ///< [kg]
  SpringSettings along_width, along_height, shear, bending_width, bending_height;
};
/// Error (scene_rejected): cells more than √3 times as long one way as the other, which no such springs
/// exist for. `cloth.material` must be there and hold numbers.
Result<SheetSprings> sheet_springs(const ClothSettings& cloth);

}  // namespace aspic
