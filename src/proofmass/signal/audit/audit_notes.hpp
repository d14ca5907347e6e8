#pragma once

#include <vector>

#include "proofmass/core/recording.hpp"
#include "proofmass/signal/audit.hpp"
#include "proofmass/signal/audit/running_channel.hpp"
#include "proofmass/signal/resample/sample_times.hpp"

// Findings of an audit as sentences.
namespace proofmass::signal {

/// How positions are named: by line if first_line is above 0, else by sample; also by time if it is
/// known.
struct PlaceWords {
  std::size_t first_line = 0;
  bool is_timed = false;
};

void note_timing(const TimingAudit& timing, std::vector<Note>& notes);

/// Notes odd values with their positions.
void note_values(const std::string& name,
                 const RunningChannel& channel,
                 const PlaceWords& words,
                 std::vector<Note>& notes);

/// Notes excluded values, clipping, and a stuck channel. rate_hz: 0 if unknown.
void note_channel(const ChannelAudit& channel, double rate_hz, std::vector<Note>& notes);

void note_zero_rows(const OddValues& rows, const PlaceWords& words, std::vector<Note>& notes);

}  // namespace proofmass::signal
