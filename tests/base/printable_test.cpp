#include "base/printable.h"

#include <gtest/gtest.h>

#include <string>

namespace aspic {
namespace {

TEST(Printable, LeavesTextAlone) {
  for (const char* text :
       {"", "a plain sentence.", "two\nlines", "Runge–Kutta, μ = 0.3, 漢字, 🙂", "C:\\n"})
    EXPECT_EQ(printable(text), text);
}

TEST(Printable, EscapesWhatActsOnATerminal) {
  EXPECT_EQ(printable("\x1b[31mred\a\r\t\x7f"), "\\x1b[31mred\\x07\\x0d\\t\\x7f");
  EXPECT_EQ(printable(std::string("a\0b", 3)), "a\\x00b");
  EXPECT_EQ(printable("\xc2\x9b"
                      "2J"),
            "\\u{9b}2J");  // CSI of C1
  EXPECT_EQ(printable("\xe2\x80\xae"
                      "cba"),
            "\\u{202e}cba");  // right-to-left override
  EXPECT_EQ(printable("\xe2\x81\xa6x\xe2\x81\xa9"), "\\u{2066}x\\u{2069}");
  EXPECT_EQ(printable("\xe2\x80\xa8"), "\\u{2028}");  // line separator
  EXPECT_EQ(printable("\xef\xbb\xbfk"), "\\u{feff}k");
}

TEST(Printable, EscapesWhatIsNotUtf8) {
  EXPECT_EQ(printable("caf\xe9"), "caf\\xe9");
  EXPECT_EQ(printable("\x9b"
                      "2J"),
            "\\x9b2J");
  EXPECT_EQ(printable("\xc0\xaf"), "\\xc0\\xaf");           // overlong
  EXPECT_EQ(printable("\xed\xa0\x80"), "\\xed\\xa0\\x80");  // a surrogate
  EXPECT_EQ(printable("\xf4\x90\x80\x80"), "\\xf4\\x90\\x80\\x80");
  EXPECT_EQ(printable("\xe2\x80"), "\\xe2\\x80");  // cut short
}

TEST(Printable, LineFeedsOfNamesAreEscapedOnOneLine) {
  EXPECT_EQ(printable_line("a\nb"), "a\\nb");
}

// Whatever bytes come in, what goes out is valid and stays as it is when it comes again.
TEST(Printable, OfAnyBytesIsItsOwnImage) {
  std::string bytes;
  for (int first = 0; first < 256; ++first)
    for (int second = 0; second < 256; second += 5)
      bytes += {static_cast<char>(first), static_cast<char>(second)};
  const std::string once = printable(bytes);
  EXPECT_EQ(printable(once), once);
  for (const char c : once) EXPECT_TRUE(c == '\n' || static_cast<unsigned char>(c) >= 0x20) << int(c);
}

TEST(Printable, ExcerptsCountCharacters) {
  EXPECT_EQ(excerpt("μμμμ", 4), "μμμμ");
  EXPECT_EQ(excerpt("μμμμ", 3), "μμμ…");
  EXPECT_EQ(excerpt("\x1b\n\x1b", 2), "\\x1b\\n…");
}

}  // namespace
}  // namespace aspic
