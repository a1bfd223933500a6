#include "model/bodies.h"

#include <vector>

namespace aspic {

std::span<const BodyRow> body_rows() {
  static const std::vector<BodyRow> rows = [] {
    std::vector<BodyRow> all;
    for (BodyRow (*const row)() : {cube_row, goal_net_row, cloth_row, ball_row, launcher_row})
      all.push_back(row());
    return all;
  }();
  return rows;
}

std::span<const SettingsList> settings_lists() {
  static const std::vector<SettingsList> lists = [] {
    std::vector<SettingsList> all = {settings_list<&ModelSettings::terrain>("terrain")};
    for (const BodyRow& body : body_rows()) all.push_back(body.list);
    return all;
  }();
  return lists;
}

BodyRow ball_row() {
  constexpr auto one = [](const BallSettings&) {
    ModelCounts counts;
    counts.balls = 1;
    return counts;
  };
  constexpr auto add = [](Model& model, const BallSettings& b) -> Status {
    model.balls.push_back({b.radius, b.mass, 0, b.position, b.velocity, b.angular_velocity});
    return {};
  };
  return body_row<&ModelSettings::balls, one, add>("ball", "");
}

}  // namespace aspic
