#include "gpu_solver/kernels.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <string_view>

#include "aspic/solver.h"
#include "device/particles.h"
#include "gpu/loop_bound.h"
#include "gpu_solver/ball_passes.h"
#include "gpu_solver/layout.h"
#include "model/incident_springs.h"
#include "model/integrator.h"
#include "model/springs.h"
#include "model/terrain.h"

namespace aspic {
namespace {

layout::Terrain block_of(const Terrain& t) {
  layout::Terrain block{};
  for (std::size_t k = 0; k < geometry_size; ++k)
    block.geometry[k] = rounded(t.geometry.vectors[k], t.geometry.numbers[k]);
  block.shape = static_cast<std::uint32_t>(t.shape);
  block.movable = std::isfinite(t.mass) ? 1u : 0u;
  block.mass = block.movable ? static_cast<float>(t.mass) : 0.0f;
  block.restitution = static_cast<float>(t.restitution);
  block.friction = static_cast<float>(t.friction);
  return block;
}

std::uint32_t drift_word(Drift drift) {
  switch (drift) {
    case Drift::new_velocity:
      return DRIFT_NEW_VELOCITY;
    case Drift::mean_velocity:
      return DRIFT_MEAN_VELOCITY;
    case Drift::stage_velocity:
      break;
  }
  return DRIFT_STAGE_VELOCITY;
}

void fill_stages(layout::Simulation& block, const Staged& method, double h) {
  bool accumulate = false;
  for (std::size_t s = 0; s < method.stages.size(); ++s) {
    const Stage& stage = method.stages[s];
    layout::Stage& row = block.stages[s];
    row.advance = static_cast<float>(h * stage.advance);
    row.weight = static_cast<float>(stage.weight);
    row.accumulate = accumulate ? 1u : 0u;
    row.last = s + 1 == method.stages.size() ? 1u : 0u;
    accumulate = accumulate || stage.weight != 0.0;
  }
  block.step_scale = static_cast<float>(h / method.divisor);
  block.drift = drift_word(method.drift);
}

}  // namespace

Result<KernelOptions> kernel_options(gl::Context& context, const Model& model, const GpuOptions& options,
                                     std::uint32_t group_size, gl::ProgramBatch& batch) {
  const gl::DeviceLimits& limits = context.info().limits;
  const std::uint32_t most = std::min(limits.group_invocations, limits.group_size[0]);
  if (group_size < 1 || group_size > most)
    return fail(
        ErrorCode::no_device,
        "{} takes work groups of 1 to {} invocations, not {}. Use another group size or another device.",
        context.info().renderer, most, group_size);
  KernelOptions kernels{gl::ShaderLibrary(options.shader_directory), {}, {}, &batch};
  if (options.arithmetic) {
    kernels.arithmetic = *options.arithmetic;
  } else {
    ASPIC_TRY(kernels.arithmetic, gl::choose_arithmetic(context, kernels.library));
  }
  kernels.defines = kernels.arithmetic.defines;
  kernels.defines.push_back({"ASPIC_GROUP_SIZE", std::to_string(group_size)});
  std::uint32_t shapes = 0;
  for (const Terrain& terrain : model.terrain) shapes |= 1u << static_cast<std::uint32_t>(terrain.shape);
  kernels.defines.push_back({"ASPIC_SHAPES", std::to_string(shapes)});
  if (model.terrain.size() == 1) kernels.defines.push_back({"ASPIC_ONE_TERRAIN", "1"});
  if (std::ranges::any_of(model.terrain, [](const Terrain& t) { return t.motion.has_value(); }))
    kernels.defines.push_back({"ASPIC_MOTION", "1"});
  kernels.defines.insert(kernels.defines.end(), options.defines.begin(), options.defines.end());
  return kernels;
}

std::vector<std::string> titles_of(std::span<const KernelRow> rows) {
  std::vector<std::string> titles;
  for (const KernelRow& row : rows) titles.emplace_back(row.title);
  return titles;
}

Error idle_device(const gl::Context& context, const Model& model, std::uint64_t count) {
  return advised(fail(ErrorCode::no_device,
                      "{} is not usable: it does not run the kernels of {}, of which {} or more were queued.",
                      context.info().renderer, name_of(model.simulation.integrator), count),
                 {use_backend("cpu"), advice("use another device")});
}

Status check_overrun(std::uint32_t overrun) {
  // By KERNEL_… of layout.glsl: the kernel, and the objects its loop runs over.
  constexpr std::array<std::array<std::string_view, 2>, KERNEL_COUNT> kernels = {
      {{},
       {"gather", "the springs of one particle"},
       {"sum_springs", "the springs of one particle"},
       {"implicit_begin", "the springs of one particle"},
       {"implicit_evaluate", "the springs of one particle"},
       {"implicit_apply", "the springs of one particle"},
       {"ball_find", "blocks of 256 balls"},
       {"ball_gather", "the blocks of particles that one ball touches"},
       {"ball_partials", "the blocks of partners of one body"},
       {"ball_exchange", "the blocks of partners of one ball"},
       {"ball_particles", "the blocks of partners of one particle"},
       {"ball_faces", "the faces of a body, or the balls on one particle"}}};
  if (overrun == 0) return {};
  const auto& [name, rounds] = kernels[std::min<std::uint32_t>(overrun, KERNEL_COUNT - 1)];
  return gl::loop_error(name, rounds);
}

Result<layout::Simulation> simulation_block(const Model& model) {
  // Kernels of a model with actuators find the classes elsewhere (lengths.h).
  if ((model.actuation.empty() && model.spring_classes.size() > MAX_SPRING_CLASSES) ||
      model.terrain.size() > MAX_TERRAINS) {
    return advised(fail(ErrorCode::scene_rejected,
                        "the scene has {} kinds of springs and {} terrains; the gpu backend holds {} and {}.",
                        model.spring_classes.size(), model.terrain.size(), MAX_SPRING_CLASSES, MAX_TERRAINS),
                   {use_backend("cpu"), advice("use fewer bodies, materials and terrains")});
  }
  layout::Simulation block{};
  block.gravity = rounded(model.simulation.gravity, fall_speed(model));
  std::array<float, 4> resistance{};
  static_assert(std::size(resistance_constants) <= resistance.size());
  std::ranges::transform(resistance_constants, resistance.begin(),
                         [&](const auto& row) { return static_cast<float>(model.simulation.*row.value); });
  block.resistance_constants = std::bit_cast<layout::vec4>(resistance);
  block.contact_distance = static_cast<float>(model.contact.distance);
  block.set_speed = static_cast<float>(model.contact.resting_speed);
  block.resting_speed = static_cast<float>(resting_speed(model));
  block.divergence_speed_squared = static_cast<float>(divergence_speed * divergence_speed);
  block.particle_count = model.particle_count();
  block.spring_count = static_cast<std::uint32_t>(spring_count(model));
  block.terrain_count = static_cast<std::uint32_t>(model.terrain.size());
  block.contact_model = model.contact.model == ContactModel::coulomb ? CONTACT_COULOMB : CONTACT_COURSE;
  block.class_bits = class_bits(model);
  // A method that is not staged stages nothing but its balls.
  fill_stages(block, *free_flight_row(model.simulation.integrator).staged(), model.simulation.timestep);
  fill_balls(block, model);
  const ImplicitSettings& implicit = model.simulation.implicit;
  block.time_step = static_cast<float>(model.simulation.timestep);
  block.max_newton = static_cast<std::uint32_t>(implicit.newton_iterations);
  block.max_cg = static_cast<std::uint32_t>(implicit.cg_iterations);
  block.tolerance = static_cast<float>(implicit_tolerance(implicit, Precision::single));
  block.first_forcing = static_cast<float>(first_forcing);
  block.forcing_factor = static_cast<float>(forcing_factor);
  block.least_forcing = static_cast<float>(least_forcing);
  block.most_forcing = static_cast<float>(most_forcing);
  block.progress_share = static_cast<float>(progress_share);
  block.max_halvings = max_halvings;
  block.max_without_progress = max_without_progress;
  block.progress_share_on_ground = static_cast<float>(progress_share_on_ground);
  block.max_without_progress_on_ground = max_without_progress_on_ground;
  block.least_turn = static_cast<float>(least_turn);
  block.least_wedge = static_cast<float>(least_wedge);
  for (std::size_t c = 0; c < std::min<std::size_t>(model.spring_classes.size(), MAX_SPRING_CLASSES); ++c)
    block.spring_classes[c] = rounded(model.spring_classes[c]);
  std::uint32_t moving = 0;
  for (std::size_t t = 0; t < model.terrain.size(); ++t) {
    block.terrains[t] = block_of(model.terrain[t]);
    if (model.terrain[t].motion) block.terrains[t].motion = ++moving;
  }
  return block;
}

}  // namespace aspic
