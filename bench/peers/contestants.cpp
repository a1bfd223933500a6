#include "peers/contestants.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <sstream>
#include <thread>

#include "base/files.h"
#include "io/child_process.h"
#include "model/integrator.h"
#include "model/terrain.h"

namespace aspic::peers {

using cli::Json, cli::PeerCheck, cli::Took;

namespace {

namespace fs = std::filesystem;

/// The check: a small cube, far from all ground and close to the origin, where single precision is finest,
/// starts stretched by a twentieth and is let go for 50 steps.
constexpr int check_size = 6;
constexpr std::uint64_t check_steps = 50;
constexpr double check_stretch = 1.05;

/// What a peer says of itself.
struct Hello {
  std::string name, version;
  unsigned threads = 1;
  Integrator integrator = Integrator::explicit_euler;
  double damping = 0.0;    ///< [N·s/m]
  double deviation = 0.0;  ///< of the motion that its formula differs from Aspic's by, as a share
  bool velocities_from_positions = false;
  std::uint64_t springs = 0;
};

/// A running peer.
class Peer {
 public:
  static Result<Peer> start(const PeerProgram& program, const PeerLattice& l, int size, double stretch) {
    std::vector<std::string> words = program.words;
    const auto add = [&](const char* option, const auto& value) {
      words.insert(words.end(), {option, fmt::format("{}", value)});
    };
    add("--size", size);
    add("--edge", l.edge);
    add("--height", l.height);
    add("--mass", l.mass);
    add("--stiffness", l.stiffness);
    add("--damping", l.damping);
    add("--timestep", l.timestep);
    add("--gravity", l.gravity);
    add("--stretch", stretch);
    add("--threads", std::max(1u, std::thread::hardware_concurrency()));
    auto child = ChildProcess::start(words, ChildProcess::Output::answers);
    if (!child) {
      return fail(ErrorCode::io, "{} scripts/peers.sh installs what peers need.", child.error().what);
    }
    Peer peer(std::move(*child));
    ASPIC_TRY(const Json line, peer.line());
    Hello& hello = peer.hello_;
    hello.name = line.value("name", "");
    hello.version = line.value("version", "");
    hello.threads = line.value("threads", 1u);
    hello.damping = line.value("damping", 0.0);
    hello.deviation = line.value("deviation", 0.0);
    hello.velocities_from_positions = line.value("velocities_from_positions", false);
    hello.springs = line.value("springs", std::uint64_t{0});
    const std::string word = line.value("integrator", "");
    const auto known =
        std::ranges::find_if(all_integrators, [&](Integrator i) { return name_of(i) == word; });
    if (known == std::end(all_integrators))
      return fail(ErrorCode::io, "it names no integrator of Aspic: {}.", line.dump());
    hello.integrator = *known;
    return peer;
  }

  const Hello& hello() const { return hello_; }

  /// `word`: "run", or "positions" for the positions too.
  Result<Json> ask(std::string_view word, std::uint64_t steps) {
    const std::string text = fmt::format("{} {}\n", word, steps);
    (void)child_.write(std::as_bytes(std::span(text)));
    return line();
  }

 private:
  explicit Peer(ChildProcess child) : child_(std::move(child)) {}

  Result<Json> line() {
    const auto text = child_.line();
    if (!text) {
      (void)child_.finish();
      return fail(ErrorCode::io, "it ended instead of answering. Its last words:\n{}", child_.last_lines(4));
    }
    Json json = Json::parse(*text, nullptr, false);
    if (!json.is_object()) return fail(ErrorCode::io, "it answered what is no JSON object: {}", *text);
    return json;
  }

