#include "proofmass/io/pyramid.hpp"

#include <cmath>
#include <cstring>
#include <fstream>
#include <gtest/gtest.h>
#include <iterator>
#include <limits>
#include <random>
#include <unistd.h>

#include "proofmass/io/pyramid/file.hpp"
#include "proofmass/io/test_support.hpp"

namespace proofmass::io::pyramid_test {
namespace {

Recording noise(std::size_t samples, std::size_t channels = 2) {
  std::mt19937_64 random(9);
  std::normal_distribution<double> normal;
  Recording out;
  out.time.source = TimeSource::given_rate;
  out.time.rate_hz = 100.0;
  for (std::size_t c = 0; c < channels; ++c) {
    out.channels.push_back({"Acc " + std::to_string(c) + " µ", *parse_unit("m/s^2"), {}});
    for (std::size_t k = 0; k < samples; ++k)
      out.channels[c].values.edit().push_back(normal(random));
  }
  return out;
}

/// Adds the samples in pieces of the given length.
Pyramid pyramid_of(const Recording& recording, std::size_t piece) {
  PyramidBuilder builder(recording);
  for (std::size_t first = 0; first < recording.samples(); first += piece) {
    const std::size_t count = std::min(piece, recording.samples() - first);
    Block block{first, {}, {}};
    for (const Channel& channel : recording.channels)
      block.channels.push_back(View<double>(channel.values).subspan(first, count));
    if (!recording.time.is_uniform())
      block.stamps_s = View<double>(recording.time.stamps_s).subspan(first, count);
    builder.add(block);
  }
  return builder.finish();
}

bool same(const std::vector<double>& a, const std::vector<double>& b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(double)) == 0;
}

void expect_same(const Pyramid& a, const Pyramid& b) {
  EXPECT_EQ(a.names, b.names);
  EXPECT_EQ(a.units, b.units);
  EXPECT_EQ(a.samples, b.samples);
  EXPECT_EQ(a.end_s, b.end_s);
  ASSERT_EQ(a.levels.size(), b.levels.size());
  for (std::size_t i = 0; i < a.levels.size(); ++i) {
    EXPECT_EQ(a.levels[i].bin_samples, b.levels[i].bin_samples);
    EXPECT_TRUE(same(a.levels[i].start_s, b.levels[i].start_s));
    ASSERT_EQ(a.levels[i].channels.size(), b.levels[i].channels.size());
    for (std::size_t c = 0; c < a.levels[i].channels.size(); ++c) {
      EXPECT_TRUE(same(a.levels[i].channels[c].min, b.levels[i].channels[c].min));
      EXPECT_TRUE(same(a.levels[i].channels[c].max, b.levels[i].channels[c].max));
      EXPECT_EQ(a.levels[i].channels[c].nonfinite, b.levels[i].channels[c].nonfinite);
    }
  }
}

TEST(Pyramid, HoldsTheExtremesOfEveryBinAtEveryLevelHoweverTheSamplesCome) {
  Recording recording = noise(40'000);
  recording.channels[0].values.edit()[300] = std::nan("");
  recording.channels[0].values.edit()[301] = std::numeric_limits<double>::infinity();
  for (std::size_t k = 1024; k < 1280; ++k) recording.channels[1].values.edit()[k] = std::nan("");
  const Pyramid pyramid = pyramid_of(recording, 40'000);
  EXPECT_EQ(pyramid.samples, 40'000u);
  EXPECT_EQ(pyramid.end_s, 399.99);
  ASSERT_EQ(pyramid.levels.size(), 4u);  // with 157, 40, 10 and 3 bins
  for (const PyramidLevel& level : pyramid.levels)
    for (std::size_t c = 0; c < 2; ++c)
      for (std::size_t i = 0; i < level.bins(); ++i) {
        const std::size_t first = i * level.bin_samples;
        const std::size_t last = std::min<std::size_t>(first + level.bin_samples, 40'000);
        double low = std::nan("");
        double high = std::nan("");
        std::uint32_t nonfinite = 0;
        for (std::size_t k = first; k < last; ++k) {
          const double x = recording.channels[c].values[k];
          if (!std::isfinite(x)) {
            ++nonfinite;
            continue;
          }
          low = std::fmin(low, x);
          high = std::fmax(high, x);
        }
        const PyramidChannel& channel = level.channels[c];
        EXPECT_TRUE(channel.min[i] == low || (std::isnan(low) && std::isnan(channel.min[i])));
        EXPECT_TRUE(channel.max[i] == high || (std::isnan(high) && std::isnan(channel.max[i])));
        EXPECT_EQ(channel.nonfinite[i], nonfinite);
        EXPECT_EQ(level.start_s[i], static_cast<double>(first) / 100.0);
      }
  for (const std::size_t piece : {1u, 255u, 256u, 1000u, 4096u})
    expect_same(pyramid_of(recording, piece), pyramid);
}

TEST(Pyramid, GivesTheLevelThatAPictureIsDrawnFrom) {
  const Pyramid pyramid = pyramid_of(noise(1'000'000, 1), 65'536);
  // 3907, 977, 245, 62, 16, 4 bins.
  EXPECT_EQ(pyramid.level_for(0.0, 9999.0, 800).bin_samples, 1024u);
  EXPECT_EQ(pyramid.level_for(0.0, 9999.0, 60).bin_samples, 16'384u);
  EXPECT_EQ(pyramid.level_for(0.0, 100.0, 800).bin_samples, 256u);
  EXPECT_EQ(pyramid.level_for(0.0, 1e9, 1).bin_samples, 262'144u);
}

/// A pyramid on disk, and its bytes.
class PyramidFile : public testing::Test {
 protected:
  void SetUp() override {
    path_ = std::filesystem::temp_directory_path() /
            ("proofmass_pyramid_" + std::to_string(::getpid()) + ".csv");
    std::ofstream(path_) << "t,a\n0,1\n";
  }
  void TearDown() override {
    std::filesystem::remove(path_);
    std::filesystem::remove(pyramid_path_of(path_));
  }

  std::string write(const Pyramid& pyramid) {
    auto file = create_file(pyramid_path_of(path_));
    const Status written =
        write_pyramid(pyramid, source_state_of(path_).value(), std::move(file).value());
    EXPECT_TRUE(written.has_value());
    std::ifstream in(pyramid_path_of(path_), std::ios::binary);
    return std::string(std::istreambuf_iterator<char>(in), {});
  }

  static Result<Pyramid> read(std::string_view bytes, const SourceState& state) {
    auto source = std::make_unique<PeekSource>(open_memory(std::as_bytes(std::span(bytes))));
    auto random = random_bytes_of(std::move(source), {});
    if (!random) return random.error();
    return read_pyramid(std::move(random).value(), state);
  }

  std::filesystem::path path_;
};

TEST_F(PyramidFile, IsReadAsItWasWritten) {
  Recording recording = noise(5000, 3);
  recording.time.source = TimeSource::stamps;
  for (int k = 0; k < 5000; ++k) recording.time.stamps_s.push_back(0.01 * k + (k > 2000 ? 3.0 : 0));
  const Pyramid pyramid = pyramid_of(recording, 700);
  write(pyramid);
  const auto read = read_pyramid(path_.string());
  ASSERT_TRUE(read.has_value()) << read.error().message;
  expect_same(*read, pyramid);
}

TEST_F(PyramidFile, OfARecordingThatHasChangedIsNotUsed) {
  write(pyramid_of(noise(5000), 700));
  std::ofstream(path_, std::ios::app) << "1,2\n";
  const auto read = read_pyramid(path_.string());
  ASSERT_FALSE(read.has_value());
  EXPECT_EQ(read.error().code, Errc::unsupported);
  EXPECT_NE(read.error().message.find("another version of the recording"), std::string::npos);
}

TEST_F(PyramidFile, ThatIsNotThereIsSaidSo) {
  EXPECT_EQ(read_pyramid(path_.string()).error().code, Errc::unreadable);
}

TEST_F(PyramidFile, BrokenOffAtAnyByteIsRefusedInOneLine) {
  const std::string bytes = write(pyramid_of(noise(600, 1), 700));
  const auto state = source_state_of(path_).value();
  ASSERT_TRUE(read(bytes, state).has_value());
  for (std::size_t size = 0; size < bytes.size(); ++size) {
    const auto part = read(std::string_view(bytes).substr(0, size), state);
    ASSERT_FALSE(part.has_value()) << size;
    ASSERT_EQ(part.error().message.find('\n'), std::string::npos);
  }
}

TEST_F(PyramidFile, WithAnyByteChangedIsReadOrRefused) {
  std::string bytes = write(pyramid_of(noise(600, 1), 700));
  const auto state = source_state_of(path_).value();
  for (std::size_t i = 0; i < bytes.size(); ++i) {
    bytes[i] = static_cast<char>(bytes[i] ^ 0x5A);
    static_cast<void>(read(bytes, state));
    bytes[i] = static_cast<char>(bytes[i] ^ 0x5A);
  }
}

}  // namespace
}  // namespace proofmass::io::pyramid_test
