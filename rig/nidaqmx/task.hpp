#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "card.hpp"

namespace standin {

/// What a task handle points to.
struct Task {
  std::vector<Channel> channels{};
  const Card* card = nullptr;
  double rate_hz = 0.0;
  std::uint64_t buffer_rows = 0;
  bool is_running = false;
  std::int64_t start_ns = 0;
  std::uint64_t taken = 0;  ///< rows, by the card
  std::uint64_t read = 0;   ///< rows, by the program
  bool is_fault_over = false;
};

/// A status below 0, with its words for whoever asks on this thread.
std::int32_t failed(std::int32_t status, const std::string& words);

/// A list for a caller that may ask for the size first.
std::int32_t give_text(const std::string& list, char* text, std::uint32_t size);

}  // namespace standin
