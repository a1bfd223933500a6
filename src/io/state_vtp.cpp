#include "io/state_vtp.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <cstring>
#include <initializer_list>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include "analysis/particle_force.h"
#include "aspic/analysis.h"
#include "aspic/body_mesh.h"
#include "io/state_csv.h"
#include "model/springs.h"

namespace aspic {
namespace {

static_assert(std::endian::native == std::endian::little, "the file says byte_order=\"LittleEndian\"");

template <class T>
constexpr std::string_view type_name() {
  if constexpr (std::is_same_v<T, float>) return "Float32";
  if constexpr (std::is_same_v<T, double>) return "Float64";
  if constexpr (std::is_same_v<T, std::int64_t>) return "Int64";
  if constexpr (std::is_same_v<T, std::int32_t>) return "Int32";
  if constexpr (std::is_same_v<T, std::uint8_t>) return "UInt8";
}

/// The document in the making: XML that names offsets, and behind it the arrays' bytes, each after its size.
class Document {
 public:
  void add(std::string_view xml) { xml_ += xml; }

  template <class T>
  void array(std::string_view name, const std::vector<T>& values, int components = 1) {
    // A reader takes the number of tuples from here in field data, where no count of points or cells says it.
    xml_ += fmt::format(
        "<DataArray type=\"{}\" Name=\"{}\" NumberOfComponents=\"{}\" NumberOfTuples=\"{}\" "
        "format=\"appended\" "
        "offset=\"{}\"/>\n",
        type_name<T>(), name, components, values.size() / static_cast<std::size_t>(components),
        bytes_.size());
    append(std::uint64_t{values.size() * sizeof(T)});
    bytes_.append(reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T));
  }

  Status write(AtomicFile& file) const {
    ASPIC_CHECK(file.write(xml_));
    ASPIC_CHECK(file.write("<AppendedData encoding=\"raw\">\n_"));
    ASPIC_CHECK(file.write(bytes_));
    return file.write("\n</AppendedData>\n</VTKFile>\n");
  }

 private:
  void append(std::uint64_t size) {
    char bytes[sizeof(size)];
    std::memcpy(bytes, &size, sizeof(size));
    bytes_.append(bytes, sizeof(size));
  }
  std::string xml_, bytes_;
};

/// Cells of one kind: points of all cells one after the other, and where each cell ends.
struct Cells {
  std::vector<std::int64_t> points, ends;

  void add(std::initializer_list<std::uint64_t> corners) {
    for (const std::uint64_t corner : corners) points.push_back(static_cast<std::int64_t>(corner));
    ends.push_back(std::ssize(points));
  }
  void write(Document& document, std::string_view element) const {
    document.add(fmt::format("<{}>\n", element));
    document.array("connectivity", points);
    document.array("offsets", ends);
    document.add(fmt::format("</{}>\n", element));
  }
};

/// The vertices of all bodies' meshes, which are points after particles and balls.
class MeshVertices {
 public:
  explicit MeshVertices(const Model& model) {
    for (std::size_t b = 0; b < model.bodies.size(); ++b) {
      first_.push_back(corners_.size());
      const BodyMesh mesh = body_mesh(model, b);
      corners_.insert(corners_.end(), mesh.corners.begin(), mesh.corners.end());
      weights_.insert(weights_.end(), mesh.weights.begin(), mesh.weights.end());
    }
  }
  std::size_t count() const { return corners_.size(); }
  std::size_t first(std::size_t body) const { return first_[body]; }

  /// What the particles of each vertex have in the mean.
  template <class V>
  std::vector<V> means(const std::vector<V>& of_particles) const {
    std::vector<V> result;
    result.reserve(count());
    for (std::size_t v = 0; v < count(); ++v) {
      V sum = weights_[v][0] * of_particles[corners_[v][0]];
      for (std::size_t n = 1; n < 8; ++n) sum = sum + weights_[v][n] * of_particles[corners_[v][n]];
      result.push_back(sum);
    }
    return result;
  }
  /// Of the particle nearest to it in its cell.
  std::vector<std::uint8_t> nearest(const std::vector<std::uint8_t>& of_particles) const {
    std::vector<std::uint8_t> result;
    for (std::size_t v = 0; v < count(); ++v) {
      const auto most = std::ranges::max_element(weights_[v]) - weights_[v].begin();
      result.push_back(of_particles[corners_[v][static_cast<std::size_t>(most)]]);
    }
    return result;
  }

