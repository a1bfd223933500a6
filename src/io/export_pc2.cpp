// The point cache is the format of the 3ds Max modifier of that name: a header of 32 bytes, then every vertex
// of every sample as three floats. Source: MOD_meshcache_pc2.c of Blender.
#include "io/export_pc2.h"

#include <fmt/format.h>

#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <iterator>
#include <numbers>
#include <vector>

#include "aspic/version.h"
#include "base/printable.h"
#include "io/motion_sink.h"
#include "io/numbered_files.h"
#include "model/springs.h"

namespace aspic {
namespace {

static_assert(std::endian::native == std::endian::little, "the numbers of the file are little-endian");

constexpr std::uint64_t count_offset = 28;  // of the number of samples in the header
constexpr std::uint32_t no_vertex = 0xffffffffu;

/// A ball's surface: rings of vertices from pole to pole.
constexpr int rings = 9, around = 16;

/// What is seen of a model. Vertices are in the order in which faces and edges first name them, so that
/// programs which number them so agree with the cache.
struct Shape {
  struct Group {
    std::string name;
    std::vector<std::vector<std::uint32_t>> faces, edges;  // of vertices
  };
  struct Vertex {
    std::array<std::uint32_t, 8> corners =
        {};  // particles; only the first one counts of a particle's own vertex
    std::array<double, 8> weights = {1.0};
  };
  std::vector<Vertex> vertices;   // without those of balls
  std::vector<Vec3> around_ball;  // vertices of a ball of radius 1, after those
  std::vector<Group> groups;
};

class ShapeMaker {
 public:
  explicit ShapeMaker(const Model& model) : vertex_(model.particle_count(), no_vertex) {
    for (std::size_t b = 0; b < model.bodies.size(); ++b) add_body(model, b);
    if (model.ball_count() > 0) make_ball();
    for (std::uint32_t b = 0; b < model.ball_count(); ++b) add_ball(b);
  }
  Shape take() { return std::move(shape_); }

 private:
  std::uint32_t vertex_of(std::uint32_t particle) {
    if (vertex_[particle] == no_vertex) {
      vertex_[particle] = static_cast<std::uint32_t>(shape_.vertices.size());
      shape_.vertices.push_back({{particle}});
    }
    return vertex_[particle];
  }
  void add_mesh(const BodySkin& mesh, Shape::Group& group) {
    std::vector<std::uint32_t> vertex(mesh.corners.size(), no_vertex);
    for (const Triangle& triangle : mesh.triangles) {
      for (const std::uint32_t corner : triangle) {
        if (vertex[corner] != no_vertex) continue;
        vertex[corner] = static_cast<std::uint32_t>(shape_.vertices.size());
        shape_.vertices.push_back({mesh.corners[corner], corner_weights(mesh.binding.vertices[corner].at)});
      }
      group.faces.push_back({vertex[triangle[0]], vertex[triangle[1]], vertex[triangle[2]]});
    }
  }
  /// The mesh or the surface; of a body without either its springs.
  void add_body(const Model& model, std::size_t number) {
    const Body& body = model.bodies[number];
    Shape::Group group = {fmt::format("body-{}", number), {}, {}};
    add_mesh(body.skin, group);
    for (const Quad& quad : body.skin.empty() ? surface_of(body).quads : std::vector<Quad>()) {
      std::vector<std::uint32_t> face;
      for (const std::uint32_t corner : quad) face.push_back(vertex_of(corner));
      group.faces.push_back(std::move(face));
    }
    if (group.faces.empty())
      for (const Spring& s : springs_of(model, body.first_particle, body.particle_count))
        group.edges.push_back({vertex_of(s.a), vertex_of(s.b)});
    shape_.groups.push_back(std::move(group));
  }
  void make_ball() {
    const auto at = [&](int ring, int place) {
      const double down = std::numbers::pi * ring / (rings - 1),
                   turn = 2.0 * std::numbers::pi * place / around;
      return Vec3{std::sin(down) * std::cos(turn), std::cos(down), std::sin(down) * std::sin(turn)};
    };
    std::vector<Vec3> places = {at(0, 0)};
    for (int ring = 1; ring < rings - 1; ++ring)
      for (int place = 0; place < around; ++place) places.push_back(at(ring, place));
    places.push_back(at(rings - 1, 0));
    const auto index = [](int ring, int place) -> std::uint32_t {
      if (ring == 0) return 0;
      if (ring == rings - 1) return 1 + (rings - 2) * around;
      return static_cast<std::uint32_t>(1 + (ring - 1) * around + place % around);
    };
    for (int ring = 0; ring < rings - 1; ++ring) {
      for (int place = 0; place < around; ++place) {
        const std::uint32_t a = index(ring, place), b = index(ring, place + 1),
                            c = index(ring + 1, place + 1), d = index(ring + 1, place);
        if (ring == 0)
          ball_faces_.push_back({a, c, d});
        else if (ring == rings - 2)
          ball_faces_.push_back({a, b, c});
        else
          ball_faces_.push_back({a, b, c, d});
      }
    }
    // In the order in which faces name them.
    std::vector<std::uint32_t> order(places.size(), no_vertex);
    for (auto& face : ball_faces_) {
      for (std::uint32_t& corner : face) {
        if (order[corner] == no_vertex) {
          order[corner] = static_cast<std::uint32_t>(shape_.around_ball.size());
          shape_.around_ball.push_back(places[corner]);
        }
        corner = order[corner];
      }
    }
  }
  void add_ball(std::uint32_t number) {
    Shape::Group group = {fmt::format("ball-{}", number), ball_faces_, {}};
    const auto first =
        static_cast<std::uint32_t>(shape_.vertices.size() + number * shape_.around_ball.size());
    for (auto& face : group.faces)
      for (std::uint32_t& corner : face) corner += first;
    shape_.groups.push_back(std::move(group));
  }

