#pragma once
// Reads Configuration.txt of the 2018 framework, the goal net with balls: a line `*Key`, its value on the
// next line, `#` begins a comment.
#include <string>
#include <string_view>
#include <vector>

#include "aspic/scene.h"
#include "base/result.h"

namespace aspic {

/// What came of a file.
struct ImportedConfiguration {
  Scene scene;
  std::vector<std::string> notes;  ///< what the scene does not carry, each naming its line, in file order
};

/// The scene a configuration describes: its author, net, integrator, time step and view on the ground of the
/// built-in scene `penalty`, whose launcher takes the place of shots by hand. Unknown keys and keys without a
/// meaning here become notes. Error (scene_rejected), all at once, each naming its line: a value that is
/// missing, no number or out of range, a key given twice, a line that is neither key nor value.
Result<ImportedConfiguration> import_configuration(std::string_view text, const std::string& file_name);

/// The scene as TOML, headed by comments that name its origin and the settings it does not carry.
std::string imported_toml(const ImportedConfiguration& imported, const std::string& file_name);

}  // namespace aspic
