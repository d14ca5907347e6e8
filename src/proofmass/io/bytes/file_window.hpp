#pragma once

#include <cstdint>
#include <memory>
#include <string_view>

#include "proofmass/core/result.hpp"
#include "proofmass/io/bytes/random_bytes.hpp"

namespace proofmass::io {

/// A movable window of a file in memory.
class FileWindow {
 public:
  explicit FileWindow(std::shared_ptr<const RandomBytes> bytes)
      : bytes_(std::move(bytes)), end_of_file_(bytes_->size()) {}

  [[nodiscard]] std::uint64_t size() const { return end_of_file_; }  ///< size of the file
  /// `count` bytes from `offset`, or as many as exist; valid until the next call.
  /// Errors: unreadable.
  [[nodiscard]] Result<std::string_view> view(std::uint64_t offset, std::uint64_t count);

 private:
  std::shared_ptr<const RandomBytes> bytes_;
  std::uint64_t end_of_file_;
  std::unique_ptr<char[]> room_;
  std::size_t room_bytes_ = 0;
  std::uint64_t first_ = 0;  ///< file offset of the beginning of room_
  std::size_t held_ = 0;
};

}  // namespace proofmass::io
