#pragma once
// What an image is made of, as its cost is told apart.
#include <cstddef>
#include <string>
#include <vector>

namespace aspic {

/// In the order of drawing. Passes that an image does without take next to no time.
enum class FramePass {
  backdrop,
  bounds,
  skin,
  quantity,
  light_maps,
  thickness,
  surroundings,
  balls,
  springs,
  particles,
  sky,
  sheets,
  far_glass,
  jelly_far,
  behind,
  jelly,
  glass,
  marks,
  resolve,
  text,
  count
};

/// Their names, in that order.
std::vector<std::string> frame_pass_names();

}  // namespace aspic
