#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

namespace proofmass::serve {

/// Writes lines to a pipe without ever waiting for its reader. Lines that the pipe does not take
/// are kept up to `most_bytes`; beyond that whole lines are left out.
class LinePipe {
 public:
  /// The descriptor stays its owner's.
  explicit LinePipe(int descriptor, std::size_t most_bytes = std::size_t{4} << 20);

  void write(std::string_view line);
  /// Writes what the pipe takes now.
  void flush();
  /// Writes what is kept, waiting for the reader for at most this long.
  void drain(int patience_ms);
  /// True once nobody reads any more.
  [[nodiscard]] bool is_broken() const { return is_broken_; }
  [[nodiscard]] std::uint64_t left_out() const { return left_out_; }

 private:
  /// True if the pipe took something.
  [[nodiscard]] bool pass_on(int patience_ms);

  int descriptor_;
  std::size_t most_bytes_;
  std::string kept_{};
  bool is_broken_ = false;
  std::uint64_t left_out_ = 0;  ///< lines
};

}  // namespace proofmass::serve
