#pragma once
// What a page that simulates needs of a scene besides run_facts(), and the module that it runs.
#include <nlohmann/json_fwd.hpp>
#include <string_view>

#include "aspic/scene.h"
#include "aspic/solver.h"
#include "base/result.h"

namespace aspic::page {

/// The reference as WebAssembly, a raw deflate stream of it. Error (io): this program was built without, and
/// what makes it.
Result<std::string_view> live_module();

/// Whether a page that simulates can repeat a run: it computes in single precision, exactly, and has no
/// hands. `inputs`: there are any. Errors: live_module(); usage.
Status check_live(Precision precision, Arithmetic arithmetic, bool inputs);

/// The scene as TOML, and in groups the rows of the parameter table that a reader may
/// change: those that are live and have a say in the motion, but for the places of terrain, whose surfaces
/// the page holds. `sheets`: there are cloths or nets, with which browsers can get other bits
/// (docs/determinism.md, "Denormal numbers").
nlohmann::ordered_json live_facts(const Scene& scene);

}  // namespace aspic::page
