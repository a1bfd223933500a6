// A state as VTK PolyData, read back by a reader of its own.
#include "io/state_vtp.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstring>
#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "io/state_sink.h"
#include "model/skin_text.h"
#include "model/springs.h"
#include "support/model_building.h"
#include "support/random_state.h"
#include "support/temporary_directory.h"

namespace aspic {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

/// Reads what the XML says of its arrays, and the arrays from the appended bytes.
class VtpFile {
 public:
  explicit VtpFile(std::string text) : text_(std::move(text)) {
    const std::string mark = "<AppendedData encoding=\"raw\">\n_";
    const std::size_t at = text_.find(mark);
    if (at == std::string::npos) return;
    xml_ = text_.substr(0, at);
    bytes_ = at + mark.size();
  }

  /// The value of an attribute of the first element that begins so.
  std::string attribute(const std::string& element, const std::string& name) const {
    const std::size_t at = xml_.find(element);
    if (at == std::string::npos) return "no " + element;
    const std::string tag = xml_.substr(at, xml_.find('>', at) - at);
    const std::size_t value = tag.find(" " + name + "=\"");
    if (value == std::string::npos) return "no " + name;
    const std::size_t first = value + name.size() + 3;
    return tag.substr(first, tag.find('"', first) - first);
  }

  /// The array of a name in a section ("Lines"), which must be of the type.
  template <class T>
  std::vector<T> array(const std::string& section, const std::string& name, const std::string& type) const {
    const std::size_t begin = xml_.find("<" + section), end = xml_.find("</" + section + ">");
    const std::size_t at = xml_.find("Name=\"" + name + "\"", begin);
    if (begin == std::string::npos || at == std::string::npos || at > end) {
      ADD_FAILURE() << "no " << name << " in " << section;
      return {};
    }
    const std::size_t tag = xml_.rfind("<DataArray", at);
    EXPECT_THAT(xml_.substr(tag, at - tag), HasSubstr("type=\"" + type + "\"")) << name;
    EXPECT_THAT(xml_.substr(at, xml_.find('>', at) - at), HasSubstr(" NumberOfTuples=\"")) << name;
    const std::size_t offset_at = xml_.find("offset=\"", at) + 8;
    const std::size_t offset = bytes_ + std::stoull(xml_.substr(offset_at));
    std::uint64_t size = 0;
    std::memcpy(&size, text_.data() + offset, sizeof(size));
    EXPECT_EQ(size % sizeof(T), 0u);
    EXPECT_LE(offset + 8 + size, text_.size());
    std::vector<T> values(size / sizeof(T));
    std::memcpy(values.data(), text_.data() + offset + 8, size);
    return values;
  }

