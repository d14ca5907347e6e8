#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>

#include "proofmass/core/recording.hpp"
#include "proofmass/io/mcap/records.hpp"

namespace proofmass::io::mcap {

/// Summary of the topic "events" of a recording, in one note.
class Events {
 public:
  /// Messages that are not events are skipped.
  void add(const Message& message);
  [[nodiscard]] std::optional<Note> note() const;

 private:
  struct Kind {
    std::uint64_t events = 0;
    double rows = 0.0;
  };
  std::map<std::string, Kind> kinds_;
  std::string first_;
};

}  // namespace proofmass::io::mcap
