#include "proofmass/signal/audit.hpp"

#include <algorithm>

#include "proofmass/signal/running_audit.hpp"

namespace proofmass::signal {

bool RecordingAudit::is_bad() const {
  return std::ranges::any_of(notes, [](const Note& n) { return n.severity == Severity::bad; });
}

RecordingAudit audit(const Recording& recording) {
  RunningAudit running(recording);
  Block all;
  for (const Channel& channel : recording.channels) all.channels.emplace_back(channel.values);
  all.stamps_s = recording.time.stamps_s;
  running.add(all);
  return running.finish(recording);
}

}  // namespace proofmass::signal
