#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "proofmass/core/result.hpp"
#include "proofmass/io/bytes/random_bytes.hpp"
#include "proofmass/io/tdms/decode.hpp"
#include "proofmass/io/tdms/map.hpp"

namespace proofmass::io::tdms {

/// A window of the file from which several columns read their values in turn.
class Window {
 public:
  static constexpr std::uint64_t bytes = 256 << 10;

  /// `file` must outlive the window.
  explicit Window(const RandomBytes& file) : file_(file) {}

  /// The bytes from `offset`, at most Window::bytes, valid until the next call. If they are not
  /// in the window, a whole window is read, because other columns need the bytes around them.
  /// Errors: unreadable, corrupt (the file has become shorter).
  [[nodiscard]] Result<const char*> view(std::uint64_t offset, std::size_t size);
  /// The same for bytes that no other column needs.
  [[nodiscard]] Status read(std::uint64_t offset, std::span<char> into) const;

 private:
  const RandomBytes& file_;
  std::vector<char> held_;
  std::uint64_t held_at_ = 0;
  std::size_t held_size_ = 0;
};

/// The values of one channel, or of one of its scalers, in order.
class Column {
 public:
  /// `map` must outlive the column. Precondition: numbers or timestamps.
  Column(const Map& map, std::uint32_t channel, std::uint32_t scaler);

  /// Number of values that can be read next from one window, together with those of the adjacent
  /// columns.
  [[nodiscard]] std::size_t comfortable() const;
  /// Fills `into`, with NaN after the last value. Errors: those of the window.
  [[nodiscard]] Status read(Window& window, std::span<double> into);
  /// The first timestamp that is set; nullopt if there is none.
  [[nodiscard]] Result<std::optional<Instant>> first_instant(Window& window) const;
  void count_from(Int128 origin_ns) { encoding_.origin_ns = origin_ns; }

 private:
  /// The next evenly spaced values.
  struct Extent {
    std::uint64_t offset = 0;
    std::uint64_t stride = 0;
    std::uint64_t values = 0;
    std::uint64_t bytes_a_value = 0;  ///< file bytes per value, including those of other channels
    std::uint64_t reach = 0;  ///< range of bytes that contains all channels' values of one time
    bool is_shared = false;   ///< interleaved with other channels, closely enough for one window
  };

  void find_run();
  void find_extent();
  void advance(std::uint64_t count);
  [[nodiscard]] Status take(Window& window, std::span<double> into);

  const Map& map_;
  std::uint32_t channel_;
  std::uint32_t scaler_;
  Encoding encoding_;
  std::size_t run_ = 0;
  const Entry* entry_ = nullptr;  ///< in the current run; nullptr: no more values
  std::uint64_t done_ = 0;        ///< values of the current run
  Extent extent_;
  std::vector<char> own_;
};

}  // namespace proofmass::io::tdms
