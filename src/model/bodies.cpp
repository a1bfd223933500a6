#include "model/bodies.h"

#include <tuple>
#include <vector>

namespace aspic {
namespace {

template <class Element>
Element element_of(std::vector<Element> ModelSettings::*);

}  // namespace

std::span<const BodyRow> body_rows() {
  static const std::vector<BodyRow> rows = [] {
    std::vector<BodyRow> all;
    std::apply([&](auto... list) { (all.push_back(row_of(decltype(element_of(list))())), ...); }, body_lists);
    return all;
  }();
  return rows;
}

std::span<const SettingsList> settings_lists() {
  static const std::vector<SettingsList> lists = [] {
    std::vector<SettingsList> all = {settings_list<&ModelSettings::terrain>("terrain"),
                                     settings_list<&ModelSettings::materials>("material")};
    for (const BodyRow& body : body_rows()) all.push_back(body.list);
    all.push_back(settings_list<&ModelSettings::actuators>("actuator"));
    return all;
  }();
  return lists;
}

BodyRow row_of(const BallSettings&) {
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
