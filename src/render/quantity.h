#pragma once
// What colors mean: range, unit and legend.
#include <array>

#include "aspic/scene.h"
#include "model/model.h"
#include "render/overlay.h"

namespace aspic {

/// Lower and upper end of a color scale.
using QuantityRange = std::array<double, 2>;

/// The range shown where none is asked for, a round number that suits the model and stays the same all
/// through a run, so that colors can be compared between frames: strain 0…0.2, signed −0.1…0.1; speed 0 to
/// that of a free fall from the highest particle to the terrain (at least 1 m/s); force and energy 0 to what
/// stretches the stiffest spring by a tenth (at least 1 N, 10⁻³ J). Other colorings have no range: (0, 1).
QuantityRange default_range(const Model& model, ViewColor color);

/// Whether the ends of a view's scale depend on what the image shows.
bool follows_image(const ViewSettings& view);

/// The range of a view's scale. `seen`: the least and largest value that the image shows, of a view that
/// follows it; with nothing to see, or none that is finite, that of the model. Automatic and symmetric ends
/// are round and span a thousandth of the model's range at least, so that noise stays one color; an upper
/// end below the lower one is legal and turns the scale round.
QuantityRange range_for(const Model& model, const ViewSettings& view, const QuantityRange& seen);

/// Whether images of two views are to have the same ends, so that their colors can be compared: of one
/// color and one way to choose its scale.
bool share_scale(const ViewSettings& a, const ViewSettings& b);

/// The ends that hold what two ranges of views that share a scale hold.
QuantityRange widest(const QuantityRange& a, const QuantityRange& b);

/// The smallest of 1, 2, 5 times a power of ten that is not below `value` > 0.
double round_up(double value);

/// The legend of a colored quantity, or of the types that are drawn. Empty for `material` without springs.
Legend legend_for(const ViewSettings& view, const QuantityRange& range);

}  // namespace aspic
