#pragma once

#include <cmath>
#include <cstddef>
#include <cstdlib>
#include <span>

#include "proofmass/io/read_recording.hpp"
#include "proofmass/signal/audit.hpp"

/// Reads and audits arbitrary bytes, and checks the guarantees common to all readers.
inline void check_reading(std::span<const std::byte> bytes) {
  const auto require = [](bool kept) {
    if (!kept) std::abort();
  };
  const auto read = proofmass::io::read_recording(bytes, "fuzz", {});
  if (!read) {
    require(!read.error().message.empty());
    return;
  }
  require(!read->channels.empty());
  for (const auto& channel : read->channels) {
    require(channel.values.size() == read->samples());
    require(!channel.name.empty());
  }
  const proofmass::TimeBase& time = read->time;
  require(time.is_uniform() || time.stamps_s.size() == read->samples());
  require(std::isfinite(time.rate_hz) && time.rate_hz >= 0.0);
  for (const double stamp_s : time.stamps_s) require(std::isfinite(stamp_s));
  std::size_t unlabelled = 0;  // first sample at which a label may begin
  for (const proofmass::Label& label : read->labels) {
    require(label.first >= unlabelled && label.last >= label.first);
    require(label.last < read->samples() && !label.text.empty());
    unlabelled = label.last + 1;
  }
  require(read->labels.empty() == read->label_channel.empty());
  const auto audit = proofmass::signal::audit(*read);
  require(audit.channels.size() == read->channels.size());
}
