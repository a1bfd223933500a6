#include "model/goal_net.h"

#include <algorithm>
#include <numbers>
#include <utility>
#include <vector>

#include "model/bodies.h"
#include "model/material.h"

namespace aspic {
namespace {

/// A spring's direction seen from its lower particle, and its class relative to the net's first.
struct Offset {
  int di, dj, dk;
  std::uint32_t spring_class;
};

/// Whether both points lie in one of the four faces.
bool share_face(const std::array<int, 3>& n, int i, int j, int k, const Offset& o) {
  const auto both = [](int a, int delta, int at) { return a == at && a + delta == at; };
  return both(i, o.di, 0) || both(j, o.dj, n[1] - 1) || both(k, o.dk, 0) || both(k, o.dk, n[2] - 1);
}

Vec3 spacing_of(const GoalNetSettings& net) {
  return {net.size.x / (net.particles[0] - 1), net.size.y / (net.particles[1] - 1),
          net.size.z / (net.particles[2] - 1)};
}

/// The springs of a cord of the net's material and of this length: k = E·A/ℓ.
SpringSettings cord_springs(const GoalNetSettings& net, double length, double mass) {
  const double area = std::numbers::pi / 4.0 * net.cord_diameter * net.cord_diameter;
  const double stiffness = net.material->youngs_modulus * area / length;
  return {stiffness, damping_of(*net.material, stiffness, mass)};
}

/// Mass of a particle: that of all cords between neighbors, shared equally.
double cord_mass(const GoalNetSettings& net) {
  const auto [nw, nh, nl] = net.particles;
  const int along_x = nl + 2 * (nh - 1), along_y = nl + 2 * (nw - 1), along_z = nh + nw - 1;
  const double length = along_x * net.size.x + along_y * net.size.y + along_z * net.size.z;
  return net.material->density * std::numbers::pi / 4.0 * net.cord_diameter * net.cord_diameter * length /
         static_cast<double>(goal_net_counts(net).particles);
}

/// Adds a class for each direction of one type and returns the directions, with both signs of diagonals.
void add_directions(Model& model, const Body& body, const Vec3& s, const SpringClass& type,
                    std::vector<Offset>& offsets) {
  const auto add = [&](const Vec3& step) {
    SpringClass c = type;
    c.rest_length = length(step);
    model.spring_classes.push_back(c);
    return static_cast<std::uint32_t>(model.spring_classes.size() - 1) - body.first_class;
  };
  if (type.type == SpringType::shear) {
    const std::uint32_t xy = add({s.x, s.y, 0.0}), xz = add({s.x, 0.0, s.z}), yz = add({0.0, s.y, s.z});
    offsets.insert(
        offsets.end(),
        {{1, 1, 0, xy}, {1, -1, 0, xy}, {1, 0, 1, xz}, {1, 0, -1, xz}, {0, 1, 1, yz}, {0, 1, -1, yz}});
    return;
  }
  const int steps = type.type == SpringType::bending ? 2 : 1;
  const std::uint32_t x = add({steps * s.x, 0.0, 0.0}), y = add({0.0, steps * s.y, 0.0}),
                      z = add({0.0, 0.0, steps * s.z});
  offsets.insert(offsets.end(), {{steps, 0, 0, x}, {0, steps, 0, y}, {0, 0, steps, z}});
}

/// The cells of the four faces between cords: back, top and sides.
QuadMesh meshes_of(std::uint32_t first, const std::array<int, 3>& n) {
  QuadMesh mesh;
  // A face lies across an axis, at one of its ends.
  const auto add_face = [&](std::size_t axis, int at) {
    const std::size_t before = mesh.quads.size(), u = (axis + 1) % 3, v = (axis + 2) % 3;
    for (int i = 0; i + 1 < n[u]; ++i) {
      for (int j = 0; j + 1 < n[v]; ++j) {
        const auto corner = [&](int along_u, int along_v) {
          std::array<int, 3> place = {};
          place[axis] = at;
          place[u] = i + along_u;
          place[v] = j + along_v;
          return first + *net_index(n, place[0], place[1], place[2]);
        };
        mesh.quads.push_back({corner(0, 0), corner(1, 0), corner(1, 1), corner(0, 1)});
      }
    }
    mesh.groups.push_back({static_cast<std::uint32_t>(mesh.quads.size() - before)});
  };
  add_face(0, 0);
  add_face(1, n[1] - 1);
  add_face(2, 0);
  add_face(2, n[2] - 1);
  return mesh;
}

/// The frame that a net hangs on, where its pinned particles are at the start: posts at the four corners and
/// a bar around the top. Its radius is a fiftieth of the net's least side: 4 cm for a net 2 m deep.
std::vector<Rod> frame_of(const Model& model, std::uint32_t first, const std::array<int, 3>& n) {
  const auto corner = [&](bool front, bool top, bool right) {
    const auto index = net_index(n, front ? n[0] - 1 : 0, top ? n[1] - 1 : 0, right ? n[2] - 1 : 0);
    return model.initial_position[first + *index];
  };
  const Vec3 size = corner(true, true, true) - corner(false, false, false);
  const double radius = 0.02 * std::min({size.x, size.y, size.z});
  std::vector<Rod> rods;
  for (const bool front : {false, true}) {
    for (const bool right : {false, true})
      rods.push_back({corner(front, false, right), corner(front, true, right), radius});
    rods.push_back({corner(front, true, false), corner(front, true, true), radius});
    rods.push_back({corner(false, true, front), corner(true, true, front), radius});
  }
  return rods;
}

}  // namespace

ModelCounts goal_net_counts(const GoalNetSettings& net) {
  const auto nw = static_cast<std::uint64_t>(net.particles[0]),
             nh = static_cast<std::uint64_t>(net.particles[1]),
             nl = static_cast<std::uint64_t>(net.particles[2]);
  ModelCounts counts;
  counts.particles = nh * nl + (nw - 1) * (nl + 2 * (nh - 1));
  // Perimeter of the top, bottom row, and the posts between them.
  counts.pinned = 2 * (nw + nl) - 4 + (nl + 2 * (nw - 1)) + 4 * (nh - 2);
  // Lines along each axis that lie in a face, times the springs of a line.
  const std::uint64_t along_x = nl + 2 * (nh - 1), along_y = nl + 2 * (nw - 1), along_z = nh + nw - 1;
  counts.structural = along_x * (nw - 1) + along_y * (nh - 1) + along_z * (nl - 1);
  if (net.shear.stiffness > 0.0 && !net.material) {
    counts.shear = 2 * ((nh - 1) * (nl - 1) + (nw - 1) * (nl - 1) + 2 * (nw - 1) * (nh - 1));
  }
  if (net.bending.stiffness > 0.0 && !net.material) {
    counts.bending = along_x * (nw - 2) + along_y * (nh - 2) + along_z * (nl - 2);
  }
  counts.listed = counts.springs();
  return counts;
}

std::optional<std::uint32_t> net_index(const std::array<int, 3>& lattice, int i, int j, int k) {
  const auto [nw, nh, nl] = lattice;
  if (i < 0 || i >= nw || j < 0 || j >= nh || k < 0 || k >= nl) return std::nullopt;
  if (i == 0) return static_cast<std::uint32_t>(j * nl + k);
  const bool top = j == nh - 1;
  if (!top && k != 0 && k != nl - 1) return std::nullopt;
  // Slices i ≥ 1: two posts in every row below the top, then the top row.
  const int slice = nh * nl + (i - 1) * (2 * (nh - 1) + nl);
  return static_cast<std::uint32_t>(slice + 2 * j + (top ? k : k == 0 ? 0 : 1));
}

namespace {

/// Whether the particle at a lattice point is pinned: the perimeter of the top, the bottom row of back and
/// sides, and the four vertical corner posts.
bool net_pinned(const std::array<int, 3>& lattice, int i, int j, int k) {
  const auto [nw, nh, nl] = lattice;
  const bool end_i = i == 0 || i == nw - 1, end_k = k == 0 || k == nl - 1;
  const bool perimeter_of_top = j == nh - 1 && (end_i || end_k);
  return perimeter_of_top || j == 0 || (end_i && end_k);
}

/// Appends the net's particles and springs to the model, springs sorted by (a, b). A spring joins two
/// particles that lie in one face: structural neighbors along an axis, shear along the diagonals of a face's
/// cells, bending two steps along an axis; shear and bending only if their stiffness is positive. One spring
/// class for each type and direction, since the spacings along the axes differ. Error
/// (scene_rejected): an unknown material.
Status add_goal_net(Model& model, const ModelSettings& settings, const GoalNetSettings& given) {
  GoalNetSettings net = given;
  if (net.material) {
    ASPIC_TRY(net.material, material_of(settings, *given.material));
    net.shear = net.bending = {};
    net.particle_mass = cord_mass(net);
  }
  const auto [nw, nh, nl] = net.particles;
  const Vec3 s = spacing_of(net);
  Body body;
  body.style = SurfaceStyle::cords;
  body.footballs = true;
  body.first_particle = model.particle_count();
  body.first_class = static_cast<std::uint32_t>(model.spring_classes.size());

  std::vector<Offset> offsets;
  add_directions(model, body, s,
                 {SpringType::structural, net.structural.stiffness, net.structural.damping, 0.0, net.cord},
                 offsets);
  if (net.shear.stiffness > 0.0) {
    add_directions(model, body, s, {SpringType::shear, net.shear.stiffness, net.shear.damping, 0.0, net.cord},
                   offsets);
  }
  if (net.bending.stiffness > 0.0) {
    add_directions(model, body, s,
                   {SpringType::bending, net.bending.stiffness, net.bending.damping, 0.0, net.cord}, offsets);
  }
  for (std::size_t c = body.first_class; net.material && c < model.spring_classes.size(); ++c) {
    SpringClass& cord = model.spring_classes[c];
    const SpringSettings springs = cord_springs(net, cord.rest_length, net.particle_mass);
    cord.stiffness = springs.stiffness;
    cord.damping = springs.damping;
  }
  // Lexicographic order of the steps is ascending index of the other end, so springs come out sorted.
  std::sort(offsets.begin(), offsets.end(), [](const Offset& a, const Offset& b) {
    return std::array{a.di, a.dj, a.dk} < std::array{b.di, b.dj, b.dk};
  });

  for (int i = 0; i < nw; ++i) {
    for (int j = 0; j < nh; ++j) {
      for (int k = 0; k < nl; ++k) {
        const auto local = net_index(net.particles, i, j, k);
        if (!local) continue;
        model.initial_position.push_back(net.position + Vec3{i * s.x - net.size.x / 2.0,
                                                             j * s.y - net.size.y / 2.0,
                                                             k * s.z - net.size.z / 2.0});
        model.initial_velocity.push_back({});
        model.mass.push_back(net.particle_mass);
        model.inverse_mass.push_back(net_pinned(net.particles, i, j, k) ? 0.0 : 1.0 / net.particle_mass);
        for (const Offset& o : offsets) {
          const auto other = net_index(net.particles, i + o.di, j + o.dj, k + o.dk);
          if (!other || !share_face(net.particles, i, j, k, o)) continue;
          model.listed_springs.push_back({body.first_particle + *local, body.first_particle + *other,
                                          body.first_class + o.spring_class});
        }
      }
    }
  }
  body.particle_count = model.particle_count() - body.first_particle;
  body.class_count = static_cast<std::uint32_t>(model.spring_classes.size()) - body.first_class;
  body.listed_surface = meshes_of(body.first_particle, net.particles);
  body.rods = frame_of(model, body.first_particle, net.particles);
  model.bodies.push_back(std::move(body));
  return {};
}

}  // namespace

BodyRow row_of(const GoalNetSettings&) {
  return body_row<&ModelSettings::goal_nets, goal_net_counts, add_goal_net>("goal-net", "particles");
}

}  // namespace aspic
