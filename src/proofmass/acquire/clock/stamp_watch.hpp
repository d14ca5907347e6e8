#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "proofmass/core/recording.hpp"

namespace proofmass::acquire {

/// True if a device's stamps contain no time: all 0, or several and all equal. Drivers that leave
/// stamping to their own trigger do so under another trigger.
[[nodiscard]] bool is_dead(const std::vector<std::int64_t>& stamps_ns);

/// Monitors a device's stamps and reports faults: at the first time, then the tenth, the hundredth,
/// so that a bad clock does not flood the recording.
class StampWatch {
 public:
  void look(const std::vector<std::int64_t>& stamps_ns, std::vector<Note>& notes);

 private:
  struct Count {
    std::size_t seen = 0, reported = 0;
    [[nodiscard]] bool is_due() const { return seen > 0 && seen >= 10 * reported; }
  };
  std::optional<std::int64_t> last_ns_;
  Count repeated_, backwards_;
};

}  // namespace proofmass::acquire
