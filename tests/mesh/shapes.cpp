#include "mesh/shapes.h"

#include <cmath>
#include <cstring>
#include <map>
#include <numbers>
#include <utility>

#include "base/split_mix.h"

namespace aspic::test {
namespace {

std::uint32_t count(const TriangleMesh& mesh) {
  return static_cast<std::uint32_t>(mesh.vertices.size());
}

void add_quad(TriangleMesh& mesh, std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d) {
  mesh.triangles.push_back({a, b, c});
  mesh.triangles.push_back({a, c, d});
}

}  // namespace

TriangleMesh box_mesh(const Vec3& half, const Vec3& center) {
  TriangleMesh mesh;
  for (int n = 0; n < 8; ++n)
    mesh.vertices.push_back(center + Vec3{(n & 4) != 0 ? half.x : -half.x, (n & 2) != 0 ? half.y : -half.y,
                                          (n & 1) != 0 ? half.z : -half.z});
  add_quad(mesh, 0, 1, 3, 2);
  add_quad(mesh, 4, 6, 7, 5);
  add_quad(mesh, 0, 4, 5, 1);
  add_quad(mesh, 2, 3, 7, 6);
  add_quad(mesh, 0, 2, 6, 4);
  add_quad(mesh, 1, 5, 7, 3);
  return mesh;
}

TriangleMesh sphere_mesh(int levels, double radius, const Vec3& center) {
  const double g = std::numbers::phi;
  TriangleMesh mesh;
  mesh.vertices = {{-1, g, 0},  {1, g, 0},  {-1, -g, 0}, {1, -g, 0}, {0, -1, g},  {0, 1, g},
                   {0, -1, -g}, {0, 1, -g}, {g, 0, -1},  {g, 0, 1},  {-g, 0, -1}, {-g, 0, 1}};
  mesh.triangles = {{0, 11, 5},  {0, 5, 1},  {0, 1, 7},  {0, 7, 10}, {0, 10, 11}, {1, 5, 9}, {5, 11, 4},
                    {11, 10, 2}, {10, 7, 6}, {7, 1, 8},  {3, 9, 4},  {3, 4, 2},   {3, 2, 6}, {3, 6, 8},
                    {3, 8, 9},   {4, 9, 5},  {2, 4, 11}, {6, 2, 10}, {8, 6, 7},   {9, 8, 1}};
  for (int level = 0; level < levels; ++level) {
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> middles;
    const auto middle = [&](std::uint32_t a, std::uint32_t b) {
      const auto [at, fresh] = middles.try_emplace({std::min(a, b), std::max(a, b)}, count(mesh));
      if (fresh) {
        const Vec3 sum = mesh.vertices[a] + mesh.vertices[b];
        mesh.vertices.push_back((length(mesh.vertices[a]) / length(sum)) * sum);
      }
      return at->second;
    };
    std::vector<Triangle> finer;
    for (const auto& [a, b, c] : mesh.triangles) {
      const std::uint32_t ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
      for (const Triangle& t :
           {Triangle{a, ab, ca}, Triangle{b, bc, ab}, Triangle{c, ca, bc}, Triangle{ab, bc, ca}})
        finer.push_back(t);
    }
    mesh.triangles = finer;
  }
  for (Vec3& v : mesh.vertices) v = center + (radius / length(v)) * v;
  return mesh;
}

TriangleMesh torus_mesh(int around, int across, double radius, double tube) {
  TriangleMesh mesh;
  for (int i = 0; i < around; ++i) {
    const double u = 2.0 * std::numbers::pi * i / around;
    for (int j = 0; j < across; ++j) {
      const double v = 2.0 * std::numbers::pi * j / across, r = radius + tube * std::cos(v);
      mesh.vertices.push_back({r * std::cos(u), tube * std::sin(v), r * std::sin(u)});
    }
  }
  const auto at = [&](int i, int j) {
    return static_cast<std::uint32_t>((i % around) * across + j % across);
  };
  for (int i = 0; i < around; ++i)
    for (int j = 0; j < across; ++j) add_quad(mesh, at(i, j), at(i, j + 1), at(i + 1, j + 1), at(i + 1, j));
  return mesh;
}

double torus_volume(int around, int across, double radius, double tube) {
  // A polygon of the tube's section, moved along the chords of the ring, by Pappus for polygons.
  const double pi = std::numbers::pi;
  const double section = 0.5 * across * tube * tube * std::sin(2.0 * pi / across);
  return section * radius * around * std::sin(2.0 * pi / around);
}

TriangleMesh together(const TriangleMesh& a, const TriangleMesh& b) {
  TriangleMesh both = a;
  both.vertices.insert(both.vertices.end(), b.vertices.begin(), b.vertices.end());
  for (const auto& [i, j, k] : b.triangles)
    both.triangles.push_back({i + count(a), j + count(a), k + count(a)});
  return both;
}

TriangleMesh without_share(const TriangleMesh& mesh, double share, std::uint64_t seed) {
  SplitMix64 random(seed);
  TriangleMesh rest = mesh;
  std::erase_if(rest.triangles, [&](const Triangle&) { return random.share() < share; });
  return rest;
}

TriangleMesh without_above(const TriangleMesh& mesh, double height) {
  TriangleMesh rest = mesh;
  std::erase_if(rest.triangles, [&](const Triangle& t) {
    return (mesh.vertices[t[0]].y + mesh.vertices[t[1]].y + mesh.vertices[t[2]].y) / 3.0 > height;
  });
  return rest;
}

TriangleMesh with_turned(const TriangleMesh& mesh, double share, std::uint64_t seed) {
  SplitMix64 random(seed);
  TriangleMesh turned = mesh;
  for (Triangle& t : turned.triangles)
    if (random.share() < share) std::swap(t[0], t[1]);
  return turned;
}

TriangleMesh as_soup(const TriangleMesh& mesh) {
  TriangleMesh soup;
  for (const Triangle& t : mesh.triangles) {
    const std::uint32_t first = count(soup);
    for (const std::uint32_t v : t) soup.vertices.push_back(mesh.vertices[v]);
    soup.triangles.push_back({first, first + 1, first + 2});
  }
  return soup;
}

std::string as_stl(const TriangleMesh& mesh) {
  std::string bytes(80, ' ');
  const auto append = [&](const auto& value) {
    char raw[sizeof value];
    std::memcpy(raw, &value, sizeof value);
    bytes.append(raw, sizeof value);
  };
  append(static_cast<std::uint32_t>(mesh.triangles.size()));
  for (const Triangle& t : mesh.triangles) {
    for (int i = 0; i < 3; ++i) append(0.0f);
    for (const std::uint32_t v : t)
      for (int axis = 0; axis < 3; ++axis) append(static_cast<float>(mesh.vertices[v][axis]));
    append(std::uint16_t{0});
  }
  return bytes;
}

}  // namespace aspic::test