 private:
  std::string text_, xml_;
  std::size_t bytes_ = 0;
};

/// A cloth, a net and two balls.
ModelSettings mixed() {
  ModelSettings settings;
  settings.cloths.resize(1);
  settings.cloths[0].particles = {4, 3};
  settings.cloths[0].pinned.names = {"left"};
  settings.goal_nets.resize(1);
  settings.goal_nets[0].particles = {3, 3, 3};
  settings.balls.resize(2);
  settings.balls[1].radius = 0.5;
  return settings;
}

std::string written(const Model& model, const State& state) {
  const test::TemporaryDirectory dir;
  auto file = AtomicFile::create(dir.file("s.vtp"), Overwrite::refuse);
  EXPECT_TRUE(file.ok());
  const Status status = write_state_vtp(*file, {model, state});
  EXPECT_TRUE(status.ok()) << status.error().message();
  EXPECT_TRUE(file->commit().ok());
  return dir.read("s.vtp");
}

template <class T>
void expect_same_numbers(const std::vector<T>& read, const std::vector<Vec3>& particles,
                         const std::vector<Vec3>& balls) {
  ASSERT_EQ(read.size(), 3 * (particles.size() + balls.size()));
  for (std::size_t i = 0; i < read.size(); ++i) {
    const Vec3& v = i / 3 < particles.size() ? particles[i / 3] : balls[i / 3 - particles.size()];
    EXPECT_EQ(static_cast<double>(read[i]), v[static_cast<int>(i % 3)]) << i;
  }
}

TEST(StateVtp, HoldsEveryNumberOfTheState) {
  const Model model = test::build(mixed());
  for (const Precision precision : {Precision::single, Precision::double_}) {
    State state = initial_state(model, precision);
    state.step = 250;
    for (std::size_t i = 0; i < state.position.size(); ++i)
      state.velocity[i] =
          static_cast<double>(static_cast<float>(0.1 * static_cast<double>(i))) * Vec3{1.0, -2.0, 0.5};
    const VtpFile file(written(model, state));
    EXPECT_EQ(file.attribute("<VTKFile", "type"), "PolyData");
    EXPECT_EQ(file.attribute("<VTKFile", "byte_order"), "LittleEndian");
    EXPECT_EQ(file.attribute("<VTKFile", "header_type"), "UInt64");
    EXPECT_THAT(file.array<double>("FieldData", "TimeValue", "Float64"), ElementsAre(0.25));
    if (precision == Precision::single) {
      expect_same_numbers(file.array<float>("Points", "position", "Float32"), state.position,
                          state.ball_position);
      expect_same_numbers(file.array<float>("PointData", "velocity", "Float32"), state.velocity,
                          state.ball_velocity);
    } else {
      expect_same_numbers(file.array<double>("Points", "position", "Float64"), state.position,
                          state.ball_position);
      expect_same_numbers(file.array<double>("PointData", "velocity", "Float64"), state.velocity,
                          state.ball_velocity);
      expect_same_numbers(file.array<double>("PointData", "angular-velocity", "Float64"),
                          std::vector<Vec3>(state.position.size()), state.ball_angular_velocity);
    }
  }
}

TEST(StateVtp, HasSpringsAsLinesSurfacesAsQuadsAndBallsAsVertices) {
  const Model model = test::build(mixed());
  State state = initial_state(model, Precision::double_);
  for (Vec3& x : state.position) x = 1.25 * x;
  const VtpFile file(written(model, state));
  const std::uint32_t particles = model.particle_count();
  const std::vector<Spring> springs = all_springs(model);
  EXPECT_EQ(file.attribute("<Piece", "NumberOfPoints"), std::to_string(particles + 2));
  EXPECT_EQ(file.attribute("<Piece", "NumberOfVerts"), "2");
  EXPECT_EQ(file.attribute("<Piece", "NumberOfLines"), std::to_string(springs.size()));
  EXPECT_EQ(file.attribute("<Piece", "NumberOfPolys"), "6")
      << "3 × 2 cells of the cloth; a net has no surface";

  EXPECT_THAT(file.array<std::int64_t>("Verts", "connectivity", "Int64"),
              ElementsAre(particles, particles + 1));
  const auto lines = file.array<std::int64_t>("Lines", "connectivity", "Int64");
  const auto ends = file.array<std::int64_t>("Lines", "offsets", "Int64");
  ASSERT_EQ(lines.size(), 2 * springs.size());
  const auto types = file.array<std::uint8_t>("CellData", "spring-type", "UInt8");
  const auto strain = file.array<double>("CellData", "strain", "Float64");
  const auto bodies = file.array<std::int32_t>("CellData", "body", "Int32");
  ASSERT_EQ(types.size(), 2 + springs.size() + 6);
  ASSERT_EQ(strain.size(), types.size());
  ASSERT_EQ(bodies.size(), types.size());
  for (std::size_t s = 0; s < springs.size(); ++s) {
    EXPECT_EQ(lines[2 * s], springs[s].a);
    EXPECT_EQ(lines[2 * s + 1], springs[s].b);
    EXPECT_EQ(ends[s], static_cast<std::int64_t>(2 * s + 2));
    EXPECT_EQ(types[2 + s], static_cast<int>(model.spring_classes[springs[s].spring_class].type));
    // Lengths of a tenth of a meter at positions of up to 10 m, rounded in double precision.
    EXPECT_NEAR(strain[2 + s], 0.25, 8 * 2.3e-16 * 10.0 / 0.1);
    EXPECT_EQ(bodies[2 + s], springs[s].a < model.bodies[1].first_particle ? 0 : 1);
  }
  EXPECT_THAT(std::vector<int>(types.begin(), types.begin() + 2), ElementsAre(255, 255));
  EXPECT_THAT(std::vector<int>(bodies.begin(), bodies.begin() + 2), ElementsAre(-1, -1));

  // Every quad winds around the same side of the cloth.
  const auto quads = file.array<std::int64_t>("Polys", "connectivity", "Int64");
  ASSERT_EQ(quads.size(), 24u);
  for (std::size_t q = 0; q < quads.size(); q += 4) {
    const auto at = [&](std::size_t k) { return state.position[static_cast<std::size_t>(quads[q + k])]; };
    EXPECT_GT(cross(at(1) - at(0), at(2) - at(0)).z, 0.0);
    EXPECT_GT(cross(at(2) - at(0), at(3) - at(0)).z, 0.0);
  }
  const auto pinned = file.array<std::uint8_t>("PointData", "pinned", "UInt8");
  for (std::uint32_t i = 0; i < particles; ++i) EXPECT_EQ(pinned[i], model.inverse_mass[i] == 0.0 ? 1 : 0);
  const auto radius = file.array<double>("PointData", "radius", "Float64");
  EXPECT_EQ(radius[0], 0.0);
  EXPECT_EQ(radius.back(), 0.5);
}

// A body of two cells that is drawn as a tetrahedron, before a cloth and a ball.
TEST(StateVtp, HasMeshesAsTrianglesInPlaceOfTheSurface) {
  TriangleMesh tetrahedron;
  tetrahedron.vertices = {{-0.25, 0.0, 0.0}, {1.25, 0.5, 0.0}, {0.5, 1.0, 1.0}, {0.5, 0.25, 2.25}};
  tetrahedron.triangles = {{2, 1, 0}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}};
  ModelSettings settings;
  settings.voxels.resize(1);
  settings.voxels[0].layers = {{"1", "1"}};
  settings.voxels[0].skin = to_skin_text(tetrahedron);
  settings.cloths.resize(1);
  settings.cloths[0].particles = {2, 2};
  settings.balls.resize(1);
  const Model model = test::build(settings);
  const std::size_t body = model.bodies[0].skin.empty() ? 1 : 0;
  const BodySkin& skin = model.bodies[body].skin;
  State state = initial_state(model, Precision::double_);
  for (std::size_t i = 0; i < state.position.size(); ++i) {
    const auto d = static_cast<double>(i);
    state.position[i] = state.position[i] + Vec3{0.01 * d, 0.002 * d * d, -0.03 * d};
    state.velocity[i] = {d, -1.0, 0.25 * d};
  }
  const VtpFile file(written(model, state));
  const std::uint64_t first = model.particle_count() + 1;
  EXPECT_EQ(file.attribute("<Piece", "NumberOfPoints"), std::to_string(first + 4));
  EXPECT_EQ(file.attribute("<Piece", "NumberOfPolys"), "5") << "of the cloth one";
  const auto faces = file.array<std::int64_t>("Polys", "connectivity", "Int64");
  const auto ends = file.array<std::int64_t>("Polys", "offsets", "Int64");
  const auto owners = file.array<std::int32_t>("CellData", "body", "Int32");
  ASSERT_EQ(ends.size(), 5u);
  ASSERT_EQ(owners.size(), 1 + all_springs(model).size() + 5);
  std::size_t triangles = 0;
  for (std::size_t f = 0; f < ends.size(); ++f) {
    const auto begin = static_cast<std::size_t>(f == 0 ? 0 : ends[f - 1]);
    if (static_cast<std::size_t>(ends[f]) - begin != 3) continue;
    EXPECT_EQ(owners[owners.size() - 5 + f], static_cast<std::int32_t>(body));
    for (std::size_t corner = 0; corner < 3; ++corner)
      EXPECT_EQ(faces[begin + corner],
                static_cast<std::int64_t>(first + tetrahedron.triangles[triangles][corner]));
    ++triangles;
  }
  EXPECT_EQ(triangles, 4u);
  std::vector<Vec3> places = state.position, velocities = state.velocity;
  for (const auto& [all, found] :
       {std::pair(&state.position, &places), std::pair(&state.velocity, &velocities)}) {
    const auto of_mesh = skin_positions(skin.binding, skin.corners, *all);
    found->push_back(all == &state.position ? state.ball_position[0] : state.ball_velocity[0]);
    found->insert(found->end(), of_mesh.begin(), of_mesh.end());
  }
  expect_same_numbers(file.array<double>("Points", "position", "Float64"), places, {});
  expect_same_numbers(file.array<double>("PointData", "velocity", "Float64"), velocities, {});
  EXPECT_EQ(file.array<double>("PointData", "mass", "Float64").back(), 0.0);
  for (const char* name : {"speed", "mean-strain"})
    EXPECT_EQ(file.array<double>("PointData", name, "Float64").size(), first + 4) << name;
  EXPECT_EQ(file.array<std::uint8_t>("PointData", "contact", "UInt8").size(), first + 4);
}

