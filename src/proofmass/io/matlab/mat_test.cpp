#include <cmath>
#include <cstdlib>
#include <gtest/gtest.h>

#include "proofmass/io/matlab/mat_specimens.hpp"
#include "proofmass/io/test_support.hpp"

namespace proofmass::io::matlab::mat_test {
namespace {

using namespace specimen;
using Values = std::vector<double>;

const Values ramp{1.5, -2.0, 3.25, 4.0, 5.0, -6.0};

void expect_values(const std::string& file, const Values& values) {
  const auto read = read_text(file);
  ASSERT_TRUE(read.has_value()) << read.error().message;
  ASSERT_EQ(read->channels.size(), 1u);
  EXPECT_EQ(read->channels[0].values, values);
}

std::string from_hex(std::string_view hex) {
  std::string bytes;
  for (std::size_t i = 0; i + 1 < hex.size(); i += 2)
    bytes += static_cast<char>(std::strtol(std::string(hex.substr(i, 2)).c_str(), nullptr, 16));
  return bytes;
}

template <class T>
void expect_stored(std::uint32_t type, std::uint32_t array_class, const std::vector<T>& values) {
  const auto rows = static_cast<std::int32_t>(values.size());
  for (const Order order : {Order::little, Order::big})
    expect_values(mat5_header(order) + matrix({array_class, {rows, 1}, "v", 0, order},
                                              element(type, bytes_of(values, order), order)),
                  Values(values.begin(), values.end()));
}

TEST(Mat5, ReadsEveryTypeInBothOrdersOfBytes) {
  expect_stored<std::int8_t>(1, 8, {-2, 0, 96});
  expect_stored<std::uint8_t>(2, 9, {2, 0, 255});
  expect_stored<std::int16_t>(3, 10, {-300, 0, 9600});
  expect_stored<std::uint16_t>(4, 11, {65535, 0, 9600});
  expect_stored<std::int32_t>(5, 12, {-70000, 0, 96});
  expect_stored<std::uint32_t>(6, 13, {4000000000, 0, 96});
  expect_stored<float>(7, 7, {-2.5F, 0, 96});
  expect_stored<double>(9, 6, {-0.1, 0, 96});
  expect_stored<std::int64_t>(12, 14, {-2, 0, 1LL << 40});
  expect_stored<std::uint64_t>(13, 15, {2, 0, 1ULL << 40});
}

// MATLAB stores integer-valued doubles in the smallest type that holds them.
TEST(Mat5, ReadsDoublesThatAreStoredInFewerBytes) {
  expect_stored<std::uint8_t>(2, 6, {1, 2, 3, 4, 5});
  expect_stored<std::int16_t>(3, 6, {1, -2, 300});
  expect_stored<std::uint8_t>(2, 6, {1, 2, 3});  // in the tag itself
}

TEST(Mat5, ReadsACompressedFileOfAnotherWriter) {
  // From scipy 1.10.1: savemat(…, {"imu": {"t": …, "acc": …, "fs": 100.0}}, do_compression=True).
  const auto read = read_text(
      mat5_header() +
      from_hex("0f0000009e000000789ce363606098c1c8c0c006a439809889010258a17c46386666c8cc2d058ab3"
               "0021448c07884b803831399921ad18a28f0f88231810e6b1a199c78a6426087002b1060302548bac"
               "737f58d5620fa1a7d8ef906b7d1db8631e94bfc41e64fe0a02e633a3995fc1800e1ed843e80f50fa"
               "079466704055f7613f947100427140698103f26067293b10a241eeb5c0e35e4606ccf0e080db1fe9"
               "000045da30e3"));
  ASSERT_TRUE(read.has_value()) << read.error().message;
  EXPECT_EQ(read->format, "MAT v5");
  EXPECT_EQ(read->time.channel, "t");
  EXPECT_EQ(read->time.rate_hz, 100.0);
  ASSERT_EQ(read->channels.size(), 3u);
  EXPECT_EQ(read->channels[0].values, (Values{0, .5, 1, 1.5, 2}));
  EXPECT_EQ(read->channels[1].values, (Values{0, -1, -2, -3, -4}));
  EXPECT_EQ(read->channels[2].values, Values(5, 9.81));
  EXPECT_EQ(read->channels[2].unit.symbol, "m/s^2");
}

TEST(Mat5, ReadsCompressedVariablesAsIfTheyWereNot) {
  Values many;
  for (int k = 0; k < 30'000; ++k) many.push_back(std::sin(k));
  for (const Order order : {Order::little, Order::big}) {
    const std::string variable = doubles("many", 30'000, many, order);
    expect_values(mat5_header(order) + variable, many);
    expect_values(mat5_header(order) + packed(variable, order), many);
  }
}

TEST(Mat5, ReadsInsideGzip) {
  expect_values(deflated(mat5_header() + doubles("v", 6, ramp), 16 + 15), ramp);
}

TEST(Mat5, ReadsTheRealPartOfComplexNumbersAndSaysSo) {
  const std::string content = element(9, bytes_of(ramp), Order::little) +
                              element(9, bytes_of(Values(6, 1.0)), Order::little);
  const auto read = read_text(mat5_header() + matrix({6, {6, 1}, "z", 0x800}, content));
  ASSERT_TRUE(read.has_value()) << read.error().message;
  EXPECT_EQ(read->channels[0].values, ramp);
  EXPECT_TRUE(is_noted(*read, "z is complex: its real part is read")) << notes_of(*read);
}

TEST(Mat5, FindsNumbersInStructsAndCells) {
  const std::string cell = matrix({1, {1, 2}, ""}, doubles("", 1, {7}) + doubles("", 6, ramp));
  const std::string inner = structure("", {{"parts", cell}, {"gain", doubles("", 1, {2})}});
  const auto read = read_text(mat5_header() + structure("run", {{"inner", inner}}));
  ASSERT_TRUE(read.has_value()) << read.error().message;
  EXPECT_EQ(read->channels[0].values, ramp);
  EXPECT_TRUE(is_noted(*read, "run.inner.parts{2} (6 x 1 double) read")) << notes_of(*read);
  EXPECT_TRUE(is_noted(*read, "run.inner.gain (1 x 1 double)")) << notes_of(*read);
}

TEST(Mat5, PassesOverWhatIsNotNumbersAndSaysSo) {
  const std::string text = matrix({4, {1, 3}, "title"}, element(4, "a\0b\0c\0", Order::little));
  const std::string sparse = matrix({5, {9, 9}, "S"}, "");
  const std::string handle = matrix({16, {1, 1}, "f"}, "");
  const std::string opaque = element(6, bytes_of<std::uint32_t>({17, 0}), Order::little) +
                             element(1, "table", Order::little) + element(1, "MCOS", Order::little);
  const std::string object =
      bytes_of<std::uint32_t>({14, static_cast<std::uint32_t>(opaque.size())}) + opaque;
  const std::string own = matrix({9, {1, 8}, ""}, element(2, "workspac", Order::little));
  const auto read = read_text(mat5_header() + text + sparse + handle + object + own +
                              doubles("v", 6, ramp) + std::string(16, '\0'));
  ASSERT_TRUE(read.has_value()) << read.error().message;
  EXPECT_EQ(read->channels[0].values, ramp);
  EXPECT_TRUE(is_noted(*read,
                       "also in the file: title (text), S (sparse), f (function handle), table "
                       "(object)"))
      << notes_of(*read);
  EXPECT_TRUE(recommends(*read, "variable"));
}

TEST(Mat5, NamesTheByteWhereAFileBreaksOff) {
  const std::string whole = mat5_header() + doubles("v", 6, ramp);
  for (const std::string& file : {whole, mat5_header() + packed(doubles("v", 6, ramp))}) {
    for (std::size_t size = 20; size < file.size(); ++size) {
      const auto read = read_text(file.substr(0, size));
      ASSERT_FALSE(read.has_value()) << size;
      const bool is_bare = size == 128;
      EXPECT_EQ(read.error().code, is_bare ? Errc::too_few_samples : Errc::corrupt) << size;
      EXPECT_TRUE(read.error().message.starts_with(is_bare ? "text: holds no variable"
                                                           : "text: byte " + std::to_string(size)))
          << read.error().message;
    }
  }
}

TEST(Mat5, BelievesNoLengthBeyondItsElement) {
  const auto code = [](const std::string& content, std::vector<std::int32_t> shape) {
    const auto read = read_text(mat5_header() + matrix({6, std::move(shape), "v"}, content));
    return read ? std::optional<Errc>() : read.error().code;
  };
  const std::string three = element(9, bytes_of<double>({1, 2, 3}), Order::little);
  EXPECT_EQ(code(three, {3, 1}), std::nullopt);
  EXPECT_EQ(code(three, {4, 1}), Errc::corrupt);
  EXPECT_EQ(code(three, {2147483647, 2147483647}), Errc::corrupt);
  EXPECT_EQ(code(three, {2147483647, 2147483647, 2147483647}), Errc::corrupt);
  EXPECT_EQ(code(three, {-3, -1}), Errc::corrupt);
  EXPECT_EQ(code(three, {3}), Errc::corrupt);
  EXPECT_EQ(code(bytes_of<std::uint32_t>({9, 0xFFFFFFF8}), {3, 1}), Errc::corrupt);
  EXPECT_EQ(code("", {3, 1}), Errc::corrupt);
  const std::string cells = matrix({1, {2147483647, 1}, "c"}, doubles("", 1, {7}));
  EXPECT_EQ(read_text(mat5_header() + cells).error().code, Errc::corrupt);
}

TEST(Mat5, BelievesNoLengthThatIsCompressed) {
  // Claims to decompress to 4 GB, and has ten bytes.
  const std::string claim = bytes_of<std::uint32_t>({14, 0xFFFFFFF0});
  const auto read = read_text(mat5_header() + packed(claim));
  ASSERT_FALSE(read.has_value());
  EXPECT_NE(read.error().message.find("byte 136, unpacked byte 0: an element claims 4294967280"),
            std::string::npos)
      << read.error().message;
}

TEST(Mat5, NoticesCompressedDataThatAreDamaged) {
  const std::string file = mat5_header() + packed(doubles("v", 6, ramp));
  std::string damaged = file;
  damaged.back() = static_cast<char>(damaged.back() ^ 1);  // in the checksum
  const auto read = read_text(damaged);
  ASSERT_FALSE(read.has_value());
  EXPECT_NE(read.error().message.find("byte 136, unpacked byte"), std::string::npos);
}

TEST(Mat5, GoesOnlySoDeep) {
  std::string nest = doubles("", 6, ramp);
  for (int k = 0; k < 200; ++k) nest = matrix({1, {1, 1}, "c"}, nest);
  const auto read = read_text(mat5_header() + nest + doubles("v", 6, ramp));
  ASSERT_TRUE(read.has_value()) << read.error().message;
  EXPECT_TRUE(is_noted(*read, "(nested too deeply)")) << notes_of(*read);
}

TEST(Mat5, ListsOnlySoManyArrays) {
  std::string members;
  for (int k = 0; k < 5000; ++k) members += doubles("", 1, {7});
  const auto read =
      read_text(mat5_header() + doubles("v", 6, ramp) + matrix({1, {5000, 1}, "c"}, members));
  ASSERT_TRUE(read.has_value()) << read.error().message;
  EXPECT_TRUE(is_noted(*read, "only the first 4096 were looked at")) << notes_of(*read);
}

TEST(Mat5, WhateverBitIsWrongItIsReadOrRefusedInOneLine) {
  const std::string cell = matrix({1, {1, 2}, ""}, doubles("", 1, {7}) + doubles("", 3, ramp));
  const std::string variable =
      structure("s", {{"t", doubles("", 3, {0, 1, 2})}, {"c", cell}, {"m", doubles("", 3, ramp)}});
  for (const std::string& body : {variable, packed(variable)}) {
    const std::string file = mat5_header() + body;
    for (std::size_t bit = 8 * 116; bit < 8 * file.size(); ++bit) {
      std::string flipped = file;
      flipped[bit / 8] = static_cast<char>(flipped[bit / 8] ^ (1 << bit % 8));
      const auto read = read_text(flipped);
      if (!read) {
        ASSERT_EQ(read.error().message.find('\n'), std::string::npos);
        continue;
      }
      for (const Channel& channel : read->channels)
        ASSERT_EQ(channel.values.size(), read->samples()) << bit;
    }
  }
}

TEST(Mat4, ReadsEveryTypeInBothOrdersOfBytes) {
  for (const Order order : {Order::little, Order::big}) {
    const auto expect = [&](std::int32_t kind, const std::string& figures, const Values& values) {
      expect_values(mat4("v", {3, 1}, kind, figures, order), values);
    };
    expect(0, bytes_of<double>({-0.1, 0, 96}, order), {-0.1, 0, 96});
    expect(10, bytes_of<float>({-2.5F, 0, 96}, order), {-2.5, 0, 96});
    expect(20, bytes_of<std::int32_t>({-70000, 0, 96}, order), {-70000, 0, 96});
    expect(30, bytes_of<std::int16_t>({-300, 0, 96}, order), {-300, 0, 96});
    expect(40, bytes_of<std::uint16_t>({65535, 0, 96}, order), {65535, 0, 96});
    expect(50, bytes_of<std::uint8_t>({255, 0, 96}, order), {255, 0, 96});
  }
}

TEST(Mat4, ReadsAFileOfAnotherWriter) {
  // From scipy 1.10.1: savemat(…, {"a": int16 [[1, 2, 3, 4], [-5, 6, 7, 8]]}, format="4").
  const auto read = read_text(
      from_hex("1e0000000200000004000000000000000200000061000100fbff0200060003000700040008"
               "00"));
  ASSERT_TRUE(read.has_value()) << read.error().message;
  EXPECT_EQ(read->format, "MAT v4");
  ASSERT_EQ(read->channels.size(), 2u);
  EXPECT_EQ(read->channels[0].values, (Values{1, 2, 3, 4}));
  EXPECT_EQ(read->channels[1].values, (Values{-5, 6, 7, 8}));
  EXPECT_TRUE(is_noted(*read, "a is channels x samples: turned")) << notes_of(*read);
}

TEST(Mat4, PassesOverTextAndSparseMatrices) {
  const auto read =
      read_text(mat4("s", {1, 4}, 51, "text") + mat4("p", {1, 3}, 2, bytes_of<double>({3, 3, 0})) +
                mat4("v", {6, 1}, 0, bytes_of(ramp)));
  ASSERT_TRUE(read.has_value()) << read.error().message;
  EXPECT_EQ(read->channels[0].values, ramp);
  EXPECT_TRUE(is_noted(*read, "s (text), p (sparse)")) << notes_of(*read);
}

TEST(Mat4, BelievesNoHeaderBeyondTheFile) {
  const std::string file = mat4("v", {6, 1}, 0, bytes_of(ramp));
  for (std::size_t size = 22; size < file.size(); ++size) {
    const auto read = read_text(file.substr(0, size));
    ASSERT_FALSE(read.has_value());
    EXPECT_TRUE(read.error().message.starts_with("text: byte 0: v claims 6 x 1 double"))
        << read.error().message;
  }
  EXPECT_EQ(read_text(mat4("v", {-1, -1}, 0, bytes_of(ramp))).error().code, Errc::corrupt);
}

TEST(Mat4, IsNotTakenForTextOrTheOtherWayRound) {
  const auto read = read_text("   2.98e-02   3.31e+04\n   3.98e-02   3.32e+04\n");
  ASSERT_TRUE(read.has_value()) << read.error().message;
  EXPECT_EQ(read->format, "CSV");
}

}  // namespace
}  // namespace proofmass::io::matlab::mat_test