  ChildProcess child_;
  Hello hello_;
};

/// How far the center of free particles that start at rest falls in n steps [m]: explicit Euler moves by the
/// velocity at a step's start, symplectic Euler by that at its end.
double fall(Integrator integrator, const PeerLattice& l, std::uint64_t steps) {
  const auto n = static_cast<double>(steps);
  const double sum = integrator == Integrator::symplectic_euler ? n * (n + 1) / 2 : n * (n - 1) / 2;
  return l.gravity * l.timestep * l.timestep * sum;
}

/// How far single precision may take a particle from where exact arithmetic has it after n steps [m], from a
/// start stretched by `strain`. With u = 2⁻²⁴, a step rounds the position, u·X, the velocity, u·V, and the
/// forces of up to 32 springs of lengths up to 2s: five roundings of a length, which count k times, and six
/// of the tension itself. Where velocities are differences of positions they are off by 2u·X/h. An error of
/// the velocity acts on all later positions. The factor 2 is for what the damped lattice makes of an error
/// before it decays.
double rounding_bound(const PeerLattice& l, int size, std::uint64_t steps, double strain,
                      bool velocities_from_positions) {
  const double u = std::ldexp(1.0, -24), h = l.timestep, n = static_cast<double>(steps);
  const double longest = 2.0 * l.edge / (size - 1), stretch = strain * longest;
  // The lattice's fastest vibration is at most √(18k/m) (docs/physics.md, section 2).
  const double V = l.gravity * h * n + stretch * std::sqrt(18.0 * l.stiffness / l.mass);
  const double X = std::abs(l.height) + 0.5 * l.edge * (1.0 + strain) + V * h * n;
  const double force = 32 * u * (5 * l.stiffness * longest + 6 * (l.stiffness * stretch + l.damping * V));
  const double velocity = u * V + h / l.mass * force + (velocities_from_positions ? 2 * u * X / h : 0.0);
  return 2 * (n * u * X + n * h * n * velocity / 2);
}

/// The reference's positions [m] of the check, in double precision by the peer's integrator.
Result<std::vector<Vec3>> expected_positions(ModelSettings settings, const Hello& hello) {
  settings.terrain.clear();
  settings.simulation.integrator = hello.integrator;
  CubeSettings& cube = settings.cubes.front();
  cube.particles_per_edge = check_size;
  cube.position.y = 0.0;
  cube.structural.damping = cube.shear.damping = cube.bending.damping = hello.damping;
  ASPIC_TRY(auto model, build_model(settings));
  ASPIC_TRY(auto backend, make_backend({&reference_backend(), Precision::double_}, std::move(model)));
  State state = initial_state(backend.solver->model(), Precision::double_);
  for (Vec3& x : state.position) x.y *= check_stretch;
  ASPIC_CHECK(backend.solver->load(state));
  ASPIC_TRY(const auto advanced, backend.solver->advance(check_steps));
  if (advanced.divergence) return fail(ErrorCode::diverged, "the reference diverges in the check.");
  ASPIC_TRY(state, backend.solver->state());
  return state.position;
}

/// Compares a peer's motion with the reference's.
Result<PeerCheck> checked(const PeerProgram& program, const ModelSettings& settings, PeerLattice lattice) {
  lattice.height = 0.0;
  ASPIC_TRY(auto peer, Peer::start(program, lattice, check_size, check_stretch));
  const Hello& hello = peer.hello();
  ASPIC_TRY(const auto expected, expected_positions(settings, hello));
  ASPIC_TRY(const auto answer, peer.ask("positions", check_steps));
  const auto x = answer.value("positions", std::vector<double>());
  if (x.size() != 3 * expected.size())
    return fail(ErrorCode::io, "it answered {} coordinates for {} particles.", x.size(), expected.size());
  PeerCheck check;
  check.steps = check_steps;
  const double fallen = fall(hello.integrator, lattice, check_steps);
  const double rounding =
      rounding_bound(lattice, check_size, check_steps, check_stretch - 1.0, hello.velocities_from_positions);
  double moved = 0.0, height = 0.0;  // moved: by springs alone
  const double spacing = lattice.edge / (check_size - 1);
  for (std::size_t i = 0; i < expected.size(); ++i) {
    const double j = static_cast<double>(i / check_size % check_size);
    const double start = check_stretch * (-lattice.edge / 2 + j * spacing);
    moved = std::max(moved, std::abs(expected[i].y + fallen - start));
    height += x[3 * i + 1] / static_cast<double>(expected.size());
    const double off = length(Vec3{x[3 * i], x[3 * i + 1], x[3 * i + 2]} - expected[i]);
    if (!(off <= check.deviation)) check.deviation = off;  // NaN too
  }
  check.bound = rounding + hello.deviation * moved;
  check.fall = std::abs(height + fallen);
  check.fall_bound = rounding;
  check.passed = check.deviation <= check.bound && check.fall <= check.fall_bound;
  return check;
}

class PeerContestant final : public Contestant {
 public:
  PeerContestant(Measurement measurement, Peer peer, const PeerLattice& lattice)
      : Contestant(std::move(measurement)), peer_(std::move(peer)), lattice_(lattice) {}

  /// Also checks the fall of every run.
  Result<Took> run(std::uint64_t steps) override {
    ASPIC_TRY(const auto answer, peer_.ask("run", steps));
    const Hello& hello = peer_.hello();
    const double off =
        std::abs(answer.value("height", 0.0) - lattice_.height + fall(hello.integrator, lattice_, steps));
    const double bound = rounding_bound(lattice_, m.size, steps, 0.0, hello.velocities_from_positions);
    if (!(off <= bound) && m.peer->passed)
      m.peer = PeerCheck{false, steps, m.peer->deviation, m.peer->bound, off, bound};
    return Took{answer.value("seconds", 0.0), answer.value("processor_seconds", 0.0)};
  }

