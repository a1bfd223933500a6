#include "repository/class_lint.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "repository/text_lint.h"

namespace aspic::testing {
namespace {

std::vector<std::string> sizes(std::string_view header) {
  std::vector<std::string> result;
  for (const ClassSize& size : class_sizes(header))
    result.push_back(size.name + " " + std::to_string(size.methods));
  return result;
}

TEST(ClassLint, CountsPublicMethodsAlone) {
  EXPECT_THAT(sizes(R"(
#define NOT_A_METHOD() { \
  }
class Simulation final : public Base {
 public:
  Simulation(int a) : a_(a), b_{2} {}
  ~Simulation();
  Simulation& operator=(const Simulation&) = delete;
  void gone() = delete;
  static Result<std::unique_ptr<Simulation>> create(gl::Context& context, int n = most(3));  // one()
  const Pacer& pacer() const { return pacer_; }
  Pacer& pacer() { return pacer_; }
  void set(int step, std::function<void(double)> act = {});
  void set(double time);
  template <class Act>
  void for_each(const Act& act) const {
    for (int i = 0; i < 3; ++i) act(i);
  }
  struct Entry {
    int step = 0;
    bool first() const { return step == 0; }
  };
  enum class Kind { one, two };
  friend bool operator==(const Simulation&, const Simulation&) = default;
  std::function<void(int)> changed;
  std::array<double, 2> ends = {lower(), upper()};
  double most = 1'000.0, least{0.0};

 protected:
  void hook();

 private:
  void own();
};
)"),
              ::testing::ElementsAre("Simulation 5", "Entry 1"));
}

TEST(ClassLint, StructsArePublicAtFirst) {
  EXPECT_THAT(sizes("struct Parts { void a(); int b() const; private: void c(); };\n"
                    "enum class Kind { a };\nclass Later;\nclass Outer::Inner { void d(); };"),
              ::testing::ElementsAre("Parts 2", "Outer::Inner 0"));
}

TEST(ClassLint, NoClassIsLarge) {
  constexpr std::size_t most = 25;
  const std::filesystem::path root = ASPIC_SOURCE_DIR;
  std::size_t classes = 0;
  for (const auto& file : written_files(root)) {
    const std::string name = file.generic_string();
    if (file.extension() != ".h" || !(name.starts_with("src/") || name.starts_with("include/"))) continue;
    for (const ClassSize& size : class_sizes(contents(root / file))) {
      EXPECT_LE(size.methods, most) << name << ": divide " << size.name << " by what changes together";
      ++classes;
    }
  }
  EXPECT_GE(classes, 300u);
}

}  // namespace
}  // namespace aspic::testing
