#include "run/backends.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <utility>

#include "base/memory.h"
#include "base/printable.h"
#include "cpu_parallel/cpu_solver.h"
#include "cpu_reference/reference_solver.h"
#include "model/counts.h"
#include "run/window_host.h"

namespace aspic {
namespace {

// ---- gpu ----

Result<Backend> make_gpu(SharedModel model, const BackendChoice& choice, const SolverHost& host) {
  Backend backend;
  gl::Context* context = host.context;
  std::shared_ptr<gl::Context> own;  // the solver holds it from then on
  if (context == nullptr) {
    ASPIC_TRY(own, gl::Context::create_headless());
    context = own.get();
  }
  ASPIC_TRY(auto directory, gl::shader_directory());
  GpuOptions options;
  options.force_path = choice.force_path;
  options.shader_directory = std::move(directory);
  options.share_springs_of = host.share_springs_of;
  options.arithmetic = host.arithmetic;
  options.spring_arithmetic = choice.arithmetic;
  ASPIC_TRY(auto solver, make_gpu_solver(*context, std::move(model), options));
  backend.device = context->info().renderer;
  backend.force_path = name_of(solver->force_path());
  backend.solver = std::move(solver);
  return backend;
}

/// Whether there is a software rasterizer where no hardware was found. EGL's list is asked first: to make a
/// context takes a while, but the environment may choose a device that is not in the list.
bool has_software_device() {
  const char* const variable = std::getenv("ASPIC_EGL_DEVICE");
  if (!(variable && *variable) && std::ranges::any_of(gl::list_devices(), &gl::EglDevice::software))
    return true;
  return gl::Context::create_headless().ok();
}

Suitability gpu_suitability(const gl::Context* window) {
  constexpr const char* software = "OpenGL is a software rasterizer here, which only the backend gpu uses";
  Suitability result;
  if (window == nullptr) {
    gl::ContextOptions options;
    options.device = gl::DeviceChoice::hardware;
    auto made = gl::Context::create_headless(options);
    if (!made && has_software_device()) return {false, software, "", nullptr};
    if (!made) return {false, "no OpenGL 4.3 device was found", made.error().what, nullptr};
    result.context = std::move(*made);
    window = result.context.get();
  }
  const gl::DeviceInfo& info = window->info();
  if (info.is_software) return {false, software, "", nullptr};
  result.suits = true;
  result.reason = fmt::format("{} is a hardware GPU with OpenGL 4.3 compute", info.renderer);
  return result;
}

// ---- cpu ----

/// A backend that needs nothing but its solver.
Result<Backend> on_processor(Result<std::unique_ptr<Solver>> made) {
  ASPIC_TRY(auto solver, std::move(made));
  Backend backend;
  backend.device = solver->description();
  backend.solver = std::move(solver);
  return backend;
}

Result<Backend> make_cpu(SharedModel model, const BackendChoice& choice, const SolverHost&) {
  return on_processor(make_cpu_solver(std::move(model), {choice.threads}));
}

/// A solver counts what it holds: threads and the kinds of bodies decide it.
std::optional<std::uint64_t> cpu_bytes(const Model& model) {
  const std::optional<std::uint64_t> memory = available_memory();
  if (memory && run_bytes(count(model)) > *memory) return std::nullopt;
  // The solver is destroyed before the caller's model, so it need not own it.
  const auto solver = make_cpu_solver(SharedModel(SharedModel(), &model));
  if (!solver) return std::nullopt;
  return (*solver)->bytes();
}

// ---- reference ----

Status check_reference_memory(const Model& model, Precision precision) {
  const std::uint64_t bytes = reference_bytes(model, precision);
  const std::optional<std::uint64_t> memory = available_memory();
  if (!memory || bytes <= *memory) return {};
  return fail(ErrorCode::scene_rejected,
              "the reference solver needs {} of memory for this scene and {} are available; use fewer "
              "particles or balls",
              human_bytes(bytes), human_bytes(*memory));
}

Result<Backend> make_reference(SharedModel model, const BackendChoice& choice, const SolverHost&) {
  ASPIC_CHECK(check_reference_memory(*model, choice.precision));
  return on_processor(make_reference_solver(std::move(model), choice.precision));
}

// ---- the table ----

constexpr Precision single_alone[] = {Precision::single};
constexpr Precision both_precisions[] = {Precision::single, Precision::double_};

constexpr BackendRow table[] = {
    {"gpu", "GPU", "OpenGL 4.3 compute shaders", single_alone, force_paths, true, make_gpu,
     [](const Model& model, const BackendChoice& choice) -> std::optional<std::uint64_t> {
       return gpu_bytes(model, choice.force_path);
     },
     gpu_suitability, true},
    {"cpu", "CPU", "threads and vector instructions", single_alone, nullptr, false, make_cpu,
     [](const Model& model, const BackendChoice&) { return cpu_bytes(model); },
     [](const gl::Context*) {
       return Suitability{true, "", "", nullptr};
     },
     false, true},
    {"reference", "reference", "one thread, Eigen, written for readability", both_precisions, nullptr, false,
     make_reference,
     [](const Model& model, const BackendChoice& choice) -> std::optional<std::uint64_t> {
       return reference_bytes(model, choice.precision);
     },
     [](const gl::Context*) {
       return Suitability{true, "", "", nullptr};
     }},
};

template <class T>
bool has(std::span<const T> values, T value) {
  return std::ranges::find(values, value) != values.end();
}

bool has_path(const BackendRow& row, ForcePath path) {
  return std::ranges::any_of(row.force_paths(), [&](const ForcePathRow& p) { return p.path == path; });
}

Error unknown_word(std::string_view what, std::string_view word, std::string_view allowed) {
  return fail(ErrorCode::usage, "unknown {} \"{}\"; allowed: {}.", what, printable_line(word), allowed);
}

/// Names of the rows for which something holds.
template <class Predicate>
std::vector<std::string_view> names_where(Predicate holds) {
  std::vector<std::string_view> names;
  for (const BackendRow& row : table)
    if (holds(row)) names.push_back(row.name);
  return names;
}

/// Something besides a force path that a choice may ask for, and not every row has.
struct Ability {
  bool (*asked)(const BackendChoice&);
  bool (*had)(const BackendRow&);
  std::string_view verb, object;  ///< what a row does that has it
};
constexpr Ability abilities[] = {
    {[](const BackendChoice& choice) { return choice.precision == Precision::single; },
     [](const BackendRow& row) { return has(row.precisions, Precision::single); }, "compute",
     "in single precision"},
    {[](const BackendChoice& choice) { return choice.precision == Precision::double_; },
     [](const BackendRow& row) { return has(row.precisions, Precision::double_); }, "compute",
     "in double precision"},
    {[](const BackendChoice& choice) { return choice.arithmetic == Arithmetic::fast; },
     [](const BackendRow& row) { return row.fast; }, "compute", "in fast arithmetic"},
    {[](const BackendChoice& choice) { return choice.threads > 0; },
     [](const BackendRow& row) { return row.threaded; }, "take", "a number of threads"},
};

/// The first thing asked for that the row does not have; null if there is none.
const Ability* lacking(const BackendRow& row, const BackendChoice& choice) {
  const auto* const found = std::ranges::find_if(
      abilities, [&](const Ability& ability) { return ability.asked(choice) && !ability.had(row); });
  return found == std::end(abilities) ? nullptr : found;
}

/// "only the reference computes in double precision"
std::string only_those_with(const Ability& ability) {
  const auto names = names_where(ability.had);
  return fmt::format("only the {} {}{} {}", fmt::join(names, " and the "), ability.verb,
                     names.size() == 1 ? "s" : "", ability.object);
}

std::string variant_of(std::string_view name_of_row, std::string_view force_path, Precision precision,
                       Arithmetic arithmetic) {
  std::string name(name_of_row);
  if (!force_path.empty()) name += fmt::format(":{}", force_path);
  if (precision == Precision::double_) name += ":double";
  if (arithmetic == Arithmetic::fast) name += ":fast";
  return name;
}

}  // namespace

std::span<const BackendRow> backends() {
  return table;
}

const BackendRow& contextless_backend() {
  return *std::ranges::find(backends(), false, &BackendRow::needs_context);
}

const BackendRow* find_backend(std::string_view name) {
  const auto* const found = std::ranges::find(table, name, &BackendRow::name);
  return found == std::end(table) ? nullptr : found;
}

const BackendRow& next_backend(const BackendRow& row) {
  const auto* const found = std::ranges::find(table, row.name, &BackendRow::name);
  return std::end(table) - found > 1 ? found[1] : *std::begin(table);
}

std::string backend_words() {
  std::string words = "auto";
  for (const BackendRow& row : table) words += fmt::format(", {}", row.name);
  return words;
}

std::vector<BackendInfo> list_backends() {
  std::vector<BackendInfo> list;
  for (const BackendRow& row : table)
    list.push_back(
        {row.name, row.title, row.summary, has(row.precisions, Precision::double_), row.fast, row.threaded});
  return list;
}

GpuSolver* gpu_of(const Backend& backend) {
  return dynamic_cast<GpuSolver*>(backend.solver.get());
}

gl::Context* context_of(const Backend& backend) {
  const GpuSolver* const gpu = gpu_of(backend);
  return gpu ? &gpu->context() : nullptr;
}

std::string Backend::variant() const {
  return variant_of(row->name, force_path, solver->precision(), arithmetic);
}

AutomaticChoice choose_automatically(const BackendChoice& choice, const gl::Context* window) {
  AutomaticChoice result;
  for (const BackendRow& row : table) {
    const Ability* const lacks = lacking(row, choice);
    Suitability found = lacks ? Suitability{} : row.suitability(window);
    if (lacks) found.reason = only_those_with(*lacks);
    // The backend that would have come first says why another is taken.
    if (result.reason.empty() || (found.suits && !found.reason.empty()))
      result.reason = std::move(found.reason);
    if (result.detail.empty()) result.detail = std::move(found.detail);
    if (!found.suits) continue;
    result.row = &row;
    result.context = std::move(found.context);
    return result;
  }
  // None suits, but one has what was asked for: a software rasterizer computes in fast arithmetic.
  const auto* const able =
      std::ranges::find_if(table, [&](const BackendRow& row) { return !lacking(row, choice); });
  if (able != std::end(table)) result.row = able;
  return result;
}

Result<const BackendRow*> parse_backend_name(std::string_view word) {
  if (word == "auto") return static_cast<const BackendRow*>(nullptr);
  if (const BackendRow* row = find_backend(word)) return row;
  return unknown_word("backend", word, backend_words());
}

Result<Precision> parse_precision(std::string_view word) {
  if (word == "single") return Precision::single;
  if (word == "double") return Precision::double_;
  return unknown_word("precision", word, "single, double");
}

Result<ForcePath> parse_force_path(std::string_view word) {
  if (word == "auto") return ForcePath::automatic;
  for (const ForcePathRow& row : force_paths())
    if (word == row.name) return row.path;
  return unknown_word("force path", word, force_path_words());
}

Result<Arithmetic> parse_arithmetic(std::string_view word) {
  for (const Arithmetic arithmetic : {Arithmetic::exact, Arithmetic::fast})
    if (word == name_of(arithmetic)) return arithmetic;
  return unknown_word("arithmetic", word, "exact, fast");
}

BackendChoice choice_for(const BackendRow* row, const BackendChoice& asked) {
  BackendChoice choice = asked;
  choice.row = row;
  if (!row) return choice;
  if (!has(row->precisions, choice.precision)) choice.precision = Precision::single;
  if (!has_path(*row, choice.force_path)) choice.force_path = ForcePath::automatic;
  if (!row->fast) choice.arithmetic = Arithmetic::exact;
  if (!row->threaded) choice.threads = 0;
  return choice;
}

std::string words_of(const BackendChoice& choice) {
  return variant_of(choice.row ? choice.row->name : "auto",
                    choice.force_path == ForcePath::automatic ? "" : name_of(choice.force_path),
                    choice.precision, choice.arithmetic);
}

Result<BackendChoice> parse_backend(std::string_view text, const BackendChoice& asked) {
  const std::size_t colon = text.find(':');
  ASPIC_TRY(const BackendRow* const row, parse_backend_name(text.substr(0, colon)));
  BackendChoice choice = choice_for(row, asked);
  while (text.find(':') != std::string_view::npos) {
    text.remove_prefix(text.find(':') + 1);
    const std::string_view word = text.substr(0, text.find(':'));
    if (const auto precision = parse_precision(word)) {
      choice.precision = *precision;
    } else if (const auto path = parse_force_path(word)) {
      choice.force_path = *path;
    } else if (const auto arithmetic = parse_arithmetic(word)) {
      choice.arithmetic = *arithmetic;
    } else {
      return unknown_word("backend option", word, "single, double, exact, fast, " + force_path_words());
    }
  }
  return choice;
}

Status check_choice(const BackendChoice& choice) {
  if (choice.row) {
    if (const Ability* const lacks = lacking(*choice.row, choice)) {
      Error error =
          fail(ErrorCode::usage, "the {} does not {} {}.", choice.row->name, lacks->verb, lacks->object);
      for (const std::string_view name : names_where(lacks->had)) error.remedies.push_back(use_backend(name));
      return error;
    }
  } else if (names_where([&](const BackendRow& row) { return !lacking(row, choice); }).empty()) {
    std::vector<std::string> wishes;
    for (const Ability& ability : abilities)
      if (ability.asked(choice)) wishes.push_back(only_those_with(ability));
    return fail(ErrorCode::usage, "no backend supports this combination: {}.", fmt::join(wishes, ", "));
  }
  if (choice.force_path == ForcePath::automatic) return {};
  const auto possible = [&](const BackendRow& row) {
    return !lacking(row, choice) && has_path(row, choice.force_path);
  };
  if (choice.row ? possible(*choice.row) : std::ranges::any_of(table, possible)) return {};
  const auto with_path =
      names_where([](const BackendRow& row) { return !row.force_paths().empty(); }).front();
  return advised(fail(ErrorCode::usage, "a force path applies to the {} backend only.", with_path),
                 {advice("omit it"), use_backend(with_path)});
}

Result<Backend> make_backend(const BackendChoice& choice, SharedModel model, const SolverHost& host) {
  ASPIC_CHECK(check_choice(choice));
  AutomaticChoice automatic;
  if (!choice.row) automatic = choose_automatically(choice, host.context);
  const BackendRow& row = choice.row ? *choice.row : *automatic.row;
  if (choice.force_path != ForcePath::automatic && !has_path(row, choice.force_path)) {
    const auto names = names_where([&](const BackendRow& r) { return has_path(r, choice.force_path); });
    return advised(fail(ErrorCode::no_device, "the force path {} needs the {} backend, but {}.",
                        name_of(choice.force_path), names.front(), automatic.reason),
                   {use_backend(names.front())});
  }
  SolverHost place = host;
  if (automatic.context) place.context = automatic.context.get();
  ASPIC_TRY(auto backend, row.make(std::move(model), choice, place));
  backend.row = &row;
  backend.arithmetic = choice.arithmetic;
  backend.reason = std::move(automatic.reason);
  return backend;
}

Result<Backend> make_backend(const BackendChoice& choice, SharedModel model) {
  return make_backend(choice, std::move(model), SolverHost{});
}

std::vector<BackendBytes> bytes_by_backend(const Model& model) {
  std::vector<BackendBytes> result;
  for (const BackendRow& row : table) {
    for (const Precision precision : row.precisions) {
      const auto add = [&](const ForcePathRow* path) {
        const BackendChoice choice = {&row, precision, path ? path->path : ForcePath::automatic};
        result.push_back({variant_of(row.name, path ? path->name : "", precision, Arithmetic::exact),
                          row.bytes(model, choice)});
      };
      if (row.force_paths().empty()) add(nullptr);
      for (const ForcePathRow& path : row.force_paths()) add(&path);
    }
  }
  return result;
}

}  // namespace aspic
