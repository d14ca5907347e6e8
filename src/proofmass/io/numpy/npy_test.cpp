#include <algorithm>
#include <bit>
#include <cmath>
#include <gtest/gtest.h>

#include "proofmass/io/numpy/npy_header.hpp"
#include "proofmass/io/numpy/npy_reader.hpp"
#include "proofmass/io/test_support.hpp"

namespace proofmass::io::npy_test {
namespace {

std::string npy(std::string dictionary, const std::string& figures, char major = 1) {
  dictionary += '\n';
  std::string out = std::string("\x93NUMPY") + major + '\0';
  const std::size_t size = dictionary.size();
  out += static_cast<char>(size & 0xFF);
  out += static_cast<char>(size >> 8);
  if (major > 1) out += std::string(2, '\0');
  return out + dictionary + figures;
}

template <class T>
std::string bytes_of(std::initializer_list<T> values, bool big_endian = false) {
  std::string out;
  for (const T value : values) {
    auto bytes = std::bit_cast<std::array<char, sizeof(T)>>(value);
    if (big_endian) std::ranges::reverse(bytes);
    out.append(bytes.data(), bytes.size());
  }
  return out;
}

std::string plain(const std::string& descr, const std::string& shape, bool fortran = false) {
  return "{'descr': '" + descr + "', 'fortran_order': " + (fortran ? "True" : "False") +
         ", 'shape': " + shape + ", }";
}

using Values = std::vector<double>;

void expect_values(const std::string& file, const Values& values) {
  const auto read = read_text(file);
  ASSERT_TRUE(read.has_value()) << read.error().message;
  EXPECT_EQ(read->channels.at(0).values, values);
}

TEST(Npy, ReadsEveryTypeOfFigure) {
  const Values values{-2.0, 0.0, 96.0};
  expect_values(npy(plain("<f8", "(3,)"), bytes_of<double>({-2, 0, 96})), values);
  expect_values(npy(plain("<f4", "(3,)"), bytes_of<float>({-2, 0, 96})), values);
  expect_values(npy(plain("<i8", "(3,)"), bytes_of<std::int64_t>({-2, 0, 96})), values);
  expect_values(npy(plain("<i4", "(3,)"), bytes_of<std::int32_t>({-2, 0, 96})), values);
  expect_values(npy(plain("<i2", "(3,)"), bytes_of<std::int16_t>({-2, 0, 96})), values);
  expect_values(npy(plain("|i1", "(3,)"), bytes_of<std::int8_t>({-2, 0, 96})), values);
  // -2, 0 and 96 as IEEE binary16.
  expect_values(npy(plain("<f2", "(3,)"), bytes_of<std::uint16_t>({0xC000, 0, 0x5600})), values);
  expect_values(npy(plain("<u2", "(2,)"), bytes_of<std::uint16_t>({65535, 7})), {65535, 7});
  expect_values(npy(plain("|b1", "(2,)"), bytes_of<std::uint8_t>({1, 0})), {1, 0});
}

TEST(Npy, ReadsBigEndian) {
  expect_values(npy(plain(">f8", "(2,)"), bytes_of<double>({1.25, -3}, true)), {1.25, -3});
  expect_values(npy(plain(">u4", "(2,)"), bytes_of<std::uint32_t>({5, 70000}, true)), {5, 70000});
}

TEST(Npy, ReadsLaterVersions) {
  expect_values(npy(plain("<f8", "(2,)"), bytes_of<double>({1, 2}), 2), {1, 2});
  expect_values(npy(plain("<f8", "(2,)"), bytes_of<double>({1, 2}), 3), {1, 2});
}

TEST(Npy, ReadsRowsAndColumnsInEitherOrder) {
  const auto rows = read_text(npy(plain("<f8", "(3, 2)"), bytes_of<double>({1, 9, 1, 8, 1, 7})));
  const auto columns =
      read_text(npy(plain("<f8", "(3, 2)", true), bytes_of<double>({1, 1, 1, 9, 8, 7})));
  ASSERT_TRUE(rows.has_value() && columns.has_value());
  for (const auto* read : {&rows, &columns}) {
    EXPECT_EQ((*read)->channels.at(0).values, (Values{1, 1, 1}));
    EXPECT_EQ((*read)->channels.at(1).values, (Values{9, 8, 7}));
  }
}

TEST(Npy, TurnsChannelsTimesSamples) {
  std::string figures;
  for (int c = 0; c < 2; ++c)
    for (int k = 0; k < 30; ++k) figures += bytes_of<double>({c == 0 ? 5.0 : double(k % 3)});
  const auto read = read_text(npy(plain("<f8", "(2, 30)"), figures));
  ASSERT_TRUE(read.has_value());
  ASSERT_EQ(read->channels.size(), 2u);
  EXPECT_EQ(read->samples(), 30u);
  EXPECT_EQ(read->channels[1].values[4], 1.0);
  EXPECT_TRUE(is_noted(*read, "turned"));
}

TEST(Npy, TakesAnAscendingFirstColumnForTheTime) {
  const auto read = read_text(
      npy(plain("<f8", "(3, 4)"), bytes_of<double>({0, 0, 0, 1, .01, 0, 0, 1, .02, 0, 0, 1})));
  ASSERT_TRUE(read.has_value());
  EXPECT_EQ(read->time.rate_hz, 100.0);
  EXPECT_EQ(read->channels.size(), 3u);
  EXPECT_EQ(accelerometer_triads(*read).size(), 1u);
}

TEST(Npy, ReadsStructuredArrays) {
  const std::string dictionary =
      "{'descr': [('t_us', '<u4'), ('tag', '|S2'), ('acc', '<f4', (3,)), ('temp_degC', '>i2')], "
      "'fortran_order': False, 'shape': (3,)}";
  std::string figures;
  for (std::uint32_t k = 0; k < 3; ++k)
    figures += bytes_of<std::uint32_t>({1000 + 5000 * k}) + "ab" +
               bytes_of<float>({1.F, 2.F, static_cast<float>(k)}) +
               bytes_of<std::int16_t>({21}, true);
  const auto read = read_text(npy(dictionary, figures));
  ASSERT_TRUE(read.has_value()) << read.error().message;
  EXPECT_EQ(read->time.channel, "t");
  EXPECT_EQ(read->time.rate_hz, 200.0);
  ASSERT_EQ(read->channels.size(), 4u);
  EXPECT_EQ(read->channels[2].values, (Values{0, 1, 2}));
  EXPECT_EQ(read->channels[3].name, "temp");
  EXPECT_EQ(read->channels[3].unit.quantity, Quantity::temperature);
  EXPECT_EQ(read->channels[3].values, (Values{21, 21, 21}));
}

TEST(Npy, KeepsTheRowsOfAFileThatBrokeOff) {
  const auto read = read_text(npy(plain("<f8", "(9, 2)"), bytes_of<double>({1, 9, 1, 8, 1})));
  ASSERT_TRUE(read.has_value());
  EXPECT_EQ(read->samples(), 2u);
  ASSERT_TRUE(is_noted(*read, "breaks off after 2 of 9 samples"));
  EXPECT_TRUE(std::ranges::any_of(read->notes,
                                  [](const Note& note) { return note.severity == Severity::bad; }));
}

TEST(Npy, BelievesNoHeaderBeyondTheFile) {
  for (const char* shape : {"(1000000000000, 3)", "(18446744073709551615,)",
                            "(4611686018427387904, 4)", "(3, 1000000)"}) {
    const auto read = read_text(npy(plain("<f8", shape), bytes_of<double>({1, 2, 3})));
    ASSERT_TRUE(!read.has_value() || read->samples() <= 3) << shape;
  }
  EXPECT_EQ(read_text(npy(plain("<f8", "(99, 2)", true), bytes_of<double>({1, 2, 3}))).error().code,
            Errc::corrupt);
}

TEST(Npy, RefusesWhatItDoesNotRead) {
  const auto code = [](const std::string& file) { return read_text(file).error().code; };
  EXPECT_EQ(code(npy(plain("|O", "(3,)"), "xxx")), Errc::unsupported);
  EXPECT_EQ(code(npy(plain("<c16", "(3,)"), "xxx")), Errc::unsupported);
  EXPECT_EQ(code(npy(plain("<f16", "(3,)"), "xxx")), Errc::unsupported);
  EXPECT_EQ(code(npy(plain("<f8", "(1, 2, 3)"), "xxx")), Errc::unsupported);
  EXPECT_EQ(code(npy(plain("<f8", "(0,)"), "")), Errc::too_few_samples);
  EXPECT_EQ(code(npy("{'descr': '<f8'}", "xxx")), Errc::corrupt);
  EXPECT_EQ(code(npy("nonsense", "xxx")), Errc::corrupt);
  EXPECT_EQ(code("\x93NUMPY\x07"), Errc::corrupt);
}

}  // namespace
}  // namespace proofmass::io::npy_test