 private:
  Peer peer_;
  PeerLattice lattice_;
};

/// bench/peers in the directories above this program, up to the root; empty if there is none.
fs::path checkout_of(const fs::path& program) {
  std::error_code error;
  for (fs::path at = program.parent_path(); at != at.root_path(); at = at.parent_path()) {
    if (fs::exists(at / "bench/peers/peers.txt", error)) return at;
  }
  return {};
}

}  // namespace

Result<std::vector<PeerProgram>> find_peers(const std::vector<std::string>& names) {
  std::error_code error;
  const fs::path program = fs::read_symlink("/proc/self/exe", error);
  const fs::path source = checkout_of(program);
  if (source.empty()) {
    return fail(ErrorCode::usage, "peers are in a checkout of the source, and {} is not below one.",
                program.string());
  }
  ASPIC_TRY(const auto text, read_file(source / "bench/peers/peers.txt"));
  std::vector<PeerProgram> all;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    if (line.starts_with('#')) continue;
    PeerProgram peer;
    std::istringstream columns(line);
    if (!(columns >> peer.name >> peer.largest)) continue;
    for (std::string word; columns >> word;)
      peer.words.push_back(fmt::format(fmt::runtime(word), fmt::arg("source", source.string()),
                                       fmt::arg("build", program.parent_path().string())));
    if (!peer.words.empty()) all.push_back(std::move(peer));
  }
  if (names.empty()) return all;
  std::vector<PeerProgram> chosen;
  for (const std::string& name : names) {
    const auto known = std::ranges::find(all, name, &PeerProgram::name);
    if (known == all.end()) {
      std::vector<std::string> words;
      for (const PeerProgram& peer : all) words.push_back(peer.name);
      return fail(ErrorCode::usage, "--peer does not know \"{}\"; allowed: {}.", name,
                  fmt::join(words, ", "));
    }
    chosen.push_back(*known);
  }
  return chosen;
}

Result<PeerLattice> peer_lattice(const ModelSettings& settings, const Model& model) {
  const auto refuse = [](std::string_view what) {
    return fail(ErrorCode::usage, "peers simulate one free cube of equal springs with explicit Euler: {}.",
                what);
  };
  if (settings.cubes.size() != 1 || model.bodies.size() != 1 || model.ball_count() > 0)
    return refuse("this scene has other bodies or none");
  if (settings.simulation.integrator != Integrator::explicit_euler)
    return refuse("give --integrator explicit-euler");
  const CubeSettings& cube = settings.cubes.front();
  PeerLattice l;
  l.edge = cube.edge_length;
  l.height = cube.position.y;
  l.mass = model.mass[0];
  l.stiffness = model.spring_classes.front().stiffness;
  l.damping = model.spring_classes.front().damping;
  l.timestep = settings.simulation.timestep;
  l.gravity = -settings.simulation.gravity.y;
  for (const SpringClass& spring : model.spring_classes) {
    if (spring.stiffness != l.stiffness || spring.damping != l.damping) return refuse("its springs differ");
  }
  const Vec3 g = settings.simulation.gravity;
  if (g.x != 0.0 || g.z != 0.0 || !(l.gravity > 0.0)) return refuse("gravity must point down the y axis");
  if (cube.material) return refuse("its springs must be given by stiffness and damping, not by a material");
  if (cube.rotation.angle != 0.0 || length(cube.velocity) != 0.0 || cube.position.x != 0.0 ||
      cube.position.z != 0.0)
    return refuse("it must start at rest, upright, above the origin");
  if (std::ranges::any_of(model.inverse_mass, [](double w) { return w == 0.0; }))
    return refuse("no particle may be pinned");
  if (std::ranges::min(cube.lattice()) != std::ranges::max(cube.lattice()))
    return refuse("its edges must have the same number of particles");
  if (cube.lattice()[0] < 3) return refuse("it must have 3 particles per edge or more");
  // Distances change by at most as much as a particle moves.
  double room = 100.0;
  for (const Terrain& terrain : model.terrain) {
    for (const Vec3& x : model.initial_position) room = std::min(room, signed_distance(terrain, x));
    if (terrain.motion) return refuse("the ground must not move");
  }
  const double time = std::sqrt(2.0 * std::max(room - model.contact.distance, 0.0) / l.gravity);
  l.most_steps = static_cast<std::uint64_t>(0.95 * time / l.timestep);
  if (l.most_steps < 1) return refuse("it must not touch the ground");
  return l;
}

Result<std::unique_ptr<Contestant>> make_peer_contestant(const PeerProgram& program,
                                                         const ModelSettings& settings,
                                                         const PeerLattice& lattice,
                                                         const Measurement& like) {
  ASPIC_TRY(const auto check, checked(program, settings, lattice));
  ASPIC_TRY(auto peer, Peer::start(program, lattice, like.size, 1.0));
  const Hello& hello = peer.hello();
  Measurement m;
  m.name = m.backend = program.name;
  m.device = fmt::format("{} {}, {} thread{}", hello.name, hello.version, hello.threads,
                         hello.threads == 1 ? "" : "s");
  m.peer = check;
  m.integrator = hello.integrator;
  m.size = like.size;
  m.particles = like.particles;
  m.springs = hello.springs;
  m.timestep = like.timestep;
  if (hello.springs != like.springs) {
    return fail(ErrorCode::io, "it has {} springs instead of {}.", hello.springs, like.springs);
  }
  return std::unique_ptr<Contestant>(
      std::make_unique<PeerContestant>(std::move(m), std::move(peer), lattice));
}

}  // namespace aspic::peers
