// Motions for other programs, byte by byte; in the full tier those read them (tests/python/exports.py).
// (tests/python/exports).
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cstring>
#include <map>
#include <sstream>

#include "aspic/analysis.h"
#include "io/numbered_files.h"
#include "io/state_sink.h"
#include "io/state_vtp.h"
#include "io/zip_writer.h"
#include "model/skin_text.h"
#include "model/springs.h"
#include "support/model_building.h"
#include "support/random_state.h"
#include "support/temporary_directory.h"

namespace aspic {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

/// A net, a cloth and two balls, in the order of their kinds.
Model cloth_net_and_balls() {
  ModelSettings settings;
  settings.cloths.resize(1);
  settings.cloths[0].particles = {4, 3};
  settings.goal_nets.resize(1);
  settings.goal_nets[0].particles = {3, 3, 3};
  settings.balls.resize(2);
  settings.balls[1].radius = 0.5;
  return test::build(settings);
}

class Exports : public testing::Test {
 protected:
  std::unique_ptr<StateSink> open(const std::string& name, std::uint64_t every,
                                  Overwrite overwrite = Overwrite::refuse) {
    auto sink = try_open(name, every, overwrite);
    EXPECT_TRUE(sink.ok()) << sink.error().message();
    return std::move(*sink);
  }
  Result<std::unique_ptr<StateSink>> try_open(const std::string& name, std::uint64_t every,
                                              Overwrite overwrite = Overwrite::refuse) {
    return state_format_of("export", name)
        .open(dir_.file(name), every, overwrite, {"schema = 1\n", Integrator::explicit_euler});
  }
  /// A state of the model, other ones at other steps.
  State at(std::uint64_t step, Precision precision = Precision::single) const {
    State state = initial_state(model_, precision);
    state.step = step;
    const auto moved = [&](double x) {
      const double y = x + 0.125 * static_cast<double>(step);
      return precision == Precision::single ? static_cast<double>(static_cast<float>(y)) : y;
    };
    for (auto* vectors : {&state.position, &state.velocity, &state.ball_position})
      for (std::size_t i = 0; i < vectors->size(); ++i)
        (*vectors)[i] = {moved((*vectors)[i].x + static_cast<double>(i % 7)), moved((*vectors)[i].y),
                         moved(1.0)};
    return state;
  }
  void take(StateSink& sink, std::uint64_t step, Precision precision = Precision::single) {
    const Status taken = sink.take({model_, at(step, precision)});
    EXPECT_TRUE(taken.ok()) << taken.error().message();
  }
  void finish(StateSink& sink, std::uint64_t step, Precision precision = Precision::single) {
    const Status finished = sink.finish({model_, at(step, precision)});
    EXPECT_TRUE(finished.ok()) << finished.error().message();
  }

