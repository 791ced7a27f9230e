// Whatever a file holds, a sentence about it is UTF-8.
#include "base/readable.h"

#include <gtest/gtest.h>

#include <string>

#include "base/error.h"

namespace mesograin::base {
namespace {

using namespace std::string_literals;

TEST(Readable, TextStaysAsItIs) {
  for (const std::string text : {"", "grain.obj", "one\ttwo\nthree", "Körnchen", "砂", "\xF0\x9F\x8F\x96", "\\x41"})
    EXPECT_EQ(readable(text), text);
}

TEST(Readable, WhatIsNoTextIsWrittenInHexadecimal) {
  EXPECT_EQ(readable("a\xFF"
                     "b"),
            "a\\xffb");
  EXPECT_EQ(readable("a\0b"s), "a\\x00b");
  EXPECT_EQ(readable("\x1B[31m\x7F\r"), "\\x1b[31m\\x7f\\x0d");
  EXPECT_EQ(readable("\xE7\xA0"), "\\xe7\\xa0") << "a character cut short";
  EXPECT_EQ(readable("\xE7\xA0z"), "\\xe7\\xa0z");
  EXPECT_EQ(readable("\xC0\xAF"), "\\xc0\\xaf") << "overlong";
  EXPECT_EQ(readable("\xE0\x80\xAF"), "\\xe0\\x80\\xaf") << "overlong";
  EXPECT_EQ(readable("\xED\xA0\x80"), "\\xed\\xa0\\x80") << "a surrogate";
  EXPECT_EQ(readable("\xF4\x90\x80\x80"), "\\xf4\\x90\\x80\\x80") << "beyond Unicode";
}

TEST(Readable, NoCharacterIsCutInTwo) {
  EXPECT_EQ(shortened("grain", 5), "grain");
  EXPECT_EQ(shortened("grains", 5), "grain...");
  EXPECT_EQ(shortened("grün", 3), "gr...");
  EXPECT_EQ(shortened("grüne", 4), "grü...");
}

TEST(Readable, EveryErrorIs) {
  EXPECT_STREQ(Error("got '{}'.", "\xFF\0"s).what(), "got '\\xff\\x00'.");
  EXPECT_STREQ(Error("got \xFF.").what(), "got \\xff.");
}

}  // namespace
}  // namespace mesograin::base
