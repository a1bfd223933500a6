#include "render/frame_passes.h"

namespace aspic {

std::vector<std::string> frame_pass_names() {
  return {"backdrop",  "bounds and turns", "skin",      "colors by value",   "light maps",
          "thickness", "terrain",          "balls",     "springs",           "particles",
          "sky",       "sheets",           "far glass", "far walls",         "behind",
          "jelly",     "near glass",       "marks",     "samples to pixels", "text"};
}

}  // namespace aspic