 private:
  std::vector<std::size_t> first_;  // by body
  std::vector<std::array<std::uint32_t, 8>> corners_;
  std::vector<std::array<double, 8>> weights_;
};

/// Vectors of particles, of balls and of vertices, in the precision of the run.
template <class T>
std::vector<T> flat(const std::vector<Vec3>& particles, const std::vector<Vec3>& balls,
                    const std::vector<Vec3>& vertices) {
  std::vector<T> numbers;
  numbers.reserve(3 * (particles.size() + balls.size() + vertices.size()));
  for (const auto* part : {&particles, &balls, &vertices})
    for (const Vec3& v : *part)
      for (const double x : {v.x, v.y, v.z}) numbers.push_back(static_cast<T>(x));
  return numbers;
}

/// The same of numbers.
template <class T>
std::vector<T> flat(const std::vector<double>& particles, const std::vector<double>& balls,
                    const std::vector<double>& vertices) {
  std::vector<T> numbers;
  numbers.reserve(particles.size() + balls.size() + vertices.size());
  for (const auto* part : {&particles, &balls, &vertices})
    for (const double x : *part) numbers.push_back(static_cast<T>(x));
  return numbers;
}

/// What balls have of the quantities: their contacts are impulses, which no state holds.
struct BallQuantities {
  std::vector<double> speed;
  std::vector<Vec3> force;
};

BallQuantities ball_quantities(const Model& model, const State& state, const Inputs& inputs) {
  BallQuantities balls;
  for (std::uint32_t b = 0; b < model.ball_count(); ++b) {
    const bool flies = model.balls[b].launched(state.step);
    balls.speed.push_back(flies ? length(state.ball_velocity[b]) : 0.0);
    balls.force.push_back(flies ? ball_force(model, state, b, inputs).net : Vec3{});
  }
  return balls;
}

template <class T>
void write_points(Document& document, const Model& model, const State& state, const StateQuantities& q,
                  const MeshVertices& meshes, const Inputs& inputs) {
  std::vector<double> mass(model.mass.begin(), model.mass.end()), radius(model.particle_count(), 0.0);
  std::vector<std::uint8_t> pinned;
  for (const double w : model.inverse_mass) pinned.push_back(w == 0.0 ? 1 : 0);
  for (const Ball& ball : model.balls) {
    mass.push_back(ball.mass);
    radius.push_back(ball.radius);
    pinned.push_back(0);
  }
  mass.resize(mass.size() + meshes.count());
  radius.resize(mass.size());
  pinned.resize(mass.size());
  const auto vectors = [&](std::string_view name, const std::vector<Vec3>& particles,
                           const std::vector<Vec3>& balls) {
    document.array(name, flat<T>(particles, balls, meshes.means(particles)), 3);
  };
  document.add("<Points>\n");
  vectors("position", state.position, state.ball_position);
  document.add("</Points>\n<PointData Vectors=\"velocity\">\n");
  vectors("velocity", state.velocity, state.ball_velocity);
  vectors("angular-velocity", std::vector<Vec3>(model.particle_count()), state.ball_angular_velocity);
  document.array("mass", mass);
  document.array("radius", radius);
  document.array("pinned", pinned);
  const BallQuantities balls = ball_quantities(model, state, inputs);
  std::vector<std::uint8_t> contact = q.contact, of_vertices = meshes.nearest(q.contact);
  contact.resize(contact.size() + model.ball_count());
  contact.insert(contact.end(), of_vertices.begin(), of_vertices.end());
  document.array("speed", flat<T>(q.speed, balls.speed, meshes.means(q.speed)));
  document.array("mean-strain", flat<T>(q.mean_strain, std::vector<double>(model.ball_count()),
                                        meshes.means(q.mean_strain)));
  vectors("force", q.force, balls.force);
  vectors("contact-force", q.contact_force, std::vector<Vec3>(model.ball_count()));
  document.array("contact", contact);
  document.add("</PointData>\n");
}

/// Cells with the number of their body, −1 for balls; of springs also type, strain and tension.
template <class T>
void write_cells(Document& document, const Model& model, const StateQuantities& q,
                 const MeshVertices& meshes) {
  const std::uint64_t first_vertex = std::uint64_t{model.particle_count()} + model.ball_count();
  Cells balls, springs, faces;
  std::vector<std::int32_t> body(model.ball_count(), -1);
  std::vector<std::uint8_t> type(model.ball_count(), 255);
  for (std::uint64_t b = 0; b < model.ball_count(); ++b) balls.add({model.particle_count() + b});
  std::size_t owner = 0;
  for (const Spring& s : springs_of(model)) {
    while (owner < model.bodies.size() &&
           s.a >= model.bodies[owner].first_particle + model.bodies[owner].particle_count)
      ++owner;
    springs.add({s.a, s.b});
    body.push_back(static_cast<std::int32_t>(owner));
    type.push_back(static_cast<std::uint8_t>(model.spring_classes[s.spring_class].type));
  }
  for (std::size_t b = 0; b < model.bodies.size(); ++b) {
    const BodySkin& skin = model.bodies[b].skin;
    const std::uint64_t first = first_vertex + meshes.first(b);
    for (const auto& [t, u, v] : skin.triangles) faces.add({first + t, first + u, first + v});
    if (skin.empty())
      for (const auto& [p, q1, r, s] : surface_of(model.bodies[b]).quads) faces.add({p, q1, r, s});
    body.resize(balls.ends.size() + springs.ends.size() + faces.ends.size(), static_cast<std::int32_t>(b));
  }
  type.resize(body.size(), 255);
  std::vector<double> strain(model.ball_count());
  strain.insert(strain.end(), q.strain.begin(), q.strain.end());
  strain.resize(body.size());
  std::vector<T> tension(model.ball_count());
  for (const double f : q.tension) tension.push_back(static_cast<T>(f));
  tension.resize(body.size());
  balls.write(document, "Verts");
  springs.write(document, "Lines");
  faces.write(document, "Polys");
  document.add("<CellData Scalars=\"strain\">\n");
  document.array("body", body);
  document.array("spring-type", type);
  document.array("strain", strain);
  document.array("tension", tension);
  document.add("</CellData>\n");
}

}  // namespace

