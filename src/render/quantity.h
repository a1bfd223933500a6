#pragma once
// What colours mean: range, unit and legend.
#include <array>

#include "model/model.h"
#include "render/overlay.h"
#include "scene/scene.h"

namespace aspic {

/// Lower and upper end of a colour scale.
using QuantityRange = std::array<double, 2>;

/// The range shown where none is asked for, a round number that suits the model and stays the same all
/// through a run, so that colours can be compared between frames: strain 0…0.2; speed 0 to that of a free
/// fall from the highest particle to the terrain (at least 1 m/s); force 0 to the one that stretches the
/// stiffest spring by a tenth (at least 1 N). Other colourings have no range: (0, 1).
QuantityRange default_range(const Model& model, ViewColour colour);

/// The smallest of 1, 2, 5 times a power of ten that is not below `value` > 0.
double round_up(double value);

/// The legend of a coloured quantity, or of the types that are drawn. Empty for `material` without springs.
Legend legend_for(const ViewSettings& view, const QuantityRange& range);

}  // namespace aspic
