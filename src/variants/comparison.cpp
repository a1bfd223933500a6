#include "variants/comparison.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <utility>

#include "base/printable.h"
#include "render/tiles.h"
#include "scene/short_keys.h"

namespace aspic {

Result<Difference> parse_difference(const std::string& text) {
  const std::size_t equals = text.find('=');
  if (equals == std::string::npos || equals == 0 || equals + 1 == text.size())
    return fail(ErrorCode::usage,
                "\"{}\" is not KEY=VALUE, such as integrator=implicit-euler, h=0.002, k=500, "
                "backend=reference or any key of the scene.",
                printable_line(text));
  return Difference{text.substr(0, equals), text.substr(equals + 1)};
}

Result<std::vector<Variant>> variants_of(const Scene& scene, const BackendChoice& backend,
                                         const std::vector<Difference>& differences) {
  if (differences.size() >= most_compared)
    return fail(ErrorCode::usage,
                "{} differences are given; Aspic compares at most {} runs with the scene's own.",
                differences.size(), most_compared - 1);
  std::vector<Variant> runs = {{scene, backend}};
  for (const Difference& difference : differences) {
    auto run = varied(scene, backend, std::span(&difference, 1));
    if (!run) {
      return fail(run.error(), "cannot run the variant {}={}:\n{}", printable_line(difference.key),
                  printable_line(difference.value), run.error().what);
    }
    runs.push_back(std::move(*run));
  }
  return runs;
}

std::vector<OverlayLine> label_of(const std::vector<Difference>& differences, const Scene& scene,
                                  const std::string& backend) {
  std::vector<OverlayLine> label;
  for (const Difference& difference : differences) {
    const std::string title = title_of(difference.key);
    if (std::ranges::find(label, title, &OverlayLine::label) == label.end())
      label.push_back({title, value_of(difference.key, scene, backend)});
  }
  return label;
}

namespace {

/// "implicit Euler", "h 0.0005 s", "shear stiffness 20 N/m".
std::string short_difference(const std::string& key, const Scene& scene, const std::string& backend) {
  const std::string value = value_of(key, scene, backend);
  if (key == backend_key || key == "integrator" || key == "simulation.integrator") return value;
  std::string name = title_of(key);
  // The symbol of a short name; of a path what is after its table.
  if (find_short_key(key)) {
    name = name.substr(name.rfind(' ') + 1);
  } else {
    const std::size_t list = name.find("].");
    name = name.substr(list == std::string::npos ? name.find('.') + 1 : list + 2);
    std::ranges::replace(name, '.', ' ');
    std::ranges::replace(name, '-', ' ');
  }
  return fmt::format("{} {}", name, value);
}

}  // namespace

std::string short_name(std::size_t run, const std::vector<Difference>& differences, const Scene& scene,
                       const std::string& backend) {
  if (run > 0) return short_difference(differences[run - 1].key, scene, backend);
  std::vector<std::string> parts;
  for (const Difference& difference : differences) {
    std::string part = short_difference(difference.key, scene, backend);
    if (std::ranges::find(parts, part) == parts.end()) parts.push_back(std::move(part));
  }
  return fmt::format("{}", fmt::join(parts, ", "));
}

std::string numbered_path(const std::string& path, std::size_t number) {
  std::filesystem::path numbered(path);
  const std::string name =
      fmt::format("{}-{}{}", numbered.stem().string(), number, numbered.extension().string());
  return numbered.replace_filename(name).string();
}

}  // namespace aspic
