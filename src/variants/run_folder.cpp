#include "variants/run_folder.h"

#include <fmt/format.h>
#include <unistd.h>

#include <array>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <system_error>
#include <type_traits>
#include <variant>

#include "aspic/version.h"
#include "base/files.h"
#include "io/atomic_file.h"
#include "variants/sweep_figures.h"

namespace aspic {
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

Status make_folder(const std::string& path) {
  std::error_code error;
  std::filesystem::create_directories(path, error);
  return error ? Status(file_error("make", path, error.value())) : Status();
}

}  // namespace

std::string_view name_of(RunOutcome outcome) {
  constexpr std::array<std::string_view, 4> names = {"ok", "diverged", "rejected", "failed"};
  return names[static_cast<std::size_t>(outcome)];
}

std::optional<RunOutcome> outcome_named(std::string_view name) {
  for (const RunOutcome outcome :
       {RunOutcome::ok, RunOutcome::diverged, RunOutcome::rejected, RunOutcome::failed})
    if (name_of(outcome) == name) return outcome;
  return std::nullopt;
}

std::string run_file(const SweepRun& run, const RunRow& row, const std::string& scene) {
  Json values = Json::object();
  for (const auto& [key, value] : run.values) values[key] = json_of(value);
  const Json file = {{"aspic", ASPIC_VERSION},
                     {"key", run.key},
                     {"scene", scene},
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
  return file.dump(1, ' ', true, Json::error_handler_t::replace) + "\n";
}

std::optional<RunRow> row_in(const std::string& text) {
  try {
    const Json file = Json::parse(text);
    const auto outcome = outcome_named(file.at("outcome").get<std::string>());
    if (!outcome || *outcome == RunOutcome::failed) return std::nullopt;
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
  } catch (const Json::exception&) {
    return std::nullopt;
  }
}

Status RunFolder::make(const Scene& scene) const {
  ASPIC_CHECK(make_folder(path_ + "/runs"));
  ASPIC_CHECK(make_folder(path_ + "/scenes"));
  const std::string file = fmt::format("{}/scenes/{}.toml", path_, scene_key(scene));
  std::error_code ignored;
  if (std::filesystem::exists(file, ignored)) return {};
  ASPIC_TRY(auto out, AtomicFile::create(file, Overwrite::allow));
  ASPIC_CHECK(out.write(to_toml(scene)));
  return out.commit();
}

std::optional<std::string> RunFolder::read(const std::string& key) const {
  auto text = read_regular_file(file(key, "json"), largest_run_file);
  if (!text || text->size > largest_run_file) return std::nullopt;
  const Json run = Json::parse(text->content, nullptr, false);
  if (!run.is_object() || run.value("key", Json()) != key || !run.value("outcome", Json()).is_string())
    return std::nullopt;
  for (const char* name : {"values", "figures", "metrics"})
    if (!run.value(name, Json::object()).is_object()) return std::nullopt;
  for (const Json& metric : run.value("metrics", Json::object()))
    if (!metric.is_object()) return std::nullopt;
  return std::move(text->content);
}

Status RunFolder::write(const std::string& key, std::string_view ending, std::string_view content) const {
  const std::string path = file(key, ending);
  // A pipe would be waited for.
  if (is_device_or_pipe(path)) ::unlink(path.c_str());
  ASPIC_TRY(auto out, AtomicFile::create(path, Overwrite::allow));
  ASPIC_CHECK(out.write(content));
  return out.commit(false);  // a damaged one is made again
}

std::string RunFolder::file(const std::string& key, std::string_view ending) const {
  return fmt::format("{}/runs/{}.{}", path_, key, ending);
}

}  // namespace aspic
