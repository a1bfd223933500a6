// Simulates a scene and prints its energy: the least that a program with libaspic needs.
//   aspic_minimal [SCENE [STEPS [BACKEND]]]
#include <aspic/aspic.h>

#include <cstdio>
#include <cstdlib>

namespace {

int fail(const aspic::Error& error) {
  std::fprintf(stderr, "%s\n", error.message().c_str());
  return static_cast<int>(error.code);
}

}  // namespace

int main(int argc, char** argv) {
  const auto scene = aspic::load_scene(argc > 1 ? argv[1] : "cube-plane");
  if (!scene) return fail(scene.error());
  const auto model = aspic::make_model(scene->model);
  if (!model) return fail(model.error());
  const auto choice = aspic::parse_backend(argc > 3 ? argv[3] : "auto");  // a hardware GPU if there is one
  if (!choice) return fail(choice.error());
  const auto backend = aspic::make_backend(*choice, *model);
  if (!backend) return fail(backend.error());
  const auto advanced = backend->solver->advance(argc > 2 ? std::strtoull(argv[2], nullptr, 10) : 1000);
  if (!advanced) return fail(advanced.error());
  const auto state = backend->solver->state();
  if (!state) return fail(state.error());
  std::printf("step %llu on %s\n", static_cast<unsigned long long>(state->step), backend->device.c_str());
  std::printf("total energy %.6g J\n", aspic::measure(**model, *state).total());
  std::printf("state hash %s\n", aspic::state_hash_text(*state).c_str());
  if (!advanced->divergence) return 0;  // all steps were made
  std::printf("diverged in step %llu\n", static_cast<unsigned long long>(advanced->divergence->step));
  return static_cast<int>(aspic::ErrorCode::diverged);
}
