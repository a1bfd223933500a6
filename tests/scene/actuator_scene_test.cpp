// Actuators as scenes have them.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdint>
#include <fstream>
#include <string>
#include <vector>

#include "model/model.h"
#include "scene/scene_support.h"
#include "scene/write.h"
#include "support/temporary_directory.h"

namespace aspic {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::StartsWith;

const std::string body =
    "schema = 1\n[material]\nmuscle = { youngs-modulus = 1e5 }\nfat = { density = 900.0 }\n"
    "[[voxels]]\nname = \"worm\"\nsize = 0.01\npalette = { 1 = \"muscle\", 2 = \"fat\" }\n"
    "layers = [[\"11.11\", \"11.11\"], [\"22222\", \"22222\"]]\n[[cube]]\nparticles-per-edge = 3\n";
const std::string actuator = body + "[[actuator]]\nname = \"legs\"\nbody = \"worm\"\n";

ActuatorSettings read(const std::string& keys, const std::vector<std::string>& arguments = {}) {
  return test::parsed(actuator + keys, arguments).model.actuators.at(0);
}

TEST(ActuatorScene, ReadsTheSyntaxOfItsReference) {
  const ActuatorSettings a = read(
      "select = { material = \"muscle\", springs = [\"structural\", \"shear\"], box.min = [-1, -1, -1], "
      "box.max = [1, 1, 1] }\n"
      "axis = \"y\"\nvolume-change = 0.5\nsignal = \"triangle\"\nfrequency = 2.0\n"
      "phase = { along = \"x\", wavelength = 0.1, offset = 0.25 }\nstart = 1.0\nramp = 0.5\n");
  EXPECT_THAT(a.bodies, ElementsAre("worm"));
  EXPECT_THAT(a.select.materials, ElementsAre("muscle"));
  EXPECT_THAT(a.select.springs, ElementsAre("structural", "shear"));
  EXPECT_EQ(a.select.box->min, (Vec3{-1.0, -1.0, -1.0}));
  EXPECT_EQ(a.axis, BodyAxis::y);
  EXPECT_EQ(a.volume_change, 0.5);
  EXPECT_EQ(a.signal, Signal::triangle);
  EXPECT_EQ(a.frequency, 2.0);
  EXPECT_EQ(a.phase.along, BodyAxis::x);
  EXPECT_EQ(a.phase.wavelength, 0.1);
  EXPECT_EQ(a.phase.offset, 0.25);
  EXPECT_EQ(a.start, 1.0);
  EXPECT_EQ(a.ramp, 0.5);
  EXPECT_EQ(read("phase = 0.25\n").phase.offset, 0.25);
  const ActuatorSettings table = read("table = [[0, 0], [0.5, 1], [1, 0]]\n");
  EXPECT_EQ(table.signal, Signal::table);
  EXPECT_EQ(table.table, (SignalTable{{0.0, 0.0}, {0.5, 1.0}, {1.0, 0.0}}));
  EXPECT_EQ(read("select.voxels = [[\"1....\", \"1....\"], [\".....\", \".....\"]]\n").select.voxels.size(),
            2u);
  const Scene two = test::parsed(body + "[[actuator]]\nbody = [\"worm\", \"cube[0]\"]\n");
  EXPECT_THAT(two.model.actuators[0].bodies, ElementsAre("worm", "cube[0]"));
}

TEST(ActuatorScene, WrittenAndReadAgainItIsTheSame) {
  for (const char* const keys : {"", "amplitude = 0.2\nphase = 0.75\n",
                                 "volume-change = -0.25\nphase = { along = \"z\", wavelength = -0.5 }\n",
                                 "signal = \"table\"\ntable = [[0, 0.125], [3, 1e-5]]\nselect = { material = "
                                 "[\"muscle\", \"fat\"] }\n",
                                 "select.springs = [\"bending\"]\nselect.box.max = [0.1, 1e3, "
                                 "1e3]\nphase.cells = \"5 2 2: 0 0 0 0 0 0 0 0 0 0 "
                                 "0.5 0 0 0 0 0 0 0 0 0.1\"\n"}) {
    const Scene scene = test::parsed(actuator + keys);
    test::expect_same_scene(scene, test::parsed(to_toml(scene)));
  }
  EXPECT_THAT(to_toml(test::parsed(actuator + "phase = 0.75\n")), HasSubstr("\nphase = 0.75"));
  EXPECT_THAT(to_toml(test::parsed(actuator)), HasSubstr("\nbody = \"worm\""));
}

TEST(ActuatorScene, ArgumentsReachItByName) {
  const std::vector<std::string> arguments = {"actuator[legs].frequency=3", "actuator[legs].phase=0.5",
                                              "actuator[0].volume-change=0.2"};
  const ActuatorSettings a =
      read("amplitude = 0.3\nphase = { along = \"x\", wavelength = 0.1 }\n", arguments);
  EXPECT_EQ(a.frequency, 3.0);
  EXPECT_EQ(a.phase.offset, 0.5);
  EXPECT_EQ(a.phase.along, BodyAxis::none);
  EXPECT_EQ(a.volume_change, 0.2);
  const ActuatorSettings back =
      read("volume-change = 0.3\nsignal = \"sine\"\n",
           {"actuator[legs].amplitude=0.1", "actuator[legs].table=[[0, 1], [1, 1]]"});
  EXPECT_FALSE(back.volume_change.has_value());
  EXPECT_EQ(back.amplitude, 0.1);
  EXPECT_EQ(back.signal, Signal::table);
  EXPECT_THAT(test::rejection(actuator, {"actuator[legs].freqency=3"}),
              HasSubstr("did you mean 'frequency'?"));
}

TEST(ActuatorScene, RejectionsPointToTheKey) {
  const auto rejection = [](const std::string& keys) { return test::rejection(actuator + keys); };
  EXPECT_THAT(test::rejection(body + "[[actuator]]\nbody = [\"worm\", \"snake\"]\n"),
              StartsWith("scene.toml:13:17: 'actuator.body': there is no body \"snake\""));
  EXPECT_THAT(rejection("select.material = \"bone\"\n"),
              StartsWith("scene.toml:15:19: 'actuator.select.material'"));
  EXPECT_THAT(rejection("amplitude = 0.2\nvolume-change = 0.1\n"),
              HasSubstr("scene.toml:16:1: an actuator has either"));
  EXPECT_THAT(rejection("signal = \"sine\"\ntable = [[0, 0], [1, 1]]\n"),
              HasSubstr("scene.toml:16:1: 'actuator.table' needs the signal"));
  EXPECT_THAT(rejection("table = [[0, 0], [2, 1], [1, 0]]\n"),
              StartsWith("scene.toml:15:26: 'actuator.table': times must"));
  EXPECT_THAT(rejection("phase = \"none.npy\"\n"), HasSubstr("'actuator.phase'"));
  EXPECT_THAT(rejection("select.box.min = [5, 5, 5]\nselect.box.max = [6, 6, 6]\n"),
              HasSubstr("selects no cell of worm"));
  EXPECT_THAT(rejection("phase.cells = \"1 1 1: 0\"\n"),
              HasSubstr("scene.toml:15:15: 'actuator.phase.cells': it has 1 × 1 × 1"));
  EXPECT_THAT(test::rejection(actuator + "[[actuator]]\nname = \"legs\"\n"), HasSubstr("is taken"));
}

TEST(ActuatorScene, InputFilesNameChannels) {
  const Scene scene =
      test::parsed(actuator + "signal = \"input\"\n[[actuator]]\nsignal = \"input\"\nbody = \"worm\"\n");
  const auto model = build_model(scene.model);
  ASSERT_TRUE(model.ok());
  const auto read = [&](const std::string& channels) {
    return parse_inputs("[[inputs]]\nstep = 3\nchannels = " + channels + "\n", "in.toml",
                        {scene.model, *model});
  };
  const auto by_name = read("{ legs = 0.5, \"actuator[1]\" = -1 }");
  ASSERT_TRUE(by_name.ok()) << by_name.error().what;
  EXPECT_THAT(by_name->at(3).channels, ElementsAre(0.5, -1.0));
  EXPECT_THAT(read("{ legs = 0.5 }")->at(3).channels, ElementsAre(0.5, 0.0));
  EXPECT_THAT(read("{ leg = 0.5 }").error().what,
              HasSubstr("in.toml:3:14: no actuator 'leg' reads a channel"));
  EXPECT_THAT(read("{ leg = 0.5 }").error().what, HasSubstr("did you mean 'legs'?"));
  EXPECT_THAT(read("[1, 2, 3]").error().what, HasSubstr("channels[2]: the scene reads 2 channels"));
}

/// numpy's file of float64 or bool in C order.
void write_npy(const std::filesystem::path& path, const std::string& type, const std::string& shape,
               const std::string& bytes) {
  std::string header = "{'descr': '" + type + "', 'fortran_order': False, 'shape': " + shape + ", }";
  header.resize((10 + header.size() + 1 + 63) / 64 * 64 - 11, ' ');
  header += '\n';
  std::ofstream file(path, std::ios::binary);
  file << "\x93NUMPY" << '\x01' << '\0' << static_cast<char>(header.size() & 255)
       << static_cast<char>(header.size() >> 8) << header << bytes;
}

TEST(ActuatorScene, TakesMasksAndPhasesFromFiles) {
  const test::TemporaryDirectory dir;
  std::string mask(20, '\0'), phases;
  mask[0] = mask[1] = 1;  // x = 0, y = 0, z = 0 and 1
  for (int n = 0; n < 20; ++n) {
    const double phase = 0.125 * n;
    phases.append(reinterpret_cast<const char*>(&phase), sizeof phase);
  }
  write_npy(dir.file("mask.npy"), "|b1", "(5, 2, 2)", mask);
  write_npy(dir.file("phase.npy"), "<f8", "(5, 2, 2)", phases);
  const std::string text = actuator + "select.voxels = \"mask.npy\"\nphase = \"phase.npy\"\n";
  std::ofstream(dir.file("worm.toml")) << text;
  const auto scene = load_scene(dir.file("worm.toml"));
  ASSERT_TRUE(scene.ok()) << scene.error().what;
  const ActuatorSettings& a = scene->model.actuators.at(0);
  EXPECT_EQ(a.select.voxels, (CellLayers{{"1....", "1...."}, {".....", "....."}}));
  EXPECT_THAT(a.phase.cells, StartsWith("5 2 2: 0 0.125 0.25"));
  test::expect_same_scene(*scene, test::parsed(to_toml(*scene)), "name");
  std::ofstream(dir.file("wrong.toml")) << actuator + "phase = \"mask.toml\"\n";
  EXPECT_FALSE(load_scene(dir.file("wrong.toml")).ok());
}

}  // namespace
}  // namespace aspic
