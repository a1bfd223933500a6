#include "io/state_vtp.h"

#include <fmt/format.h>

#include <bit>
#include <cstdint>
#include <cstring>
#include <initializer_list>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include "analysis/particle_force.h"
#include "aspic/analysis.h"
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

/// Vectors of particles, then of balls, in the precision of the run.
template <class T>
std::vector<T> flat(std::span<const Vec3> particles, std::span<const Vec3> balls) {
  std::vector<T> numbers;
  numbers.reserve(3 * (particles.size() + balls.size()));
  for (const auto& part : {particles, balls})
    for (const Vec3& v : part)
      for (const double x : {v.x, v.y, v.z}) numbers.push_back(static_cast<T>(x));
  return numbers;
}

/// The same of numbers.
template <class T>
std::vector<T> flat(const std::vector<double>& particles, const std::vector<double>& balls) {
  std::vector<T> numbers;
  numbers.reserve(particles.size() + balls.size());
  for (const auto* part : {&particles, &balls})
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
                  const Inputs& inputs) {
  const std::vector<Vec3> no_turning(model.particle_count());
  std::vector<double> mass(model.mass.begin(), model.mass.end()), radius(model.particle_count(), 0.0);
  std::vector<std::uint8_t> pinned;
  for (const double w : model.inverse_mass) pinned.push_back(w == 0.0 ? 1 : 0);
  for (const Ball& ball : model.balls) {
    mass.push_back(ball.mass);
    radius.push_back(ball.radius);
    pinned.push_back(0);
  }
  document.add("<Points>\n");
  document.array("position", flat<T>(state.position, state.ball_position), 3);
  document.add("</Points>\n<PointData Vectors=\"velocity\">\n");
  document.array("velocity", flat<T>(state.velocity, state.ball_velocity), 3);
  document.array("angular-velocity", flat<T>(no_turning, state.ball_angular_velocity), 3);
  document.array("mass", mass);
  document.array("radius", radius);
  document.array("pinned", pinned);
  const BallQuantities balls = ball_quantities(model, state, inputs);
  const std::vector<double> no_springs(model.ball_count());
  const std::vector<Vec3> no_contact(model.ball_count());
  std::vector<std::uint8_t> contact = q.contact;
  contact.resize(contact.size() + model.ball_count());
  document.array("speed", flat<T>(q.speed, balls.speed));
  document.array("mean-strain", flat<T>(q.mean_strain, no_springs));
  document.array("force", flat<T>(q.force, balls.force), 3);
  document.array("contact-force", flat<T>(q.contact_force, no_contact), 3);
  document.array("contact", contact);
  document.add("</PointData>\n");
}

/// Cells with the number of their body, −1 for balls; of springs also type, strain and tension.
template <class T>
void write_cells(Document& document, const Model& model, const StateQuantities& q) {
  Cells balls, springs, quads;
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
    for (const auto& [p, q1, r, s] : surface_of(model.bodies[b]).quads) {
      quads.add({p, q1, r, s});
      body.push_back(static_cast<std::int32_t>(b));
      type.push_back(255);
    }
  }
  std::vector<double> strain(model.ball_count());
  strain.insert(strain.end(), q.strain.begin(), q.strain.end());
  strain.resize(body.size());
  std::vector<T> tension(model.ball_count());
  for (const double f : q.tension) tension.push_back(static_cast<T>(f));
  tension.resize(body.size());
  balls.write(document, "Verts");
  springs.write(document, "Lines");
  quads.write(document, "Polys");
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
  std::uint64_t quads = 0;
  for (const Body& body : model.bodies) quads += surface_of(body).quads.size();
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
      std::uint64_t{model.particle_count()} + model.ball_count(), model.ball_count(), spring_count(model),
      quads));
  const StateQuantities quantities = quantities_of(model, state, inputs);
  const auto write = [&]<class T>(T) {
    write_points<T>(document, model, state, quantities, inputs);
    write_cells<T>(document, model, quantities);
  };
  state.precision == Precision::single ? write(0.0f) : write(0.0);
  document.add("</Piece>\n</PolyData>\n");
  return document.write(file);
}

}  // namespace aspic
