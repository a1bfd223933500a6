#include "model/bodies.h"

#include <vector>

#include "model/cube.h"
#include "model/goal_net.h"
#include "model/launcher.h"

namespace aspic {
namespace {

/// A list that is a vector of the settings.
template <auto Member>
SettingsList list_of(std::string_view key) {
  return {key, [](const ModelSettings& s) { return (s.*Member).size(); },
          [](ModelSettings& s) { (s.*Member).emplace_back(); }};
}

ModelCounts balls(std::uint64_t count) {
  ModelCounts counts;
  counts.balls = count;
  return counts;
}

}  // namespace

std::span<const BodyRow> body_rows() {
  using S = ModelSettings;
  static const std::vector<BodyRow> rows = {
      {list_of<&S::cubes>("cube"), "particles-per-edge",
       [](const S& s, std::size_t i) { return cube_counts(s.cubes[i].particles_per_edge); },
       [](Model& model, const S& s, std::size_t i) { return add_cube(model, s.cubes[i]); }},
      {list_of<&S::goal_nets>("goal-net"), "particles",
       [](const S& s, std::size_t i) { return goal_net_counts(s.goal_nets[i]); },
       [](Model& model, const S& s, std::size_t i) { return add_goal_net(model, s.goal_nets[i]); }},
      {list_of<&S::balls>("ball"), "", [](const S&, std::size_t) { return balls(1); },
       [](Model& model, const S& s, std::size_t i) {
         const BallSettings& b = s.balls[i];
         model.balls.push_back({b.radius, b.mass, 0, b.position, b.velocity, b.angular_velocity});
         return Status{};
       }},
      {list_of<&S::launchers>("launcher"), "count",
       [](const S& s, std::size_t i) { return balls(static_cast<std::uint64_t>(s.launchers[i].count)); },
       [](Model& model, const S& s, std::size_t i) { return add_launcher(model, s.launchers[i]); }},
  };
  return rows;
}

std::span<const SettingsList> settings_lists() {
  static const std::vector<SettingsList> lists = [] {
    std::vector<SettingsList> all = {list_of<&ModelSettings::terrain>("terrain")};
    for (const BodyRow& body : body_rows()) all.push_back(body.list);
    return all;
  }();
  return lists;
}

}  // namespace aspic
