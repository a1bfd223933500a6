#include "cli/json_report.h"

#include <cmath>
#include <nlohmann/json.hpp>

namespace aspic::cli {
namespace {

using Json = nlohmann::ordered_json;

struct Converter {
  Json operator()(std::nullptr_t) const { return nullptr; }
  Json operator()(bool value) const { return value; }
  Json operator()(std::uint64_t value) const { return value; }
  Json operator()(double value) const { return std::isfinite(value) ? Json(value) : Json(nullptr); }
  Json operator()(const std::string& value) const { return value; }
  Json operator()(const JsonArray& value) const {
    Json array = Json::array();
    for (const JsonValue& item : value) array.push_back(std::visit(*this, item.content()));
    return array;
  }
  Json operator()(const JsonObject& value) const {
    Json object = Json::object();
    for (const auto& [key, item] : value) object[key] = std::visit(*this, item.content());
    return object;
  }
};

}  // namespace

std::string to_json(const JsonObject& object) {
  return Converter()(object).dump(2, ' ', true, Json::error_handler_t::replace) + "\n";
}

}  // namespace aspic::cli
