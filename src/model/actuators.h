#pragma once
// From the actuators of a scene to a model's actuation: which body, which cells of it, at which phase.
#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "model/bodies.h"
#include "model/model.h"

namespace aspic {

/// A body of particles in the lists of the settings.
struct ListedBody {
  const BodyRow* row = nullptr;
  std::size_t index = 0;  ///< in its list
};

/// The body of that name, or at `cube[0]`; nothing: there is none that has particles.
std::optional<ListedBody> find_body(const ModelSettings& settings, std::string_view name);
/// What find_body() finds: names where bodies have them, else `cube[0]`.
std::vector<std::string> actuated_names(const ModelSettings& settings);

/// An actuator as messages name it: its name, or `actuator[1]`.
std::string actuator_name(const ModelSettings& settings, std::size_t actuator);
/// Names of the actuators that read channels of the inputs, by channel.
std::vector<std::string> channel_names(const ModelSettings& settings);

/// a, from amplitude or volume change.
double amplitude_of(const ActuatorSettings& actuator);

/// What is wrong with an actuator.
struct ActuatorFault {
  std::string key;                          ///< of [[actuator]]
  std::string message;                      ///< without the key
  std::optional<std::size_t> element = {};  ///< of the key's list
};
/// Nothing: it is sound. Bodies that cannot be made are left to their own checks.
std::optional<ActuatorFault> fault_of(const ModelSettings& settings, std::size_t actuator);

/// Whether an actuator names the body, so that its springs are listed.
bool is_actuated(const ModelSettings& settings, const BodyRow& row, std::size_t index);

/// Numbers by cell as scenes keep them: "nx ny nz: …", ordered by x, y and z.
struct CellNumbers {
  std::array<int, 3> count = {};
  std::vector<double> numbers;
};
std::optional<CellNumbers> cell_numbers(std::string_view text);
std::string to_cell_text(const CellNumbers& cells);

/// A body as actuators see it.
struct ActuatedBody;

/// Makes a model's actuation, body by body.
class ActuationBuilder {
 public:
  explicit ActuationBuilder(const ModelSettings& settings);

  /// Gives springs of the model's last body, which was made of that element of the list, the classes of its
  /// actuators; lists them before.
  void add_body(Model& model, const BodyRow& row, std::size_t index);
  /// All bodies are there.
  void finish(Model& model);

 private:
  struct Acting;
  struct OfBody;
  std::uint32_t drive_of(std::uint32_t actuator, std::int64_t place, double phase);
  std::uint32_t stretch_of(const std::vector<std::uint32_t>& drives);
  std::uint32_t class_of(Model& model, const std::vector<std::int64_t>& key,
                         const std::vector<StretchShare>& shares, const std::array<double, 3>& squares);
  void add_lattice(Model& model, OfBody& of, const Body& body);
  void add_springs(Model& model, OfBody& of, const Body& body);

  const ModelSettings& settings_;
  std::uint32_t body_ = 0;  // bodies added so far
  std::vector<Drive> drives_;
  std::map<std::array<std::int64_t, 3>, std::uint32_t> known_drives_;
  std::map<std::vector<std::uint32_t>, std::uint32_t> known_stretches_;
  std::map<std::vector<std::int64_t>, std::uint32_t> known_classes_;  // of the body at hand
  Actuation made_;
};

}  // namespace aspic
