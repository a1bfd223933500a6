#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/result.h"

namespace aspic {
namespace {

using testing::HasSubstr;

constexpr FrontEnd front_ends[] = {FrontEnd::library, FrontEnd::command_line, FrontEnd::window,
                                   FrontEnd::python};

std::string remedy_in(FrontEnd front_end, RemedyKind kind) {
  return worded({ErrorCode::io, "It is so.", {{kind, {"12", "34"}}}}, front_end);
}

// Whatever a row says becomes a sentence, with its values, and none but the command line names options.
TEST(Wording, EveryRemedyIsASentenceInEveryFrontEnd) {
  for (std::size_t n = 0; n <= static_cast<std::size_t>(RemedyKind::give_checkpoint); ++n) {
    const auto kind = static_cast<RemedyKind>(n);
    for (const FrontEnd front_end : front_ends) {
      const std::string text = remedy_in(front_end, kind);
      SCOPED_TRACE(text);
      // A window that cannot draw has no other place to, and asks before it overwrites.
      if (front_end == FrontEnd::window && text == "It is so.") continue;
      EXPECT_THAT(text, testing::MatchesRegex("It is so\\. (12|[A-Z]).*\\."));
      EXPECT_EQ(text.find("--") != std::string::npos && front_end != FrontEnd::command_line, false);
    }
  }
}

TEST(Wording, NamesAWayAsItIsDoneThere) {
  const Error error = advised(fail(ErrorCode::io, "{} is there", "a.csv"),
                              {advice("choose another name"), {RemedyKind::overwrite}, use_backend("cpu")});
  EXPECT_EQ(worded(error, FrontEnd::command_line),
            "a.csv is there. Choose another name, overwrite with --force, or use --backend cpu.");
  EXPECT_EQ(worded(error, FrontEnd::python),
            "a.csv is there. Choose another name, pass overwrite=True, or pass backend=\"cpu\".");
  EXPECT_EQ(worded(error, FrontEnd::window),
            "a.csv is there. Choose another name, or switch to the cpu backend (key G).");
  EXPECT_EQ(error.message(), worded(error, FrontEnd::library));
  EXPECT_THAT(error.message(), HasSubstr("pass Overwrite::allow, or use the backend \"cpu\"."));
}

TEST(Wording, WithoutARemedyItIsWhatHappened) {
  EXPECT_EQ((Error{ErrorCode::io, "no such file"}.message()), "no such file");
  const Error device = {ErrorCode::no_device, "There is none", {{RemedyKind::draw_nothing, {"cpu"}}}};
  EXPECT_EQ(worded(device, FrontEnd::window), "There is none");
  EXPECT_EQ(worded(device, FrontEnd::command_line), "There is none. Use --backend cpu without images.");
}

// What an error led to keeps its remedies, after those of its own, each once; below lines of text they begin
// a line.
TEST(Wording, ErrorsHandOnTheirRemedies) {
  const Error cause = advised(fail(ErrorCode::no_device, "no memory"), {advice("wait"), use_backend("cpu")});
  const Error error = advised(fail(cause, "it said:\n  {}\n", cause.what), {use_backend("cpu")});
  EXPECT_EQ(error.code, ErrorCode::no_device);
  EXPECT_EQ(worded(error, FrontEnd::command_line), "it said:\n  no memory\nUse --backend cpu, or wait.");
}

}  // namespace
}  // namespace aspic
