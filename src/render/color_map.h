#pragma once
// Colors of the image: the course's spring colors, bodies, and a perceptually uniform scale.
#include <array>
#include <cstddef>
#include <vector>

#include "aspic/scene.h"

namespace aspic {

/// Linear light, red, green, blue, each 0…1.
using Color = std::array<float, 3>;

/// Followed by a fourth component.
std::array<float, 4> with_alpha(const Color& color, double alpha);

/// IEC 61966-2-1: an encoded value 0…1 to linear light and back.
double srgb_to_linear(double encoded);
double linear_to_srgb(double linear);

/// Oklab (Ottosson, 2020): lightness and two opponent axes. Equal distances look about equally different.
using Oklab = std::array<double, 3>;
Color from_oklab(const Oklab& lab);

/// A scale of colors: 256 of them, RGBA with 8 bits each, sRGB encoded. Neighbors are equally far apart in
/// Oklab, up to the rounding to 8 bits, over the complete scale, or over each half of blue-red. Lightness
/// rises evenly, so that a scale also reads in gray: from dark violet over blue and green to bright yellow;
/// from black over red to bright yellow (heat); in gray. Blue-red rises from blue to light gray in the middle
/// and falls to red. `map` is none but automatic.
std::vector<std::byte> color_map_texels(ScaleMap map);

/// The map that `automatic` means for a color; other maps are themselves.
ScaleMap chosen_map(const ViewSettings& view);

/// Structural cyan, shear yellow, bending green, as the course drew them.
Color spring_color(SpringType type);

/// The flesh of the body of that index; repeats after eight.
Color body_color(std::size_t body);

/// Bodies that show no material: neutral.
Color neutral_body_color();

}  // namespace aspic
