#include "scene/aim.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include "model/cube.h"
#include "model/rotation.h"
#include "model/terrain.h"

namespace aspic {
namespace {

/// The box around places [m].
struct Frame {
  static constexpr double far = std::numeric_limits<double>::infinity();
  Vec3 low = {far, far, far}, high = {-far, -far, -far};

  bool empty() const { return !(low.x <= high.x); }
  Vec3 center() const { return 0.5 * (low + high); }
  void add(const Vec3& x, double radius = 0.0) {
    for (int axis = 0; axis < 3; ++axis) {
      low[axis] = std::min(low[axis], x[axis] - radius);
      high[axis] = std::max(high[axis], x[axis] + radius);
    }
  }
  /// A box with these edges, turned about its center.
  void add(const Vec3& center, const Vec3& edges, const RotationSettings& rotation) {
    const Rotation turned(rotation.axis, rotation.angle);
    for (const double x : {-0.5, 0.5})
      for (const double y : {-0.5, 0.5})
        for (const double z : {-0.5, 0.5}) add(center + turned({x * edges.x, y * edges.y, z * edges.z}));
  }
  std::vector<Vec3> corners() const {
    std::vector<Vec3> all;
    for (const double x : {low.x, high.x})
      for (const double y : {low.y, high.y})
        for (const double z : {low.z, high.z}) all.push_back({x, y, z});
    return all;
  }
};

Vec3 edges_of(const VoxelsSettings& body) {
  const auto count = [](std::size_t n) { return static_cast<double>(n); };
  if (body.layers.empty() || body.layers.front().empty()) return {};
  const auto& layer = body.layers.front();
  return body.size * Vec3{count(layer.front().size()), count(body.layers.size()), count(layer.size())};
}

Frame frame_of(const ModelSettings& settings) {
  Frame box;
  for (const CubeSettings& cube : settings.cubes) box.add(cube.position, edges_of(cube), cube.rotation);
  for (const VoxelsSettings& body : settings.voxels) box.add(body.position, edges_of(body), body.rotation);
  for (const ClothSettings& cloth : settings.cloths)
    box.add(cloth.position, {cloth.size[0], cloth.size[1], 0.0}, cloth.rotation);
  for (const GoalNetSettings& net : settings.goal_nets) box.add(net.position, net.size, {});
  for (const BallSettings& ball : settings.balls) box.add(ball.position, ball.radius);
  if (!box.empty()) return box;
  for (const LauncherSettings& launcher : settings.launchers)
    for (const BoxSettings& part : {launcher.from, launcher.towards})
      for (const Vec3& x : {part.min, part.max}) box.add(x, launcher.ball.radius);
  return box;
}

/// The free side of all terrain [m].
double distance_to(const std::vector<Terrain>& terrain, const Vec3& x) {
  double least = Frame::far;
  for (const Terrain& t : terrain) least = std::min(least, signed_distance(t, x));
  return least;
}

/// Adds where what is in the box falls, along `down`, unless that is farther than one and a half of its
/// diagonals.
void add_landing(Frame& box, const std::vector<Terrain>& terrain, const Vec3& down) {
  constexpr double farthest = 1.5, close = 1e-3;
  const double size = length(box.high - box.low);
  Vec3 x = box.center() + 0.5 * std::abs(dot(box.high - box.low, down)) * down;
  double way = 0.0;
  for (int i = 0; i < 256 && way <= farthest * size; ++i) {
    const double free = distance_to(terrain, x);
    if (free <= close * size) return box.add(x);
    x = x + free * down;
    way += free;
  }
}

/// Of the box, as a share of half the image: an image of 4 : 3 shows it from side to side too.
constexpr double body_share = 0.5, frame_share = 0.8, aspect = 4.0 / 3.0;

/// From the target, as far as the eye has to be for the box to take that share of the image [m].
double distance_for(const Frame& box, const Vec3& target, const Vec3& towards_eye, double slope,
                    double share) {
  const Vec3 aside = cross(Vec3{0.0, 1.0, 0.0}, towards_eye), right = aside / length(aside),
             up = cross(towards_eye, right);
  double distance = 0.0;
  for (const Vec3& corner : box.corners()) {
    const Vec3 x = corner - target;
    const double wide = std::abs(dot(x, right)) / aspect, high = std::abs(dot(x, up));
    distance = std::max(distance, dot(x, towards_eye) + std::max(wide, high) / (share * slope));
  }
  return distance;
}

/// With as many digits as a thousandth of the distance has.
Vec3 rounded(const Vec3& x, double distance) {
  const double digits = std::pow(10.0, 3.0 - std::floor(std::log10(distance)));
  return {std::round(x.x * digits) / digits, std::round(x.y * digits) / digits,
          std::round(x.z * digits) / digits};
}

}  // namespace

void aim_at_bodies(Scene& scene) {
  constexpr double degree = std::numbers::pi / 180.0, farthest = 1e6;
  const Frame bodies = frame_of(scene.model);
  if (bodies.empty()) return;
  std::vector<Terrain> terrain;
  for (const TerrainSettings& t : scene.model.terrain)
    terrain.push_back(make_terrain(t, scene.model.contact));
  Frame all = bodies;
  const Vec3& gravity = scene.model.simulation.gravity;
  if (const double g = length(gravity); g > 0.0 && !terrain.empty()) add_landing(all, terrain, gravity / g);
  const Vec3 target = all.center();
  const double slope = std::tan(0.5 * degree * scene.view.camera.fov);
  // From a little above, or from as far above as the terrain leaves free.
  for (const double height : {0.25, 0.7, 1.5, 4.0}) {
    const Vec3 way = {0.6, height, 0.8}, direction = way / length(way);
    const double distance = std::max(distance_for(bodies, target, direction, slope, body_share),
                                     distance_for(all, target, direction, slope, frame_share));
    const Vec3 eye = target + distance * direction;
    if (!(distance > 0.0) || !(length(eye) < farthest)) return;
    scene.view.camera.position = rounded(eye, distance);
    scene.view.camera.target = rounded(target, distance);
    if (distance_to(terrain, eye) > 0.0) return;
  }
}

}  // namespace aspic
