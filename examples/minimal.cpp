// Simulates a scene and prints its energy: the least that a program with libaspic needs.
//   aspic_minimal [SCENE [STEPS]]
#include <cstdio>
#include <cstdlib>
#include <optional>
#include <utility>

#include "aspic/aspic.h"

namespace {

int fail(const aspic::Error& error) {
  std::fprintf(stderr, "%s\n", error.message.c_str());
  return static_cast<int>(error.code);
}

}  // namespace

int main(int argc, char** argv) {
  const auto scene = aspic::load_scene(argc > 1 ? argv[1] : "cube-plane");
  if (!scene) return fail(scene.error());
  auto model = aspic::build_model(scene->model);
  if (!model) return fail(model.error());
  const auto backend = aspic::make_backend({}, std::move(*model));  // auto: a hardware GPU if there is one
  if (!backend) return fail(backend.error());
  const auto advanced = backend->solver->advance(argc > 2 ? std::strtoull(argv[2], nullptr, 10) : 1000);
  if (!advanced) return fail(advanced.error());
  const std::optional<aspic::Divergence> divergence = *advanced;  // empty: all steps were made
  const auto state = backend->solver->state();
  if (!state) return fail(state.error());
  std::printf("step %llu on %s\n", static_cast<unsigned long long>(state->step), backend->device.c_str());
  std::printf("total energy %.6g J\n", aspic::measure(backend->solver->model(), *state).total());
  std::printf("state hash %s\n", aspic::state_hash_text(*state).c_str());
  if (!divergence) return 0;
  std::printf("diverged in step %llu\n", static_cast<unsigned long long>(divergence->step));
  return static_cast<int>(aspic::ErrorCode::diverged);
}
