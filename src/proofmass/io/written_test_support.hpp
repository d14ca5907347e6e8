#pragma once

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <gtest/gtest.h>
#include <limits>
#include <random>
#include <string>
#include <vector>

#include "proofmass/core/recording.hpp"
#include "proofmass/io/recording_writer.hpp"

namespace proofmass::io {

/// Doubles of every magnitude, with every kind of fault, at uneven stamps. Expects five samples.
inline Recording troubled_recording(std::size_t samples, const std::vector<std::string>& names) {
  std::mt19937_64 random(11);
  Recording recording;
  recording.time = {TimeSource::stamps, "time", 100.0, {}, 1'705'479'286'000'000'123};
  for (const std::string& name : names)
    recording.channels.push_back({name, *parse_unit("m/s^2"), {}});
  std::uniform_real_distribution<double> jitter(0.0, 0.004);
  for (std::size_t k = 0; k < samples; ++k) {
    recording.time.stamps_s.push_back(k == 0 ? 0.0
                                             : 0.01 * static_cast<double>(k) + jitter(random));
    for (Channel& channel : recording.channels)
      channel.values.edit().push_back(std::bit_cast<double>(random()));
  }
  std::vector<double>& values = recording.channels[0].values.edit();
  values[1] = std::numeric_limits<double>::quiet_NaN();
  values[2] = -std::numeric_limits<double>::infinity();
  values[3] = 5e-324;
  values[4] = -0.0;
  return recording;
}

/// Passes a recording to a writer, in blocks of the given number of rows, and closes it.
inline Status write_in_pieces(RecordingWriter& writer,
                              const Recording& recording,
                              std::size_t rows) {
  for (std::size_t k = 0; k < recording.samples(); k += rows) {
    Block block{.first = k};
    const std::size_t count = std::min(rows, recording.samples() - k);
    for (const Channel& channel : recording.channels)
      block.channels.push_back(View<double>(channel.values).subspan(k, count));
    if (!recording.time.is_uniform())
      block.stamps_s = View<double>(recording.time.stamps_s).subspan(k, count);
    if (const Status written = writer.write(block); !written) return written;
  }
  return writer.finish(recording);
}

/// Checks that all numbers are bitwise equal, any NaN being equal to any other, with names, units
/// and times.
inline void expect_same_recording(const Recording& read, const Recording& written) {
  ASSERT_EQ(read.channels.size(), written.channels.size());
  ASSERT_EQ(read.samples(), written.samples());
  for (std::size_t c = 0; c < read.channels.size(); ++c) {
    const Channel& one = read.channels[c];
    const Channel& other = written.channels[c];
    EXPECT_EQ(one.name, other.name);
    EXPECT_EQ(one.unit, other.unit) << one.name;
    for (std::size_t k = 0; k < read.samples(); ++k) {
      const bool are_missing = std::isnan(one.values[k]) && std::isnan(other.values[k]);
      ASSERT_TRUE(are_missing || std::bit_cast<std::uint64_t>(one.values[k]) ==
                                     std::bit_cast<std::uint64_t>(other.values[k]))
          << one.name << ' ' << k << ": " << one.values[k] << " was " << other.values[k];
    }
  }
  for (std::size_t k = 0; k < read.samples(); ++k)
    ASSERT_EQ(read.time.at(k), written.time.at(k)) << k;
}

}  // namespace proofmass::io
