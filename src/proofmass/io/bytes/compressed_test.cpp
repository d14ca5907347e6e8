#include <array>
#include <cmath>
#include <gtest/gtest.h>
#include <lzma.h>
#include <zlib.h>
#include <zstd.h>

#include "proofmass/io/bytes/deflate_test_support.hpp"
#include "proofmass/io/test_support.hpp"

namespace proofmass::io::compressed_test {
namespace {

std::string gzip(const std::string& text) {
  return specimen::deflated(text, 16 + MAX_WBITS);
}

std::string xz(const std::string& text) {
  std::string out(lzma_stream_buffer_bound(text.size()), '\0');
  std::size_t used = 0;
  EXPECT_EQ(lzma_easy_buffer_encode(0, LZMA_CHECK_CRC64, nullptr,
                                    reinterpret_cast<const std::uint8_t*>(text.data()), text.size(),
                                    reinterpret_cast<std::uint8_t*>(out.data()), &used, out.size()),
            LZMA_OK);
  out.resize(used);
  return out;
}

/// With the checksum added by the program zstd.
std::string zstd(const std::string& text) {
  ZSTD_CCtx* context = ZSTD_createCCtx();
  ZSTD_CCtx_setParameter(context, ZSTD_c_checksumFlag, 1);
  std::string out(ZSTD_compressBound(text.size()), '\0');
  const std::size_t used =
      ZSTD_compress2(context, out.data(), out.size(), text.data(), text.size());
  EXPECT_EQ(ZSTD_isError(used), 0u);
  ZSTD_freeCCtx(context);
  out.resize(used);
  return out;
}

using Pack = std::string (*)(const std::string&);
constexpr std::array<Pack, 3> packs{gzip, xz, zstd};

std::string rows(int first, int count) {
  std::string text;
  for (int k = first; k < first + count; ++k)
    text += std::to_string(k * 0.01) + "," + std::to_string(std::sin(k)) + "\n";
  return text;
}

TEST(Compressed, ReadsAsIfItWereNot) {
  const std::string text = "t (s),a\n" + rows(0, 20'000);
  const auto plain = read_text(text);
  ASSERT_TRUE(plain.has_value());
  for (const Pack pack : packs) {
    const auto packed = read_text(pack(text));
    ASSERT_TRUE(packed.has_value()) << packed.error().message;
    EXPECT_EQ(packed->channels[0].values, plain->channels[0].values);
  }
}

TEST(Compressed, ReadsSeveralMembersAsOne) {
  for (const Pack pack : packs) {
    const auto read =
        read_text(pack("t (s),a\n" + rows(0, 5'000)) + pack(rows(5'000, 5'000)) + pack(""));
    ASSERT_TRUE(read.has_value());
    EXPECT_EQ(read->samples(), 10'000u);
    EXPECT_FALSE(is_noted(*read, "kept"));
  }
}

TEST(Compressed, KeepsWhatWasReadBeforeTheDataBreakOff) {
  const std::string text = "t (s),a\n" + rows(0, 20'000);
  const auto plain = read_text(text);
  for (const Pack pack : packs) {
    const std::string whole = pack(text);
    const auto read = read_text(whole.substr(0, whole.size() / 2));
    ASSERT_TRUE(read.has_value()) << read.error().message;
    EXPECT_GT(read->samples(), 1'000u);
    EXPECT_LT(read->samples(), 20'000u);
    ASSERT_TRUE(is_noted(*read, "break off after byte")) << notes_of(*read);
    bool bad = false;
    for (const Note& note : read->notes) bad = bad || note.severity == Severity::bad;
    EXPECT_TRUE(bad);
    for (std::size_t k = 0; k + 1 < read->samples(); ++k)
      ASSERT_EQ(read->channels[0].values[k], plain->channels[0].values[k]);
  }
}

TEST(Compressed, NoticesDamage) {
  for (const Pack pack : packs) {
    std::string damaged = pack("t (s),a\n" + rows(0, 20'000));
    damaged[damaged.size() / 2] = static_cast<char>(damaged[damaged.size() / 2] ^ 0x55);
    const auto read = read_text(damaged);
    if (read) {
      EXPECT_TRUE(is_noted(*read, "damaged") || is_noted(*read, "break off")) << notes_of(*read);
    } else {
      EXPECT_EQ(read.error().code, Errc::corrupt);
    }
  }
}

TEST(Compressed, FailsWhereNothingCanBeRead) {
  for (const Pack pack : packs) {
    const auto read = read_text(pack("t (s),a\n" + rows(0, 2'000)).substr(0, 14));
    ASSERT_FALSE(read.has_value());
    EXPECT_EQ(read.error().code, Errc::corrupt);
  }
}

}  // namespace
}  // namespace proofmass::io::compressed_test
