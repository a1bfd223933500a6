// Of keys that exclude each other, what arguments choose in the place of the scene's.
#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <string>

#include "scene/parameters.h"
#include "scene/reader.h"

namespace aspic::overrides {
namespace {

using diagnostics::Position;
using reader::Reader;

/// Where the first argument wrote the path or a value below it.
std::optional<Position> first_override(const Reader& reader, const std::string& path) {
  std::optional<Position> first;
  std::string at;
  for (const std::string& written : reader.written_in(path)) {
    const Position& key = reader.written().at(written).key;
    const bool deeper = first && key.source == first->source && written.starts_with(at);
    if (key.source == 0 || (first && key.source >= first->source && !deeper)) continue;
    first = key;
    at = written + ".";
  }
  return first;
}

}  // namespace

void resolve_material(Reader& reader, const BodyInList& body, bool had_material) {
  const std::string section = fmt::format("{}[]", body.list);
  const std::string material_path = path_text(section + ".material", body.index);
  const auto written = reader.written().find(material_path);
  if (written != reader.written().end())
    had_material = written->second.key.source == 0;
  else if (!had_material)
    return;
  const std::optional<Position> set_material = first_override(reader, material_path);
  const std::vector<std::string> keys = reader.explicit_keys(section, body.index);
  std::optional<Position> set_explicit;
  for (const std::string& key : keys) {
    const std::string path = fmt::format("{}[{}].{}", body.list, body.index, key);
    if (had_material && reader.written().at(path).key.source == 0) return;  // the file is wrong by itself
    const auto at = first_override(reader, path);
    if (at && (!set_explicit || at->source < set_explicit->source)) set_explicit = at;
  }
  const bool all_set = std::ranges::all_of(parameters(), [&](const Parameter& p) {
    const auto place = reader.written().find(path_text(p.path, body.index));
    return p.belonging != Belonging::explicit_springs || p.section() != section ||
           (place != reader.written().end() && place->second.key.source > 0);
  });
  if (set_explicit && all_set && !set_material) {
    material_place(reader.scene().model, section, body.index)->reset();
    return reader.forget(material_path);
  }
  if (set_material && set_explicit) {
    reader.fail(std::max(*set_material, *set_explicit,
                         [](const Position& a, const Position& b) { return a.source < b.source; }),
                fmt::format("a {} has either a material or masses and springs: these arguments give both",
                            body.list));
  } else if (set_explicit) {
    reader.fail(*set_explicit,
                fmt::format("this {} has a material, which sets its masses and springs; set "
                            "material.density, material.youngs-modulus or material.damping-ratio, or all of "
                            "particle-mass, structural, shear and bending with stiffness and damping",
                            body.list));
  } else if (!set_material) {
    return;
  }
  for (const std::string& key : keys) reader.forget(fmt::format("{}[{}].{}", body.list, body.index, key));
}

void resolve_shape(Reader& reader, std::size_t terrain) {
  const auto shape = reader.written().find(path_text("terrain[].shape", terrain));
  if (shape == reader.written().end() || shape->second.key.source == 0 || shape->second.problem) return;
  for (const Parameter& p : parameters()) {
    if (belongs_to_shape(p, reader.scene().model.terrain[terrain].shape)) continue;
    const std::string path = path_text(p.path, terrain);
    if (first_override(reader, path)) continue;
    p.clear(reader.scene(), terrain);
    reader.forget(path);
  }
}

}  // namespace aspic::overrides