  Shape shape_;
  std::vector<std::uint32_t> vertex_;  // by particle
  std::vector<std::vector<std::uint32_t>> ball_faces_;
};

/// Where the vertices are.
std::vector<float> places_of(const Shape& shape, const Sample& sample) {
  std::vector<float> places;
  const auto add = [&](const Vec3& x) {
    for (const double component : {x.x, x.y, x.z}) places.push_back(static_cast<float>(component));
  };
  const std::vector<Vec3>& positions = sample.state.position;
  for (const auto& [corners, weights] : shape.vertices) {
    Vec3 place = weights[0] * positions[corners[0]];
    for (std::size_t n = 1; n < 8; ++n)
      if (weights[n] != 0.0) place = place + weights[n] * positions[corners[n]];
    add(place);
  }
  for (std::uint32_t b = 0; b < sample.model.ball_count(); ++b)
    for (const Vec3& e : shape.around_ball)
      add(sample.state.ball_position[b] + sample.model.balls[b].radius * e);
  return places;
}

class PointCache final : public MotionSink {
 public:
  PointCache(const std::string& path, std::uint64_t every, AtomicFile cache, AtomicFile object)
      : MotionSink(path, every, Raster::even), cache_(std::move(cache)), object_(std::move(object)) {}

 private:
  Status add(const Sample& sample) override {
    const bool first = samples() == 0;
    if (first) shape_ = ShapeMaker(sample.model).take();
    std::vector<float> places = places_of(shape_, sample);
    if (first) ASPIC_CHECK(write_header(places.size() / 3));
    const Status written = cache_.write({reinterpret_cast<const char*>(places.data()), 4 * places.size()});
    if (first) start_ = std::move(places);
    return written;
  }
  Status complete(const Sample& last) override {
    const auto count = static_cast<std::int32_t>(samples());
    ASPIC_CHECK(cache_.replace(count_offset, {reinterpret_cast<const char*>(&count), sizeof(count)}));
    ASPIC_CHECK(write_object(last.model.simulation.timestep));
    // Where the cache is, its shape is too.
    ASPIC_CHECK(object_.commit());
    return cache_.commit();
  }

  Status write_header(std::size_t vertices) {
    struct Header {
      std::array<char, 12> signature = {'P', 'O', 'I', 'N', 'T', 'C', 'A', 'C', 'H', 'E', '2', 0};
      std::int32_t version = 1, vertices = 0;
      float first = 0.0f, frames_each = 1.0f;
      std::int32_t samples = 0;
    } header;
    static_assert(sizeof(Header) == 32);
    header.vertices = static_cast<std::int32_t>(vertices);
    return cache_.write({reinterpret_cast<const char*>(&header), sizeof(header)});
  }
  Status write_object(double timestep) {
    const double start = static_cast<double>(first_step()) * timestep;
    const double intervals = static_cast<double>(std::max<std::uint64_t>(samples(), 2) - 1);
    const double interval = static_cast<double>(last_step() - first_step()) / intervals * timestep;
    std::string text = fmt::format(
        "# aspic {}: the shape of {}\n# samples {}\n# start {}\n# interval {}\no aspic\n", ASPIC_VERSION,
        printable_line(std::filesystem::path(path()).filename().string()), samples(), start, interval);
    for (std::size_t i = 0; i < start_.size(); i += 3)
      fmt::format_to(std::back_inserter(text), "v {} {} {}\n", start_[i], start_[i + 1], start_[i + 2]);
    const auto add = [&](char kind, const std::vector<std::uint32_t>& vertices) {
      text += kind;
      for (const std::uint32_t vertex : vertices) fmt::format_to(std::back_inserter(text), " {}", vertex + 1);
      text += '\n';
    };
    for (const Shape::Group& group : shape_.groups) {
      text += "g " + group.name + "\n";
      for (const auto& face : group.faces) add('f', face);
      for (const auto& edge : group.edges) add('l', edge);
    }
    return object_.write(text);
  }

  AtomicFile cache_, object_;
  Shape shape_;
  std::vector<float> start_;
};

}  // namespace

Result<std::unique_ptr<StateSink>> open_pc2(const std::string& path, std::uint64_t every, Overwrite overwrite,
                                            const RunFacts&) {
  ASPIC_CHECK(check_export_name(path));
  ASPIC_TRY(auto cache, AtomicFile::create(path, overwrite));
  ASPIC_TRY(auto object, AtomicFile::create(with_ending(path, ".obj"), overwrite));
  return std::unique_ptr<StateSink>(
      std::make_unique<PointCache>(path, every, std::move(cache), std::move(object)));
}

}  // namespace aspic
