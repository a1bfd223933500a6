#include "repository/comment_lint.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "repository/text_lint.h"

namespace aspic::testing {
namespace {

std::vector<std::string> found(std::string_view header) {
  std::vector<std::string> result;
  for (const Uncommented& declaration : uncommented(header))
    result.push_back(std::to_string(declaration.line) + " " + declaration.name);
  return result;
}

TEST(CommentLint, FindsWhatNothingIsSaidOf) {
  EXPECT_THAT(found(R"(#pragma once
// Not for Doxygen.
struct Plain {
  int a = 0;
  double b = 0.0, c{1.0};  // neither is this
  std::array<int, 3> d() const { return {a, a, a}; }
};
enum class Kind { one, two };
using Number = double;
inline constexpr Named<Kind> kinds[] = {{Kind::one, "one"},
                                        {Kind::two, "two; {"}};
template <class T>
void act(T& on, std::function<void(int)> then = {});
ASPIC_API std::map<int,
                   double> table(int n);

)"),
              ::testing::ElementsAre("3 Plain", "4 a", "5 b", "6 d", "8 Kind", "9 Number", "10 kinds",
                                     "12 act", "14 table"));
}

TEST(CommentLint, AcceptsCommentsAboveAndBehind) {
  EXPECT_THAT(found(R"(
namespace aspic {
class Later;
struct Announced;  // of a table

/// Said in
/// two lines.
template <class T>
class [[nodiscard]] ASPIC_API Solver : public Base {
 public:
  Solver(int n) : n_(n), list_{n} {}
  explicit Solver(double);
  virtual ~Solver();
  Solver& operator=(const Solver&) = delete;
  explicit operator bool() const { return n_ > 0; }
  friend bool operator==(const Solver&, const Solver&) = default;

  /// For both.
  T& value() & { return n_; }
  const T& value() const& { return n_; }
  int most = 1'000, least = 0;  ///< behind
  std::string_view name() const {  ///< behind the brace
    return "a { b; // c";
  }
  /// Inside.
  struct Entry {
    int step = 0;  ///< [1]
  };

 private:
  void own();
  struct Parts {
    int hidden;
    enum class Inner { a, b };
  };
  int n_ = 0;
};

/// The values explain themselves.
enum class Kind { one, two };

#define ANY(x) \
  int x;
static_assert(sizeof(int) == 4);
}  // namespace aspic
)"),
              ::testing::IsEmpty());
}

TEST(CommentLint, EmptyLinesAndOtherNamesEndWhatIsShared) {
  EXPECT_THAT(found("/// Both.\nint f(int);\nint f(double);\nint g();\n/// Lost.\n\nint h();\n"
                    "/// One.\nint i(int);\n\nint i(double);\n"),
              ::testing::ElementsAre("4 g", "7 h", "11 i"));
}

TEST(CommentLint, MembersAfterHiddenOnesAndValuesOfOneEnumerationAreFound) {
  EXPECT_THAT(found("/// A.\nclass A {\n  int a;\n protected:\n  void hook();\n};\n"
                    "/// B.\nenum class B {\n  one,  ///< said\n  two\n};\n"),
              ::testing::ElementsAre("5 hook", "10 two"));
}

TEST(CommentLint, PublicHeadersSayWhatTheyDeclare) {
  const std::filesystem::path root = ASPIC_SOURCE_DIR;
  std::size_t headers = 0;
  const auto check = [&](const std::filesystem::path& file) {
    for (const Uncommented& declaration : uncommented(contents(file)))
      ADD_FAILURE() << file.string() << ":" << declaration.line << ": " << declaration.name
                    << " has no comment: say its shape, unit, legal range and errors";
    ++headers;
  };
  for (const auto& entry : std::filesystem::directory_iterator(root / "include/aspic")) check(entry.path());
  check(root / "cmake/version.h.in");
  EXPECT_GE(headers, 15u);
}

/// Whether a structure holds what is more than a value.
bool owns_something(const std::string& text, std::size_t at) {
  return text.substr(at, text.find("\n};", at) - at).find("unique_ptr<") != std::string::npos;
}

/// The declarations of what may not be used on several threads at once say so.
TEST(CommentLint, EveryPublicClassSaysItsThreads) {
  const std::filesystem::path root = ASPIC_SOURCE_DIR;
  std::size_t classes = 0;
  for (const auto& entry : std::filesystem::directory_iterator(root / "include/aspic")) {
    const std::string text = contents(entry.path());
    for (std::size_t at = text.find('\n'); at != std::string::npos; at = text.find('\n', at + 1)) {
      const std::string name = text.substr(at + 1, text.find('\n', at + 1) - at - 1);
      const bool structure = name.starts_with("struct ") && owns_something(text, at);
      if (!name.ends_with('{') || !(structure || name.starts_with("class "))) continue;
      const std::string above = text.substr(0, at);
      EXPECT_THAT(above.substr(above.rfind("\n\n") + 2), ::testing::HasSubstr("thread")) << name;
      ++classes;
    }
  }
  EXPECT_GE(classes, 8u);
}

}  // namespace
}  // namespace aspic::testing
