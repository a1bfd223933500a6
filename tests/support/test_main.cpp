// The main function of every test binary.
#include <gtest/gtest.h>

#include <cstdio>
#include <cstdlib>

int main(int argc, char** argv) {
  // The user's shader cache is not ours to use or to fill.
  ::setenv("ASPIC_SHADER_CACHE", "off", 0);
  testing::InitGoogleTest(&argc, argv);
  const int code = RUN_ALL_TESTS();
  // GoogleTest calls that a success: a misspelt filter would pass for ever.
  if (!GTEST_FLAG_GET(list_tests) && testing::UnitTest::GetInstance()->test_to_run_count() == 0) {
    std::fprintf(stderr, "No test of %s matches --gtest_filter=%s.\n", argv[0],
                 GTEST_FLAG_GET(filter).c_str());
    return 1;
  }
  return code;
}
