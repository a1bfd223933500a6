#pragma once
// A plane that is a slope by default.
#include "model/shapes/plane.h"

namespace aspic::shapes {

struct TiltedPlane : Plane {
  static constexpr std::string_view name = "tilted-plane", title = "tilted plane";
  static constexpr GeometryKey keys[] = {
      {"point", GeometryKind::place, Plane::keys[0].meaning, Vec3{0.0, 0.0, 0.0}},
      {"normal", GeometryKind::direction, Plane::keys[1].meaning, Vec3{1.0, 1.0, 0.0}}};
  static constexpr Vec3 drop = {1.0, 3.2, 0.0};
};

}  // namespace aspic::shapes
