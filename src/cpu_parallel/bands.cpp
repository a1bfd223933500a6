#include "cpu_parallel/bands.h"

#include <algorithm>
#include <bit>
#include <map>
#include <string>
#include <unordered_map>
#include <utility>

#include "model/springs.h"

namespace aspic::parallel {
namespace {

/// Bands of one slice by step, with the class of each spring.
using SliceBands = std::map<std::int32_t, std::pair<std::uint16_t, Bands::Mixture>>;

/// The number of a value among those there are already, or of a new one.
template <class T>
std::uint32_t number_of(std::unordered_map<std::string, std::uint32_t>& known, std::span<const T> values,
                        bool& fresh) {
  std::string bytes(reinterpret_cast<const char*>(values.data()), values.size_bytes());
  const auto [at, added] = known.try_emplace(std::move(bytes), static_cast<std::uint32_t>(known.size()));
  fresh = added;
  return at->second;
}

/// Where there is no spring, the class of one that is: most slices are then of one class.
Bands::Mixture filled(std::uint16_t present, Bands::Mixture classes) {
  const std::uint16_t some = classes[static_cast<std::size_t>(std::countr_zero(present)) % slice];
  for (std::size_t lane = 0; lane < slice; ++lane)
    if ((present >> lane & 1) == 0) classes[lane] = some;
  return classes;
}

}  // namespace

std::optional<Bands> Bands::of(const Model& model, const Body& body) {
  Bands made;
  made.first_ = body.first_particle;
  made.count_ = body.particle_count;
  made.first_class_ = body.first_class;
  made.stiffness_.resize(body.class_count);
  std::unordered_map<std::string, std::uint32_t> mixtures, patterns;
  made.start_.push_back(0);
  SliceBands open;
  bool fresh = false, too_many = body.class_count > 0xffffu;
  const auto close = [&] {
    std::vector<Band> bands;
    for (const auto& [step, band] : open) {
      const Mixture classes = filled(band.first, band.second);
      auto kind = static_cast<std::uint32_t>(classes[0]);
      if (std::ranges::any_of(classes, [&](std::uint16_t c) { return c != classes[0]; })) {
        kind = body.class_count + number_of(mixtures, std::span<const std::uint16_t>(classes), fresh);
        if (fresh) made.mixtures_.push_back(classes);
      }
      too_many = too_many || kind > 0xffffu;
      bands.push_back({step, band.first, static_cast<std::uint16_t>(kind)});
      made.reach_ = std::max(made.reach_, static_cast<std::size_t>(step));
    }
    made.most_ = std::max(made.most_, bands.size());
    made.pattern_.push_back(number_of(patterns, std::span<const Band>(bands), fresh));
    if (fresh) {
      made.bands_.insert(made.bands_.end(), bands.begin(), bands.end());
      made.start_.push_back(static_cast<std::uint32_t>(made.bands_.size()));
    }
    open.clear();
  };
  for (const aspic::Spring& spring : springs_of(model, body.first_particle, body.particle_count)) {
    const std::size_t local = spring.a - made.first_;
    while (made.pattern_.size() < local / slice) close();
    auto& [present, classes] = open[static_cast<std::int32_t>(spring.b - spring.a)];
    present = static_cast<std::uint16_t>(present | 1u << local % slice);
    classes[local % slice] = static_cast<std::uint16_t>(spring.spring_class - body.first_class);
  }
  while (made.pattern_.size() * slice < made.count_) close();
  if (too_many) return std::nullopt;
  for (auto* const list : {&made.start_, &made.pattern_}) list->shrink_to_fit();
  made.bands_.shrink_to_fit();
  made.mixtures_.shrink_to_fit();
  made.set_constants(model);
  return made;
}

void Bands::set_constants(const Model& model) {
  const std::size_t count = classes();
  for (auto* const each : {&stiffness_, &damping_, &rest_length_}) each->resize(count);
  for (std::size_t c = 0; c < count; ++c) {
    const Constants constants(model.spring_classes[first_class_ + c]);
    stiffness_[c] = constants.stiffness;
    damping_[c] = constants.damping;
    rest_length_[c] = constants.rest_length;
  }
  lanes_.resize(mixtures_.size());
  for (std::size_t m = 0; m < mixtures_.size(); ++m) {
    for (std::size_t lane = 0; lane < slice; ++lane) {
      const std::uint16_t c = mixtures_[m][lane];
      lanes_[m].stiffness[lane] = stiffness_[c];
      lanes_[m].damping[lane] = damping_[c];
    }
  }
  rest_lengths_set();
}

void Bands::rest_lengths_set() {
  for (std::size_t m = 0; m < mixtures_.size(); ++m)
    for (std::size_t lane = 0; lane < slice; ++lane)
      lanes_[m].rest_length[lane] = rest_length_[mixtures_[m][lane]];
}

}  // namespace aspic::parallel
