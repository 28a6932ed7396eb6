#include "core/printable.h"

#include <gtest/gtest.h>

namespace tessera {
namespace {

TEST(Printable, KeepsTextOfAnyLanguage) {
    for (const char* text : {"", "fx: 1.5", "Bücher, 本, 🪑", "a\\b", "50 %"})
        EXPECT_EQ(Printable(text), text);
}

TEST(Printable, ShowsEveryOtherByte) {
    EXPECT_EQ(Printable("\x1b[2J\x07 a\tb\r\n"), "\\x1b[2J\\x07 a\\x09b\\x0d\\x0a");
    EXPECT_EQ(Printable(std::string_view("\0x\x7f", 3)), "\\x00x\\x7f");
    // A lone continuation, a cut character, one longer than needed, a surrogate, beyond Unicode.
    EXPECT_EQ(Printable("\x80"), "\\x80");
    EXPECT_EQ(Printable("\xe6\x9c"), "\\xe6\\x9c");
    EXPECT_EQ(Printable("\xc0\xaf"), "\\xc0\\xaf");
    EXPECT_EQ(Printable("\xe0\x80\xaf"), "\\xe0\\x80\\xaf");
    EXPECT_EQ(Printable("\xed\xa0\x80"), "\\xed\\xa0\\x80");
    EXPECT_EQ(Printable("\xf4\x90\x80\x80"), "\\xf4\\x90\\x80\\x80");
    EXPECT_EQ(Printable("\xf8\xff"), "\\xf8\\xff");
    EXPECT_EQ(Printable("\xc2\x9b"
                        "2J"),
              "\\xc2\\x9b2J");  // a control character of two bytes
    EXPECT_EQ(Printable("a\xe2\x80\xae"
                        "b"),
              "a\\xe2\\x80\\xaeb");  // turns the line around
}

TEST(Printable, CutsLongText) {
    EXPECT_EQ(Printable("abcdef", 6), "abcdef");
    EXPECT_EQ(Printable("abcdefg", 6), "abcdef...");
    EXPECT_EQ(Printable("abü", 3), "ab...");  // never within a character
    EXPECT_EQ(Printable(std::string(1000, '\x01'), 10), "\\x01\\x01...");
}

TEST(Printable, ShellLineQuotesWhereNeeded) {
    EXPECT_EQ(ShellLine({"tessera", "run", "a b", "", "it's", "$HOME", "x=1", "2. OG (neu)"}),
              "tessera run 'a b' '' 'it'\\''s' '$HOME' x=1 '2. OG (neu)'");
}

}  // namespace
}  // namespace tessera
