#include "report/run_folder.h"

#include <fmt/format.h>
#include <unistd.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <system_error>
#include <type_traits>
#include <variant>

#include "aspic/version.h"
#include "base/files.h"
#include "base/printable.h"
#include "io/atomic_file.h"
#include "run/sweep_figures.h"

namespace aspic::report {
namespace {

using Json = nlohmann::ordered_json;

/// Far more than a run's file has: what is larger is none.
constexpr std::uint64_t largest_run_file = std::uint64_t{4} << 20;

Json json_of(const ParameterValue& value) {
  return std::visit(
      []<class T>(const T& v) -> Json {
        if constexpr (std::is_same_v<T, Vec3>) {
          return {v.x, v.y, v.z};
        } else if constexpr (std::is_same_v<T, PinnedSettings>) {
          Json all = Json::array();
          for (const std::string& name : v.names) all.push_back(name);
          for (const std::int64_t index : v.indices) all.push_back(index);
          return all;
        } else {
          return v;
        }
      },
      value);
}

Json json_of(const RunRow& row) {
  Json figures = Json::object();
  for (const RunFigure& figure : row.figures)
    figures[std::string(figure.name)] = figure.value ? Json(*figure.value) : Json();
  return figures;
}

std::string host_name() {
  char name[256] = {};
  return ::gethostname(name, sizeof name - 1) == 0 ? name : "";
}

/// Throws nlohmann::json::exception where the file lacks something.
std::optional<RunRow> row_in(const Json& file, const SweepRun& run) {
  if (file.at("key").get<std::string>() != run.key) return std::nullopt;
  const auto outcome = outcome_named(file.at("outcome").get<std::string>());
  if (!outcome || *outcome == Outcome::failed) return std::nullopt;
  RunRow row;
  row.outcome = *outcome;
  row.reason = file.at("reason").get<std::string>();
  row.steps = file.at("steps").get<std::uint64_t>();
  row.hash = file.at("hash").get<std::string>();
  row.seconds = file.at("seconds").get<double>();
  const Json& figures = file.at("figures");
  if (figures.empty()) return row;
  row.figures = figures_of({});
  for (RunFigure& figure : row.figures) {
    const Json& value = figures.at(std::string(figure.name));
    figure.value = value.is_null() ? std::nullopt : std::optional(value.get<double>());
  }
  return row;
}

Status make_folder(const std::string& path) {
  std::error_code error;
  std::filesystem::create_directories(path, error);
  return error ? Status(file_error("make", path, error.value())) : Status();
}

}  // namespace

Result<RunFolder> RunFolder::open(std::string path, const Scene& scene) {
  ASPIC_CHECK(make_folder(path + "/runs"));
  ASPIC_CHECK(make_folder(path + "/scenes"));
  const std::string name = scene_key(scene), file = fmt::format("{}/scenes/{}.toml", path, name);
  std::error_code ignored;
  if (!std::filesystem::exists(file, ignored)) {
    ASPIC_TRY(auto out, AtomicFile::create(file, Overwrite::allow));
    ASPIC_CHECK(out.write(to_toml(scene)));
    ASPIC_CHECK(out.commit());
  }
  return RunFolder(std::move(path), name);
}

Result<std::optional<RunRow>> RunFolder::read(const SweepRun& run) const {
  const std::string file = file_of(run);
  std::error_code ignored;
  if (std::filesystem::is_directory(file, ignored))
    return fail(ErrorCode::io, "{} is a directory in the place of a run; move it, or give another --runs.",
                printable_line(file));
  const auto text = read_regular_file(file, largest_run_file);
  std::optional<RunRow> row;
  if (!text || text->size > largest_run_file) return row;
  try {
    row = row_in(Json::parse(text->content), run);
  } catch (const nlohmann::json::exception&) {
    // damaged
  }
  return row;
}

Status RunFolder::write(const SweepRun& run, const RunRow& row) const {
  Json values = Json::object();
  for (const auto& [key, value] : run.values) values[key] = json_of(value);
  const Json file = {{"aspic", ASPIC_VERSION},
                     {"key", run.key},
                     {"scene", scene_},
                     {"values", values},
                     {"backend", run.backend_words},
                     {"precision", name_of(run.backend.precision)},
                     {"steps_asked", run.steps},
                     {"outcome", name_of(row.outcome)},
                     {"reason", row.reason},
                     {"steps", row.steps},
                     {"figures", json_of(row)},
                     {"hash", row.hash},
                     {"solver", row.solver},
                     {"seconds", row.seconds},
                     {"host", host_name()}};
  const std::string path = file_of(run);
  // A pipe would be waited for.
  if (is_device_or_pipe(path)) ::unlink(path.c_str());
  ASPIC_TRY(auto out, AtomicFile::create(path, Overwrite::allow));
  ASPIC_CHECK(out.write(file.dump(1, ' ', true, Json::error_handler_t::replace) + "\n"));
  return out.commit();
}

}  // namespace aspic::report