  test::TemporaryDirectory dir_;
  Model model_ = cloth_net_and_balls();
};

TEST_F(Exports, ACollectionNamesEverySampleAndItsTime) {
  const auto sink = open("a&b.pvd", 10);
  for (const std::uint64_t step : {0u, 10u, 20u}) take(*sink, step);
  EXPECT_EQ(sink->next_step(20), 30u);
  finish(*sink, 25);
  EXPECT_EQ(
      dir_.read("a&b.pvd"),
      "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"1.0\" byte_order=\"LittleEndian\">\n"
      "<Collection>\n"
      "<DataSet timestep=\"0\" group=\"\" part=\"0\" file=\"a&#38;b-00000000.vtp\"/>\n"
      "<DataSet timestep=\"0.01\" group=\"\" part=\"0\" file=\"a&#38;b-00000010.vtp\"/>\n"
      "<DataSet timestep=\"0.02\" group=\"\" part=\"0\" file=\"a&#38;b-00000020.vtp\"/>\n"
      "<DataSet timestep=\"0.025\" group=\"\" part=\"0\" file=\"a&#38;b-00000025.vtp\"/>\n"
      "</Collection>\n</VTKFile>\n");
  for (const std::uint64_t step : {0u, 10u, 20u, 25u}) {
    auto file = AtomicFile::create(dir_.file("state.vtp"), Overwrite::allow);
    ASSERT_TRUE(write_state_vtp(*file, {model_, at(step)}).ok() && file->commit().ok());
    EXPECT_TRUE(dir_.read(numbered("a&b.vtp", step)) == dir_.read("state.vtp")) << step;
  }
  EXPECT_EQ(dir_.entries(), 6u);
}

TEST_F(Exports, CollectionHoldsWarningsAsComment) {
  const auto sink = open("run.pvd", 10);
  take(*sink, 0);
  ASSERT_TRUE(
      sink->finish({.model = model_, .state = at(10), .warnings = R"([{"text":"a -- b ---"}])"}).ok());
  EXPECT_THAT(dir_.read("run.pvd"),
              HasSubstr("<!-- warnings: [{\"text\":\"a -\\u002d b -\\u002d-\"}] -->\n</Collection>\n"));
}

TEST_F(Exports, ACollectionCanBeReadWhileTheRunGoesOn) {
  {
    const auto sink = open("run.pvd", 10);
    take(*sink, 0);
    EXPECT_THAT(dir_.read("run.pvd"), HasSubstr("run-00000000.vtp"));
  }
  EXPECT_EQ(dir_.entries(), 2u) << "what was complete stays";
}

TEST_F(Exports, ACollectionDoesNotComeToOtherFiles) {
  dir_.write("run-00000300.vtp", "of another run");
  const Status taken = open("run.pvd", 10)->take({model_, at(0)});
  ASSERT_FALSE(taken.ok());
  EXPECT_THAT(taken.error().what, HasSubstr("run-00000300.vtp already exists"));
  EXPECT_TRUE(open("run.pvd", 10, Overwrite::allow)->take({model_, at(0)}).ok());
  EXPECT_EQ(dir_.read("run-00000300.vtp"), "of another run");
}

template <class T>
T number_at(const std::string& bytes, std::size_t offset) {
  T number = 0;
  EXPECT_LE(offset + sizeof(T), bytes.size());
  if (offset + sizeof(T) <= bytes.size()) std::memcpy(&number, bytes.data() + offset, sizeof(T));
  return number;
}

/// An OBJ file as it reads.
struct Object {
  std::vector<Vec3> vertices;
  std::map<std::string, std::vector<std::vector<std::uint32_t>>> faces, edges;  // by group, from 0
  std::map<std::string, double> said;                                           // "interval"

