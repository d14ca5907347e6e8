#pragma once

#include <cstdint>
#include <vector>

#include "proofmass/core/recording_log.hpp"
#include "proofmass/io/mcap/records.hpp"

namespace proofmass::io::mcap {

/// The rows present in the topic "recording" of one of our own files, by the numbers and stamps of
/// its blocks.
class RowsAccount {
 public:
  void add(const ChannelRecord& channel, const Message& message);
  void report(Recovery& out) const;

 private:
  void note_missing(std::uint64_t first, double first_s);

  bool has_rows_ = false;
  bool has_stamps_ = false;
  std::uint64_t expected_ = 0;  ///< number of the next row
  std::uint64_t samples_ = 0, missing_ = 0;
  double first_s_ = 0.0, last_s_ = 0.0;
  std::vector<Note> notes_;
};

}  // namespace proofmass::io::mcap
