#include "proofmass/core/utf8.hpp"

#include <gtest/gtest.h>
#include <string>
#include <string_view>

namespace proofmass::utf8_test {
namespace {

TEST(Utf8, EveryCharacterIsReadAsItWasWritten) {
  for (std::uint32_t character = 1; character < 0x110000; ++character) {
    if (character == 0xD800) character = 0xE000;
    std::string text;
    append_utf8(text, character);
    std::size_t length = 0;
    ASSERT_EQ(next_character(text, length), character);
    ASSERT_EQ(length, text.size());
    ASSERT_EQ(character_bytes(text), text.size()) << character;
    if (length > 1) {
      ASSERT_EQ(character_bytes(std::string_view(text).substr(0, length - 1)), 0U) << character;
    }
  }
}

TEST(Utf8, IllFormedTextIsNone) {
  EXPECT_TRUE(is_utf8("1 g = 9,80665 m/s², Ångström, ∞, 😀"));
  for (const char* text :
       {"\x80", "\xC3", "a\xFF", "\xC0\x80", "\xC1\xBF", "\xE0\x9F\xBF", "\xF0\x8F\xBF\xBF",
        "\xED\xA0\x80", "\xF4\x90\x80\x80", "\xF5\x80\x80\x80", "\xE2\x28\xA1"})
    EXPECT_FALSE(is_utf8(text)) << text;
}

}  // namespace
}  // namespace proofmass::utf8_test