  explicit Object(const std::string& text) {
    std::istringstream lines(text);
    std::string line, group;
    while (std::getline(lines, line)) {
      std::istringstream words(line);
      std::string kind, name;
      words >> kind;
      if (kind == "v") {
        std::array<float, 3> v = {};
        words >> v[0] >> v[1] >> v[2];
        vertices.push_back({v[0], v[1], v[2]});
      } else if (kind == "g") {
        words >> group;
      } else if (kind == "#") {
        words >> name;
        words >> said[name];
      } else if (kind == "f" || kind == "l") {
        std::vector<std::uint32_t> corners;
        for (std::uint32_t corner = 0; words >> corner;) corners.push_back(corner - 1);
        (kind == "f" ? faces : edges)[group].push_back(corners);
      }
    }
  }
};

TEST_F(Exports, ACacheHasTheVerticesOfItsObject) {
  const auto sink = open("run.pc2", 10);
  for (const std::uint64_t step : {5u, 15u, 25u}) take(*sink, step);
  EXPECT_EQ(sink->next_step(25), 35u) << "samples are equally far apart, whatever the first";
  finish(*sink, 31);  // no even sample
  EXPECT_EQ(dir_.entries(), 2u);

  const Object object(dir_.read("run.obj"));
  EXPECT_EQ(object.said.at("samples"), 3.0);
  EXPECT_EQ(object.said.at("start"), 0.005);
  EXPECT_EQ(object.said.at("interval"), 0.01);
  const std::vector<Quad> cloth = surface_of(model_.bodies[1]).quads;
  ASSERT_EQ(object.faces.at("body-1").size(), cloth.size());
  EXPECT_EQ(object.faces.count("body-0"), 0u);

  const std::string cache = dir_.read("run.pc2");
  EXPECT_EQ(cache.substr(0, 12), std::string("POINTCACHE2\0", 12));
  EXPECT_EQ(number_at<std::int32_t>(cache, 12), 1);
  const auto count = static_cast<std::size_t>(number_at<std::int32_t>(cache, 16));
  EXPECT_EQ(count, object.vertices.size());
  EXPECT_EQ(number_at<float>(cache, 20), 0.0f);
  EXPECT_EQ(number_at<float>(cache, 24), 1.0f);
  EXPECT_EQ(number_at<std::int32_t>(cache, 28), 3);
  ASSERT_EQ(cache.size(), 32 + 3 * count * 12);
  const auto vertex = [&](std::size_t sample, std::size_t v) {
    const std::size_t offset = 32 + (sample * count + v) * 12;
    return Vec3{number_at<float>(cache, offset), number_at<float>(cache, offset + 4),
                number_at<float>(cache, offset + 8)};
  };
  for (std::size_t v = 0; v < count; ++v) EXPECT_EQ(vertex(0, v), object.vertices[v]) << v;

  // Vertices are named for the first time in their order.
  std::uint32_t next = 0;
  const auto named = [&](const std::vector<std::uint32_t>& corners) {
    for (const std::uint32_t corner : corners) {
      EXPECT_LE(corner, next);
      next = std::max(next, corner + 1);
    }
  };
  for (std::size_t sample = 0; sample < 3; ++sample) {
    const State state = at(5 + 10 * sample);
    for (std::size_t q = 0; q < cloth.size(); ++q)
      for (std::size_t corner = 0; corner < 4; ++corner)
        EXPECT_EQ(vertex(sample, object.faces.at("body-1")[q][corner]), state.position[cloth[q][corner]]);
    std::size_t edge = 0;
    for (const Spring& s :
         springs_of(model_, model_.bodies[0].first_particle, model_.bodies[0].particle_count)) {
      const auto& ends = object.edges.at("body-0")[edge++];
      EXPECT_EQ(vertex(sample, ends[0]), state.position[s.a]);
      EXPECT_EQ(vertex(sample, ends[1]), state.position[s.b]);
    }
    EXPECT_EQ(edge, object.edges.at("body-0").size());
    for (std::size_t b = 0; b < 2; ++b)
      for (const auto& face : object.faces.at("ball-" + std::to_string(b)))
        for (const std::uint32_t corner : face)
          EXPECT_NEAR(length(vertex(sample, corner) - state.ball_position[b]), model_.balls[b].radius, 1e-5);
  }
  for (const char* group : {"body-0", "body-1", "ball-0", "ball-1"}) {
    for (const auto& face : object.faces.count(group) ? object.faces.at(group) : object.edges.at(group))
      named(face);
  }
  EXPECT_EQ(next, count) << "every vertex is one of a face or an edge";
  // Seen from outside the corners of a ball's faces are counterclockwise.
  for (const auto& face : object.faces.at("ball-0")) {
    const Vec3 a = object.vertices[face[0]], b = object.vertices[face[1]], c = object.vertices[face[2]];
    EXPECT_GT(dot(cross(b - a, c - a), a - at(5).ball_position[0]), 0.0);
  }
}

TEST_F(Exports, ACacheRefusesAnUnevenSample) {
  const auto sink = open("run.pc2", 1);
  for (const std::uint64_t step : {0u, 17u, 33u, 50u}) take(*sink, step);  // 1/60 s, rounded
  const Status taken = sink->take({model_, at(52)});
  ASSERT_FALSE(taken.ok());
  EXPECT_EQ(taken.error().code, ErrorCode::usage);
  finish(*sink, 50);
  EXPECT_EQ(Object(dir_.read("run.obj")).said.at("samples"), 4.0);
  EXPECT_NEAR(Object(dir_.read("run.obj")).said.at("interval"), 1.0 / 60.0, 1e-6);
}

/// The arrays of an archive: every member's name, type, extents and bytes, by the table at its end.
struct Archive {
  struct Array {
    std::string head;
    std::string bytes;
    template <class T>
    std::vector<T> numbers() const {
      std::vector<T> all(bytes.size() / sizeof(T));
      std::memcpy(all.data(), bytes.data(), all.size() * sizeof(T));
      return all;
    }
  };
  std::map<std::string, Array> arrays;

