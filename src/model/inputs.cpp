#include "model/inputs.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <string_view>
#include <vector>

#include "base/result.h"

namespace aspic {
namespace {

/// Sorts the particles of a list and looks at each.
Status check_particles(const Model& model, std::string_view list, std::vector<std::uint32_t>& particles) {
  for (std::size_t n = 0; n < particles.size(); ++n) {
    if (particles[n] < model.particle_count()) continue;
    return fail(ErrorCode::usage, "{}[{}]: there is no particle {}; the scene has {}, counted from 0", list,
                n, particles[n], model.particle_count());
  }
  std::ranges::sort(particles);
  const auto twin = std::ranges::adjacent_find(particles);
  if (twin != particles.end())
    return fail(ErrorCode::usage, "{}: particle {} is listed twice; list it once", list, *twin);
  return {};
}

Status check_pins(const Model& model, Inputs& inputs) {
  ASPIC_CHECK(check_particles(model, "pinned", inputs.pinned));
  ASPIC_CHECK(check_particles(model, "released", inputs.released));
  for (const std::uint32_t particle : inputs.released) {
    if (std::ranges::binary_search(inputs.pinned, particle)) {
      return fail(ErrorCode::usage, "particle {} is both in `pinned` and in `released`; list it in one",
                  particle);
    }
    if (model.inverse_mass[particle] != 0.0) {
      return fail(ErrorCode::usage,
                  "released: particle {} is already free; list only particles that the scene pins", particle);
    }
  }
  return {};
}

/// Why a channel is one too many.
std::string unread_channel(const Model& model) {
  const std::vector<std::string> names = input_names(model);
  if (names.empty())
    return "no actuator of the scene has signal = \"input\", so no channel has an effect; remove the "
           "channels";
  return fmt::format("the scene reads {}: that of {}",
                     names.size() == 1 ? "one channel" : fmt::format("{} channels", names.size()),
                     fmt::join(names, ", "));
}

}  // namespace

Inputs inputs_of(const std::optional<Pull>& hand) {
  Inputs inputs;
  if (hand) inputs.pulls.push_back(*hand);
  return inputs;
}

Result<Inputs> rounded_inputs(const Model& model, const Inputs& inputs, Precision precision) {
  const auto too_many = [](std::string_view what, std::size_t count, std::size_t most) {
    return fail(ErrorCode::usage, "{} {} at a time are too many: at most {} are allowed", count, what, most);
  };
  if (inputs.pulls.size() > most_pulls) return too_many("pulls", inputs.pulls.size(), most_pulls);
  if (inputs.channels.size() > most_channels)
    return too_many("channels", inputs.channels.size(), most_channels);
  Inputs taken = inputs;
  // Without actuators nothing reads channels, and they are kept for whoever does.
  if (const Actuation& all = model.actuation; !all.actuators.empty() && taken.channels.size() > all.channels)
    return fail(ErrorCode::usage, "channels[{}]: {}", all.channels, unread_channel(model));
  for (std::size_t n = 0; n < taken.pulls.size(); ++n) {
    auto pull = rounded_pull(model, taken.pulls[n], precision);
    if (!pull) return fail(pull.error(), "pulls[{}]: {}", n, pull.error().what);
    taken.pulls[n] = *pull;
  }
  ASPIC_CHECK(check_pins(model, taken));
  for (std::size_t n = 0; n < taken.channels.size(); ++n) {
    double& value = taken.channels[n];
    value = rounded_number(value, precision);
    if (std::isfinite(value)) continue;
    return fail(ErrorCode::usage, "channels[{}]: {} is not finite in {} precision", n, inputs.channels[n],
                name_of(precision));
  }
  return taken;
}

double inverse_mass_of(const Model& model, const Inputs& inputs, std::uint32_t particle) {
  if (std::ranges::binary_search(inputs.pinned, particle)) return 0.0;
  if (std::ranges::binary_search(inputs.released, particle)) return 1.0 / model.mass[particle];
  return model.inverse_mass[particle];
}

Runs<double> inverse_mass_under(const Model& model, const Inputs& inputs) {
  if (inputs.same_pins({})) return model.inverse_mass;
  Runs<double> result;
  auto pinned = inputs.pinned.begin(), released = inputs.released.begin();
  const auto next = [](auto at, const auto& list, std::size_t otherwise) {
    return at == list.end() ? otherwise : std::min<std::size_t>(*at, otherwise);
  };
  std::size_t i = 0;
  for (const auto& run : model.inverse_mass.runs()) {
    while (i < run.end) {
      const std::size_t change =
          std::min(next(pinned, inputs.pinned, run.end), next(released, inputs.released, run.end));
      result.push_back(run.value, change - i);
      i = change;
      if (i == run.end) break;
      const bool pins = pinned != inputs.pinned.end() && *pinned == i;
      result.push_back(pins ? 0.0 : 1.0 / model.mass[i]);
      pins ? ++pinned : ++released;
      ++i;
    }
  }
  return result;
}

}  // namespace aspic
