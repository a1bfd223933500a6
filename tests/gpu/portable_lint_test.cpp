#include "gpu/portable_lint.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "gpu/shader_source.h"

namespace aspic::testing {
namespace {

/// The offenses as "line rule text".
std::vector<std::string> found(std::string_view text, Branches branches) {
  std::vector<std::string> all;
  for (const PortabilityOffense& o : lint_portability(text, branches))
    all.push_back(fmt::format("{} {} {}", o.line, o.rule, o.text));
  return all;
}

/// What the snippets below share, in one line.
constexpr std::string_view declarations =
    "struct Inner { vec4 a; uint words[2]; }; struct Item { Inner inner; float mass; }; "
    "layout(std430, binding = 0) restrict readonly buffer Items { uint count; Item items[]; }; "
    "layout(std430, binding = 1) coherent buffer Named { Item first; vec4 row[4]; } named; "
    "layout(std140, binding = 0) uniform Settings { Item plain; }; "
    "float take(Item item) { return item.mass; } float take(float x) { return x; } "
    "void put(out float x) { x = 1.0; }\n";

struct Snippet {
  std::string_view text;
  std::string_view offenses;  ///< joined by "; "
};

class PortableLintOf : public ::testing::TestWithParam<Snippet> {};

TEST_P(PortableLintOf, FindsTheOffensesAndNoOthers) {
  const std::string text = fmt::format("{}{}", declarations, GetParam().text);
  EXPECT_EQ(fmt::format("{}", fmt::join(found(text, Branches::taken), "; ")), GetParam().offenses) << text;
}

INSTANTIATE_TEST_SUITE_P(
    Snippets, PortableLintOf,
    ::testing::Values(
        // Members of buffer blocks: whole, of arrays, of members, in nested calls, parentheses and choices.
        Snippet{"void main() { take(items[3]); }", "2 block-argument items[3]"},
        Snippet{"void main() { take(items[count].mass); }", "2 block-argument items[count].mass"},
        Snippet{"void main() { uint i = 0u; take(take(items[i + 1u].inner.words[1])); }",
                "2 block-argument items[i+1u].inner.words[1]"},
        Snippet{"void main() { float x = 2.0 * take((items[0])) + 1.0; }", "2 block-argument items[0]"},
        Snippet{"void main() { take(count > 1u ? items[0] : items[1]); }",
                "2 block-argument items[0]; 2 block-argument items[1]"},
        Snippet{
            "void main() { take(named.first); put(named.first.mass); take(named.row[2]); }",
            "2 block-argument named.first; 2 block-argument named.first.mass; 2 block-argument named.row[2]"},
        Snippet{"#define TAKE(x) take(x)\n#define FIRST items[0]\nvoid main() { TAKE(FIRST); }",
                "4 block-argument items[0]"},
        // Copies, values, swizzles, other blocks, built-in functions and constructors.
        Snippet{"void main() { Item copy = items[3]; take(copy); take(plain); take(items[0].mass + 1.0); }",
                ""},
        Snippet{"void main() { take(items[0].inner.a.x); min(items[0].mass, 1.0); vec3(items[0].mass); }",
                ""},
        Snippet{"float same(Item items) { return take(items); }", ""},
        // The other rules, each with what it must not mind.
        Snippet{"layout(binding = 2) buffer Loose { float y[]; };", "2 block-layout Loose"},
        Snippet{"uniform Loose { float y; };", "2 block-layout Loose"},
        Snippet{"layout(std430) buffer Two { float y[]; float z; };", "2 unsized-array y"},
        Snippet{"layout(std430) buffer Two { float y[2]; float z[]; };", ""},
        Snippet{"shared uint sum = 0u;", "2 shared-initializer shared"},
        Snippet{"shared uint sum, sums[2 * (3 + 1)]; const uint none = 0u;", ""},
        Snippet{"float f() { float x; return x; }", "2 uninitialized x"},
        Snippet{"float f() { vec2 a, b = vec2(0.0); b += a; return b.x; }", "2 uninitialized a"},
        Snippet{"float f() { float x; x += 1.0; return x; }", "2 uninitialized x"},
        Snippet{"float f() { float x, y; vec2 z; put(x); y = x; z.y = y; return take(z.y); }", ""},
        Snippet{"float f(bool b) { if (b) return 1.0; else return 2.0; }\nfloat g() { for (;;) {} }",
                "2 missing-return f; 3 missing-return g"},
        Snippet{"float f(bool b) { if (b) { return 1.0; } }", "2 missing-return f"},
        Snippet{"void f() { if (true) { }\n", "2 unbalanced }"},
        Snippet{"void f() {}\nfloat g() { return 1.0; }", ""},
        Snippet{"float later(float x);\nvoid main() { later(1.0); }", "2 undefined-function later"},
        Snippet{"float later(float x);\nfloat later(float x) { return x; }", ""},
        Snippet{"void main() { vec4 v = vec4(0.0); v.xyz[1] = 1.0; v.xy.x += 1.0; }",
                "2 complex-target xy; 2 complex-target xyz"},
        Snippet{"void main() { vec4 v = vec4(0.0); v.x = v.xyz[1]; v[1] = 1.0; v.xy = v.yx; }", ""},
        Snippet{"float a__b = 1.0;\n#define __X 1", "2 reserved-name a__b; 3 reserved-name __X"},
        Snippet{"#if MISSING == 1\n#endif", "2 undefined-macro MISSING"},
        Snippet{"#define A 2\n#if defined(B) || (A & 3) == 2 && !defined B\nfloat x__;\n#elif B\n#else\nint "
                "y__;\n#endif",
                "4 reserved-name x__"},
        Snippet{"#extension GL_NV_gpu_shader5 : enable\n#pragma optimize(off)\n#line 3",
                "2 directive extension; 3 directive pragma; 4 directive line"},
        Snippet{"#pragma optionNV(unroll none)\n#pragma optionNV(fastmath on)", "3 directive pragma"},
        Snippet{
            "#ifdef MISSING\n#extension all : warn\nfloat x__;\n#endif\n// take(items[3]) __\n/* __\n__ */",
            ""}));

TEST(PortableLint, NamesTheLineBehindContinuedLinesAndComments) {
  EXPECT_EQ(found("#define A \\\n  1\n/* x\n*/ float a__ = A;", Branches::taken),
            std::vector<std::string>{"4 reserved-name a__"});
}

TEST(PortableLint, SeesEveryBranchAndEveryDefinitionOfAMacro) {
  const std::string text = fmt::format(
      "{}#ifdef __cplusplus\nstruct Block {{\n#else\nuniform Block {{\n#endif\nfloat y; }};\n"
      "#ifdef A\n#define PASS(x) take(items[x])\n#else\n#define PASS(x) take(items[x + 1])\n#endif\n"
      "void main() {{ PASS(0); }}\n#if B == 2\nshared uint sum = 0u;\n#else\nshared uint total = 0u;\n#endif",
      declarations);
  EXPECT_EQ(found(text, Branches::every),
            (std::vector<std::string>{"5 block-layout Block", "13 block-argument items[0+1]",
                                      "13 block-argument items[0]", "15 shared-initializer shared",
                                      "17 shared-initializer shared"}));
}

TEST(PortableLint, ShadersAreCleanUnderAllDefines) {
  const gl::ShaderLibrary library;
  int programs = 0;
  for (const EmbeddedFile& file : embedded_shaders()) {
    if (file.text.find("void main()") == std::string_view::npos) continue;
    ++programs;
    const auto shader = library.flatten(file.name);
    ASSERT_TRUE(shader.ok()) << shader.error().message();
    for (const PortabilityOffense& offense : lint_portability(shader->text(), Branches::every)) {
      const auto [origin, line] = shader->origin(offense.line);
      ADD_FAILURE() << origin << ":" << line << ": " << offense.rule << " (" << offense.text << "), in "
                    << file.name;
    }
  }
  EXPECT_GT(programs, 80);
}

}  // namespace
}  // namespace aspic::testing
