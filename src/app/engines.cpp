#include "app/engines.h"

#include <fmt/format.h>

#include <utility>

namespace aspic::app {

Engines& Engines::operator=(Engines&& other) noexcept {
  leader_ = std::move(other.leader_);
  shadow_ = std::move(other.shadow_);
  model_ = std::move(other.model_);
  return *this;
}

Status Engines::load(const State& state) {
  ASPIC_CHECK(leader_.solver->load(state));
  return shadowed() ? shadow_.solver->load(state) : Status();
}

Status Engines::set_pull(const std::optional<Pull>& pull) {
  ASPIC_CHECK(leader_.solver->set_pull(pull));
  return shadowed() ? shadow_.solver->set_pull(pull) : Status();
}

void EngineFactory::set_context(gl::Context& context) {
  context_ = &context;
  arithmetic_.reset();
}

Result<Backend> EngineFactory::make(const Model& model, const BackendRow& row, const GpuSolver* like) {
  auto engine =
      make_backend({&row, Precision::single, ForcePath::automatic}, model, {context_, like, arithmetic_});
  if (engine && engine->gpu) arithmetic_ = engine->gpu->arithmetic();
  return engine;
}

Result<Engines> EngineFactory::make_like(const Engines& like, const Setup& setup,
                                         std::optional<std::string>& message) {
  auto built = build_model(setup);
  if (!built) return built.error();
  auto model = std::make_unique<Model>(std::move(*built));
  auto leader = make(*model, *like.leader().row, like.gpu());
  if (!leader && Engines::in_context(like.leader())) {
    message = fmt::format("{} The reference takes over.", leader.error().message);
    leader = make(*model, reference_backend(), nullptr);
  } else if (leader && like.shadowed()) {
    auto shadow = make(*model, *like.shadow().row, like.gpu());
    if (!shadow) return shadow.error();
    return Engines(std::move(model), std::move(*leader), std::move(*shadow));
  }
  if (!leader) return leader.error();
  return Engines(std::move(model), std::move(*leader), {});
}

}  // namespace aspic::app