TEST(StateVtp, RefusesWhatIsNotFinite) {
  const test::TemporaryDirectory dir;
  const Model model = test::build(mixed());
  State state = initial_state(model, Precision::single);
  state.ball_velocity[1].y = std::numeric_limits<double>::infinity();
  auto file = AtomicFile::create(dir.file("s.vtp"), Overwrite::refuse);
  const Status status = write_state_vtp(*file, {model, state});
  ASSERT_FALSE(status.ok());
  EXPECT_EQ(status.error().code, ErrorCode::diverged);
  EXPECT_THAT(status.error().message(), HasSubstr("ball 1"));
}

TEST(StateFormats, AreChosenByTheEnding) {
  EXPECT_EQ(state_format_of("state", "a.vtp").ending, ".vtp");
  EXPECT_EQ(state_format_of("state", "a.csv").ending, ".csv");
  EXPECT_EQ(state_format_of("state", "a").ending, ".csv") << "the default";
  for (const StateFormat& format : state_formats()) {
    EXPECT_EQ(&state_format_of(format.option, fmt::format("a{}", format.ending)), &format);
    const test::TemporaryDirectory dir;
    const Model model = test::build(mixed());
    const State state = initial_state(model, Precision::single);
    const std::string name = fmt::format("a{}", format.ending);
    auto sink =
        format.open(dir.file(name), 0, Overwrite::refuse, {"schema = 1\n", Integrator::explicit_euler});
    ASSERT_TRUE(sink.ok()) << sink.error().message();
    EXPECT_TRUE((*sink)->take({model, state}).ok());
    EXPECT_TRUE((*sink)->finish({model, state}).ok());
    EXPECT_GT(dir.read(name).size(), 100u) << name;
  }
}

}  // namespace
}  // namespace aspic
