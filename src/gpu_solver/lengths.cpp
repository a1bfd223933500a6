#include "gpu_solver/lengths.h"

#include <algorithm>
#include <array>
#include <bit>

#include "gpu_solver/layout.h"
#include "model/incident_springs.h"
#include "model/integrator.h"

namespace aspic {
namespace {

/// Numbers of a table at most, where one step has fewer: 1 MiB.
constexpr std::uint64_t most_lengths = 1u << 18;

/// When the stages of a step are, as shares of it; of implicit Euler its start and its end.
std::vector<double> shares_of(Integrator integrator) {
  const Staged* const method = row_of(integrator).staged();
  if (!method) return {0.0, 1.0};
  std::vector<double> shares = {0.0};
  for (std::size_t s = 0; s + 1 < method->stages.size(); ++s) shares.push_back(method->stages[s].advance);
  return shares;
}

/// Steps that a table has room for.
std::uint64_t room_of(const Model& model, std::size_t stages) {
  return std::clamp<std::uint64_t>(most_lengths / (model.spring_classes.size() * stages), 2, 1024);
}

}  // namespace

std::uint64_t length_bytes(const Model& model) {
  if (model.actuation.empty()) return 0;
  const std::size_t stages = shares_of(model.simulation.integrator).size();
  const std::uint64_t slices = (std::uint64_t{model.particle_count()} + spring_slice - 1) / spring_slice + 1;
  return sizeof(std::uint32_t) *
         (LENGTHS_HEAD + slices + model.spring_classes.size() * (3 + stages * room_of(model, stages)));
}

Status LengthBuffer::build(gl::Context& context, const Model& model, const SpringBuffers& springs) {
  if (model.actuation.empty()) return {};
  shares_ = shares_of(model.simulation.integrator);
  room_ = static_cast<std::uint32_t>(room_of(model, shares_.size()));
  constants_at_ = LENGTHS_HEAD + springs.starts.size();
  const std::uint64_t classes = model.spring_classes.size();
  rows_at_ = constants_at_ + 3 * classes;
  ASPIC_TRY(buffer_,
            gl::Buffer::create(context, "rest lengths",
                               sizeof(std::uint32_t) * (rows_at_ + room_ * shares_.size() * classes)));
  std::vector<std::uint32_t> words(LENGTHS_HEAD, 0);
  words[LENGTHS_STAGES] = static_cast<std::uint32_t>(shares_.size());
  words[LENGTHS_CLASSES] = static_cast<std::uint32_t>(classes);
  words[LENGTHS_CONSTANTS] = static_cast<std::uint32_t>(constants_at_);
  words[LENGTHS_ROWS] = static_cast<std::uint32_t>(rows_at_);
  words.insert(words.end(), springs.starts.begin(), springs.starts.end());
  buffer_.upload_items(words);
  set_model(model);
  return {};
}

void LengthBuffer::set_model(const Model& model) {
  if (!any()) return;
  model_ = &model;
  lengths_.emplace(model);
  steps_ = 0;
  std::vector<std::uint32_t> words;
  for (const SpringClass& each : model.spring_classes) {
    words.push_back(std::bit_cast<std::uint32_t>(static_cast<float>(each.stiffness)));
    words.push_back(std::bit_cast<std::uint32_t>(static_cast<float>(each.damping)));
    words.push_back(each.cord ? 1u : 0u);
  }
  buffer_.upload_items(words, constants_at_);
}

void LengthBuffer::set_base_step(std::uint64_t base_step) {
  base_step_ = base_step;
  steps_ = 0;
}

void LengthBuffer::set_channels(const std::vector<double>& channels) {
  if (channels == channels_) return;
  channels_ = channels;
  steps_ = 0;
}

std::uint32_t LengthBuffer::cover(std::uint32_t step, std::uint32_t wanted) {
  if (!any()) return wanted;
  const auto covered = [&] { return step - first_ < steps_ ? steps_ - (step - first_) : 0u; };
  if (covered() < std::min(wanted, room_)) {
    first_ = step;
    steps_ = std::min(wanted, room_);
    std::vector<float> row, rows;
    for (const SpringClass& each : model_->spring_classes)
      row.push_back(static_cast<float>(each.rest_length));
    rows.reserve(row.size() * shares_.size() * steps_);
    for (std::uint32_t n = 0; n < steps_; ++n) {
      for (const double share : shares_) {
        std::size_t at = 0;
        for (const double r : lengths_->at(base_step_ + step + n, share, channels_))
          row[model_->actuation.classes[at++].spring_class] = static_cast<float>(r);
        rows.insert(rows.end(), row.begin(), row.end());
      }
    }
    buffer_.upload_items(std::array{first_}, LENGTHS_FIRST_STEP);
    buffer_.upload_items(rows, rows_at_);
  }
  return std::min(wanted, covered());
}

}  // namespace aspic
