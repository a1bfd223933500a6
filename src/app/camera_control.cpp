#include "app/camera_control.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "scene/follow.h"

namespace aspic::app {
namespace {

constexpr double steepest = 89.0 * std::numbers::pi / 180.0;
constexpr double nearest = 1e-3, farthest = 1e6;  // m
/// Time in which the shown camera makes good 63 % of its way [s]: short enough to feel attached to the hand.
constexpr double easing = 0.05;

double radians(double degrees) {
  return degrees * std::numbers::pi / 180.0;
}

}  // namespace

CameraControl::Orbit CameraControl::orbit_of(const CameraSettings& settings) {
  const Vec3 d = settings.position - settings.target;
  Orbit orbit;
  orbit.target = settings.target;
  orbit.distance = length(d);
  orbit.azimuth = std::atan2(d.x, d.z);
  orbit.elevation = std::clamp(std::asin(std::clamp(d.y / orbit.distance, -1.0, 1.0)), -steepest, steepest);
  orbit.fov = settings.fov;
  orbit.projection = settings.projection;
  orbit.exact = settings;
  return orbit;
}

CameraSettings CameraControl::settings_of(const Orbit& o) {
  if (o.exact) return *o.exact;
  const Vec3 direction = {std::cos(o.elevation) * std::sin(o.azimuth), std::sin(o.elevation),
                          std::cos(o.elevation) * std::cos(o.azimuth)};
  return {o.target + o.distance * direction, o.target, o.fov, o.projection};
}

void CameraControl::orbit(double dx, double dy) {
  goal_.exact.reset();
  goal_.azimuth -= std::numbers::pi * dx;
  goal_.elevation = std::clamp(goal_.elevation + std::numbers::pi * dy, -steepest, steepest);
}

Vec3 CameraControl::across(double dx, double dy, double fov) const {
  // At the target's distance the view is this many meters high.
  const double height = 2.0 * goal_.distance * std::tan(0.5 * radians(fov));
  const Vec3 right = {std::cos(goal_.azimuth), 0.0, -std::sin(goal_.azimuth)};
  const Vec3 up = {-std::sin(goal_.elevation) * std::sin(goal_.azimuth), std::cos(goal_.elevation),
                   -std::sin(goal_.elevation) * std::cos(goal_.azimuth)};
  return (dx * height) * right + (-dy * height) * up;
}

void CameraControl::pan(double dx, double dy) {
  goal_.exact.reset();
  goal_.target = goal_.target - across(dx, dy, goal_.fov);
}

void CameraControl::zoom(double notches, double dx, double dy, double fov) {
  goal_.exact.reset();
  const Vec3 point = across(dx, dy, fov > 0.0 ? fov : goal_.fov);
  const double before = goal_.distance;
  goal_.distance = std::clamp(before * std::pow(0.9, notches), nearest, farthest);
  goal_.target = goal_.target + (1.0 - goal_.distance / before) * point;
}

void CameraControl::come_round(double azimuth) {
  const double turn = 2.0 * std::numbers::pi;
  shown_.azimuth -= turn * std::round((shown_.azimuth - azimuth) / turn);
}

void CameraControl::reset() {
  goal_ = orbit_of(home_);
  come_round(goal_.azimuth);
}

void CameraControl::look_from(const Vec3& direction) {
  const Orbit seen = orbit_of({goal_.target + direction, goal_.target, goal_.fov, goal_.projection});
  come_round(seen.azimuth);
  goal_.exact.reset();
  goal_.azimuth = seen.azimuth;
  goal_.elevation = seen.elevation;
}

void CameraControl::frame(const Vec3& center, double radius, double aspect) {
  goal_.exact.reset();
  const double half = 0.5 * radians(goal_.fov);
  const double narrow = aspect < 1.0 ? std::atan(aspect * std::tan(half)) : half;
  goal_.target = center;
  goal_.distance = std::clamp(1.1 * std::max(radius, 10.0 * nearest) / std::sin(narrow), nearest, farthest);
}

void CameraControl::change_projection() {
  const bool parallel = goal_.projection == Projection::orthographic;
  goal_.projection = shown_.projection = parallel ? Projection::perspective : Projection::orthographic;
  for (Orbit* const orbit : {&goal_, &shown_})
    if (orbit->exact) orbit->exact->projection = goal_.projection;
}

void CameraControl::center(const Vec3& point) {
  goal_.exact.reset();
  goal_.target = point;
}

void CameraControl::shift(const Vec3& by) {
  for (Orbit* const o : {&goal_, &shown_}) {
    o->target = o->target + by;
    if (o->exact) o->exact = moved(*o->exact, by);
  }
}

bool CameraControl::update(double dt) {
  if (shown_ == goal_) return false;
  shown_.exact.reset();
  const double share = 1.0 - std::exp(-dt / easing);
  const auto ease = [share](double from, double to) { return from + share * (to - from); };
  const auto near = [](double a, double b, double scale) { return std::abs(a - b) < 1e-4 * scale; };
  shown_.target = shown_.target + share * (goal_.target - shown_.target);
  shown_.azimuth = ease(shown_.azimuth, goal_.azimuth);
  shown_.elevation = ease(shown_.elevation, goal_.elevation);
  shown_.distance = std::exp(ease(std::log(shown_.distance), std::log(goal_.distance)));
  shown_.projection = goal_.projection;
  shown_.fov = ease(shown_.fov, goal_.fov);
  if (length(shown_.target - goal_.target) < 1e-4 * goal_.distance &&
      near(shown_.azimuth, goal_.azimuth, 1) && near(shown_.elevation, goal_.elevation, 1) &&
      near(shown_.distance, goal_.distance, goal_.distance) && near(shown_.fov, goal_.fov, 1))
    shown_ = goal_;
  return true;
}

}  // namespace aspic::app