Status write_state_vtp(AtomicFile& file, const Sample& sample) {
  const Model& model = sample.model;
  const State& state = sample.state;
  const Inputs inputs = sample.inputs ? *sample.inputs : Inputs();
  ASPIC_CHECK(check_finite(state, file.path()));
  const MeshVertices meshes(model);
  std::uint64_t faces = 0;
  for (const Body& body : model.bodies)
    faces += body.skin.empty() ? surface_of(body).quads.size() : body.skin.triangles.size();
  Document document;
  document.add(
      "<?xml version=\"1.0\"?>\n<VTKFile type=\"PolyData\" version=\"1.0\" byte_order=\"LittleEndian\" "
      "header_type=\"UInt64\">\n<PolyData>\n<FieldData>\n");
  document.array("TimeValue",
                 std::vector<double>{static_cast<double>(state.step) * model.simulation.timestep});
  document.array("step", std::vector<std::int64_t>{static_cast<std::int64_t>(state.step)});
  document.add("</FieldData>\n");
  document.add(fmt::format(
      "<Piece NumberOfPoints=\"{}\" NumberOfVerts=\"{}\" NumberOfLines=\"{}\" NumberOfStrips=\"0\" "
      "NumberOfPolys=\"{}\">\n",
      model.particle_count() + std::uint64_t{model.ball_count()} + meshes.count(), model.ball_count(),
      spring_count(model), faces));
  const StateQuantities quantities = quantities_of(model, state, inputs);
  const auto write = [&]<class T>(T) {
    write_points<T>(document, model, state, quantities, meshes, inputs);
    write_cells<T>(document, model, quantities, meshes);
  };
  state.precision == Precision::single ? write(0.0f) : write(0.0);
  document.add("</Piece>\n</PolyData>\n");
  return document.write(file);
}

}  // namespace aspic
