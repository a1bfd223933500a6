// What the example leaves out of the public surface, as far as it makes no context. Exit code: the line that
// failed.
#include <aspic/aspic.h>

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace {

/// A sink outside the library.
class Counter : public aspic::FrameSink {
 public:
  aspic::Status write(std::span<const std::byte>) override { return {}; }
  aspic::Status finish() override { return {}; }
  const std::string& path() const override { return path_; }

 private:
  std::string path_ = "none";
};

}  // namespace

int main() {
  if (aspic::library_version() != ASPIC_VERSION) return 1;
  if (aspic::list_parameters().size() < 100) return 23;
  const std::vector<std::string> small = {"cube[0].particles-per-edge=3"};
  const auto scene = aspic::load_scene("cube-plane", small);
  if (!scene || !aspic::parse_scene(aspic::to_toml(*scene), "again")) return 2;
  const auto edge = aspic::value_of(*scene, "cube[0].particles-per-edge");
  if (!edge || *edge != aspic::ParameterValue(std::int64_t{3}) || aspic::value_of(*scene, "cube[1].mass"))
    return 24;
  if (aspic::list_keys(*scene).empty() || aspic::body_names(scene->model).size() != 1) return 25;
  const auto model = aspic::make_model(scene->model);
  if (!model) return 3;
  if (aspic::particle_masses(**model).size() != 27 || aspic::particle_ranges(**model).size() != 1) return 4;
  if (aspic::spring_facts(**model).empty() || aspic::surface_quads(**model, 0).size() != 24) return 5;
  if (!aspic::body_mesh(**model, 0).triangles.empty()) return 30;
  if (!aspic::pinned_indices(**model).empty() || !aspic::ball_facts(**model).empty()) return 6;
  const aspic::State start = aspic::initial_state(**model, aspic::Precision::single);
  const auto same = aspic::compare_states(start, start);
  if (!same || !same->identical() || aspic::first_not_finite(start)) return 7;
  if (!aspic::stability_limit(**model, aspic::Integrator::symplectic_euler).step) return 8;
  aspic::BackendChoice cpu = *aspic::parse_backend("cpu");
  cpu.threads = 2;
  const auto backend = aspic::make_backend(cpu, *model);
  if (!backend || backend->variant() != "cpu" || aspic::list_backends().back().name != "reference") return 9;
  aspic::Pull pull;
  pull.stiffness = 10.0;
  aspic::Solver& solver = *backend->solver;
  if (!solver.set_inputs(aspic::inputs_of(pull)) || !solver.advance(10)) return 10;
  const auto state = backend->solver->state();
  const std::string toml = aspic::to_toml(*scene);
  if (!aspic::write_checkpoint("lab.aspic", toml, **model, *state, aspic::Overwrite::allow)) return 11;
  const auto read = aspic::read_checkpoint("lab.aspic");
  if (!read || read->state != *state || read->scene != toml) return 12;
  if (!aspic::write_state("lab.vtp", **model, *state, aspic::Overwrite::allow)) return 13;
  if (aspic::write_state("lab.xyz", **model, *state, aspic::Overwrite::allow)) return 14;
  auto files = aspic::RunFiles::open({{"series", "lab.csv", 1}}, {}, {toml}, aspic::Overwrite::allow);
  if (!files || !files->take({**model, start}) || !files->finish({**model, *state})) return 15;
  Counter counter;
  aspic::FrameSink& sink = counter;
  if (dynamic_cast<Counter*>(&sink) == nullptr || !sink.finish()) return 16;
  if (!aspic::find_video_format("mp4")) return 17;
  aspic::InputLog log;
  log.set(12, {{pull, pull}, {1}, {}, {0.5}});
  const std::string text = aspic::to_toml(log, scene->model.simulation.timestep);
  const auto again = aspic::parse_inputs(text, "again", {scene->model, **model});
  if (!again || again->hash_text() != log.hash_text()) return 18;
  if (!aspic::advance(solver, *again, 10, 5) || solver.inputs().pulls.size() != 2) return 19;
  std::vector<float> x(81);
  aspic::StateView view;
  view[aspic::field_number("position")] = aspic::Strided<float>{x.data(), 27};
  const auto step = solver.read_into(view);
  if (!step || *step != 15 || !solver.view()) return 20;
  if (!aspic::check_same_topology(**model, **model) || !solver.set_constants(*model)) return 21;
  return solver.load(aspic::view_of(start), 0) ? 0 : 22;
}