  explicit Archive(const std::string& file) {
    const std::size_t end = file.size() - 22;
    EXPECT_EQ(number_at<std::uint32_t>(file, end), 0x06054b50u);
    EXPECT_EQ(number_at<std::uint32_t>(file, end - 20), 0x07064b50u);
    const std::size_t end64 = number_at<std::uint64_t>(file, end - 12);
    EXPECT_EQ(number_at<std::uint32_t>(file, end64), 0x06064b50u);
    const auto count = number_at<std::uint64_t>(file, end64 + 32);
    std::size_t row = number_at<std::uint64_t>(file, end64 + 48);
    std::size_t expected = 0;  // of the next member: they follow one another
    for (std::uint64_t i = 0; i < count; ++i) {
      EXPECT_EQ(number_at<std::uint32_t>(file, row), 0x02014b50u);
      const auto sum = number_at<std::uint32_t>(file, row + 16);
      const std::size_t name_size = number_at<std::uint16_t>(file, row + 28);
      const std::string name = file.substr(row + 46, name_size);
      const std::size_t size = number_at<std::uint64_t>(file, row + 46 + name_size + 4);
      const std::size_t offset = number_at<std::uint64_t>(file, row + 46 + name_size + 20);
      EXPECT_EQ(offset, expected);
      EXPECT_EQ(number_at<std::uint32_t>(file, offset), 0x04034b50u);
      EXPECT_EQ(number_at<std::uint32_t>(file, offset + 14), sum);
      EXPECT_EQ(file.substr(offset + 30, name_size), name);
      EXPECT_EQ(number_at<std::uint64_t>(file, offset + 30 + name_size + 4), size);
      const std::string content = file.substr(offset + 30 + name_size + 20, size);
      EXPECT_EQ(crc_of(content), sum) << name;
      expected = offset + 30 + name_size + 20 + size;
      row += 46 + name_size + 28;

      EXPECT_EQ(content.substr(0, 8), std::string("\x93NUMPY\1\0", 8));
      const std::size_t head = number_at<std::uint16_t>(content, 8);
      EXPECT_EQ((10 + head) % 64, 0u);
      EXPECT_EQ(content[10 + head - 1], '\n');
      EXPECT_EQ(name.substr(name.size() - 4), ".npy");
      arrays[name.substr(0, name.size() - 4)] = {content.substr(10, head), content.substr(10 + head)};
    }
    EXPECT_EQ(row, end64);
  }
};

template <class T>
std::vector<T> components(const std::vector<Vec3>& vectors) {
  std::vector<T> all;
  for (const Vec3& v : vectors)
    for (const double x : {v.x, v.y, v.z}) all.push_back(static_cast<T>(x));
  return all;
}

/// A sample's part of an array over time.
template <class T>
std::vector<T> sample_of(const Archive& archive, const std::string& name, std::size_t sample,
                         std::size_t samples) {
  const std::vector<T> all = archive.arrays.at(name).numbers<T>();
  const std::size_t each = all.size() / samples;
  return {all.begin() + static_cast<std::ptrdiff_t>(sample * each),
          all.begin() + static_cast<std::ptrdiff_t>((sample + 1) * each)};
}

template <class T>
void expect_arrays_of_states(const Archive& archive, const Model& model, const std::vector<State>& states) {
  const std::size_t t = states.size();
  for (std::size_t s = 0; s < t; ++s) {
    const State& state = states[s];
    EXPECT_EQ(sample_of<std::int64_t>(archive, "steps", s, t)[0], static_cast<std::int64_t>(state.step));
    EXPECT_EQ(sample_of<double>(archive, "time", s, t)[0], static_cast<double>(state.step) * 0.001);
    EXPECT_EQ(sample_of<T>(archive, "positions", s, t), components<T>(state.position));
    EXPECT_EQ(sample_of<T>(archive, "velocities", s, t), components<T>(state.velocity));
    EXPECT_EQ(sample_of<T>(archive, "ball-positions", s, t), components<T>(state.ball_position));
    EXPECT_EQ(sample_of<T>(archive, "ball-angular-velocities", s, t),
              components<T>(state.ball_angular_velocity));
    const StateQuantities q = quantities_of(model, state);
    EXPECT_EQ(sample_of<T>(archive, "speed", s, t), std::vector<T>(q.speed.begin(), q.speed.end()));
    EXPECT_EQ(sample_of<T>(archive, "strain", s, t), std::vector<T>(q.strain.begin(), q.strain.end()));
    EXPECT_EQ(sample_of<T>(archive, "tension", s, t), std::vector<T>(q.tension.begin(), q.tension.end()));
    EXPECT_EQ(sample_of<T>(archive, "force", s, t), components<T>(q.force));
    EXPECT_EQ(sample_of<T>(archive, "contact-force", s, t), components<T>(q.contact_force));
    EXPECT_EQ(sample_of<std::uint8_t>(archive, "contact", s, t), q.contact);
    const Measures m = measure(model, state);
    EXPECT_EQ(sample_of<double>(archive, "energy.elastic", s, t)[0], m.elastic);
    EXPECT_EQ(sample_of<double>(archive, "momentum", s, t), components<double>({m.momentum}));
  }
}

TEST_F(Exports, ArraysHoldEverySampleOneAfterTheOther) {
  for (const Precision precision : {Precision::single, Precision::double_}) {
    const std::string name = fmt::format("{}.npz", name_of(precision));
    const auto sink = open(name, 10);
    for (const std::uint64_t step : {0u, 10u, 20u}) take(*sink, step, precision);
    finish(*sink, 25, precision);
    const Archive archive(dir_.read(name));
    std::vector<State> states;
    for (const std::uint64_t step : {0u, 10u, 20u, 25u}) states.push_back(at(step, precision));
    const std::uint32_t n = model_.particle_count();
    EXPECT_THAT(
        archive.arrays.at("positions").head,
        testing::StartsWith(fmt::format("{{'descr': '<f{}', 'fortran_order': False, 'shape': (4,{},3,), }} ",
                                        precision == Precision::single ? 4 : 8, n)));
    if (precision == Precision::single)
      expect_arrays_of_states<float>(archive, model_, states);
    else
      expect_arrays_of_states<double>(archive, model_, states);
    EXPECT_EQ(archive.arrays.at("scene").bytes, "schema = 1\n");
    EXPECT_THAT(archive.arrays.at("scene").head,
                HasSubstr("'descr': '|S11', 'fortran_order': False, 'shape': (), "));
  }
}

TEST_F(Exports, ArraysHoldTheModel) {
  const auto sink = open("run.npz", 10);
  finish(*sink, 0);
  const Archive archive(dir_.read("run.npz"));
  const std::vector<Spring> springs = all_springs(model_);
  const auto ends = archive.arrays.at("model.springs").numbers<std::uint32_t>();
  const auto rest = archive.arrays.at("model.rest-length").numbers<double>();
  const auto cord = archive.arrays.at("model.cord").numbers<std::uint8_t>();
  ASSERT_EQ(ends.size(), 2 * springs.size());
  for (std::size_t s = 0; s < springs.size(); ++s) {
    EXPECT_EQ(ends[2 * s], springs[s].a);
    EXPECT_EQ(ends[2 * s + 1], springs[s].b);
    EXPECT_EQ(rest[s], model_.spring_classes[springs[s].spring_class].rest_length);
    EXPECT_EQ(cord[s], model_.spring_classes[springs[s].spring_class].cord ? 1 : 0);
  }
  std::vector<std::uint32_t> corners;
  for (const Quad& quad : surface_of(model_.bodies[1]).quads)
    corners.insert(corners.end(), quad.begin(), quad.end());
  EXPECT_EQ(archive.arrays.at("model.skin").numbers<std::uint32_t>(), corners);
  EXPECT_EQ(archive.arrays.at("model.skin-body").numbers<std::int32_t>(),
            std::vector<std::int32_t>(corners.size() / 4, 1));
  const auto body = archive.arrays.at("model.body").numbers<std::int32_t>();
  for (std::uint32_t i = 0; i < model_.particle_count(); ++i)
    EXPECT_EQ(body[i], i < model_.bodies[1].first_particle ? 0 : 1);
  EXPECT_THAT(archive.arrays.at("model.ball-radius").numbers<double>(),
              ElementsAre(model_.balls[0].radius, 0.5));
}

TEST_F(Exports, WithoutAnEndNothingLooksComplete) {
  for (const char* name : {"run.pc2", "run.npz"}) {
    {
      const auto sink = open(name, 10);
      take(*sink, 0);
      take(*sink, 10);
    }
    EXPECT_EQ(dir_.entries(), 0u) << name;
  }
}

TEST_F(Exports, WhatIsThereIsKept) {
  for (const char* name : {"run.pvd", "run.pc2", "run.npz"}) {
    dir_.write(name, "precious");
    EXPECT_FALSE(try_open(name, 10).ok()) << name;
  }
  dir_.write("other.obj", "precious");
  EXPECT_FALSE(try_open("other.pc2", 10).ok());
  EXPECT_EQ(dir_.read("other.obj"), "precious");
  EXPECT_EQ(dir_.entries(), 4u);
}

TEST_F(Exports, ADeviceIsNoPlace) {
  for (const StateFormat& format : state_formats()) {
    if (!format.motion) continue;
    const auto sink = format.open("/dev/null", 10, Overwrite::allow, {});
    ASSERT_FALSE(sink.ok()) << format.ending;
    EXPECT_EQ(sink.error().code, ErrorCode::usage);
  }
}

TEST_F(Exports, AStateThatIsNotFiniteIsRefused) {
  for (const char* name : {"run.pvd", "run.pc2", "run.npz"}) {
    const auto sink = open(name, 10);
    State state = at(0);
    state.velocity[3].y = std::numeric_limits<double>::quiet_NaN();
    const Status taken = sink->take({model_, state});
    ASSERT_FALSE(taken.ok());
    EXPECT_EQ(taken.error().code, ErrorCode::diverged);
  }
}

TEST_F(Exports, WithoutAnIntervalSamplesAreAFiftiethOfASecondApart) {
  const auto sink = open("run.npz", 0);
  take(*sink, 0);
  EXPECT_EQ(sink->next_step(0), 20u) << "0.02 s of 1 ms each";
}

// A mesh's vertices are where the corners of their cells put them; a body before and one after it have their
// own.
TEST_F(Exports, ACacheAndArraysHaveMeshes) {
  TriangleMesh tetrahedron;
  tetrahedron.vertices = {{-0.25, 0.0, 0.0}, {1.25, 0.5, 0.0}, {0.5, 1.0, 1.0}, {0.5, 0.25, 2.25}};
  tetrahedron.triangles = {{2, 1, 0}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}};
  ModelSettings settings;
  settings.cubes.resize(1);
  settings.cubes[0].particles_per_edge = 2;
  settings.voxels.resize(1);
  settings.voxels[0].layers = {{"1", "1"}};
  settings.voxels[0].skin = to_skin_text(tetrahedron);
  settings.cloths.resize(1);
  settings.cloths[0].particles = {2, 2};
  model_ = test::build(settings);
  const auto cache = open("run.pc2", 10), arrays = open("run.npz", 10);
  for (const std::uint64_t step : {0u, 10u}) {
    take(*cache, step);
    take(*arrays, step);
  }
  finish(*cache, 10);
  finish(*arrays, 10);
  const BodySkin& skin = model_.bodies[1].skin;
  const std::vector<Vec3> places = skin_positions(skin.binding, skin.corners, at(0).position);
  const Object object(dir_.read("run.obj"));
  ASSERT_EQ(object.vertices.size(), 8u + 4u + 4u);
  ASSERT_EQ(object.faces.at("body-1").size(), 4u);
  for (std::size_t f = 0; f < 4; ++f)
    for (std::size_t corner = 0; corner < 3; ++corner)
      EXPECT_LT(length(object.vertices[object.faces.at("body-1")[f][corner]] -
                       places[tetrahedron.triangles[f][corner]]),
                1e-5);
  const Archive archive(dir_.read("run.npz"));
  EXPECT_EQ(archive.arrays.at("model.mesh-triangles").numbers<std::uint32_t>(),
            (std::vector<std::uint32_t>{2, 1, 0, 0, 1, 3, 1, 2, 3, 2, 0, 3}));
  EXPECT_EQ(archive.arrays.at("model.mesh-body").numbers<std::int32_t>(), std::vector<std::int32_t>(4, 1));
  const auto corners = archive.arrays.at("model.mesh-corners").numbers<std::uint32_t>();
  const auto weights = archive.arrays.at("model.mesh-weights").numbers<double>();
  for (std::size_t v = 0; v < 4; ++v) {
    Vec3 sum;
    for (std::size_t n = 0; n < 8; ++n) sum = sum + weights[8 * v + n] * at(0).position[corners[8 * v + n]];
    EXPECT_LT(length(sum - places[v]), 1e-12);
  }
}

}  // namespace
}  // namespace aspic
