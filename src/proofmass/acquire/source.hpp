#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "proofmass/core/recording.hpp"
#include "proofmass/core/result.hpp"

// Live sources of samples: a device, a network, a pipe, the twin.
namespace proofmass::acquire {

inline constexpr std::int64_t ns_per_s = 1'000'000'000;

/// Description of an open source.
struct SourceHead {
  /// - source: its URI; format: "IIO", "serial", …
  /// - channels without values, in their original units (Quantity::unknown if not stated)
  /// - time: the granted rate, 0 if it has none, and start_ns if the data were taken at another
  ///   time than now.
  Recording recording;
  bool has_device_clock = false;  ///< arrivals include device_ns
  /// True: data arrive at their own pace, whether read or not; false: the source waits for its
  /// reader.
  bool is_paced = true;
  /// Requested and granted settings as text: {"trigger", "t0"}, {"range", "±5 V"}.
  std::vector<std::pair<std::string, std::string>> settings{};
};

/// Nanoseconds of the monotonic clock (CLOCK_MONOTONIC).
[[nodiscard]] std::int64_t host_now_ns();

/// Rows that arrived together, none known to be missing between them. Owned by the reader; keeps
/// its capacity between calls of read().
struct Arrival {
  std::vector<std::vector<double>> channels{};  ///< in the head's order, of equal length
  /// The device's own clock at each row, of any origin, unwrapped: it decreases only if the
  /// device's clock does. Empty if there is none.
  std::vector<std::int64_t> device_ns{};
  /// Rows before the first that the device or the protocol reports as missing: a counter step, an
  /// overrun. Gaps visible only in the clocks are not included.
  std::uint64_t lost_before = 0;
  /// The device's own row count at the first and the last row, if it counts.
  std::optional<double> first_count{}, last_count{};
  std::int64_t host_ns = 0;  ///< host_now_ns() when the last row arrived
  /// Notes since the last read: "skipped 17 bytes up to the next frame".
  std::vector<Note> notes{};

  [[nodiscard]] std::size_t rows() const { return channels.empty() ? 0 : channels.front().size(); }
  /// Clears all, with room for `channel_count` channels.
  void clear(std::size_t channel_count);
};

enum class Arrived {
  rows,     ///< at least one
  nothing,  ///< no rows within the time; there may be notes
  ended,    ///< no more data: end of the file or stream
};

/// An open source, read by one thread. A source that must listen continuously does so on its own
/// thread. A library call that may block for ever has its own thread, so that read() returns in
/// time and the destructor returns.
class Source {
 public:
  Source() = default;
  Source(const Source&) = delete;
  Source& operator=(const Source&) = delete;
  virtual ~Source() = default;

  [[nodiscard]] virtual const SourceHead& head() const = 0;
  /// Fills `arrival`, which is cleared before, with the available rows; waits for at most
  /// `patience`. One call returns at most about a tenth of a second of rows, if the source can
  /// choose.
  /// Errors: device (lost, refused, failed: the source has ended), corrupt (for files).
  [[nodiscard]] virtual Result<Arrived> read(Arrival& arrival,
                                             std::chrono::milliseconds patience) = 0;
};

/// A source's URI for display and storage: without the value of password= and anything before an @.
[[nodiscard]] std::string shown_uri(const std::string& uri);

struct OpenOptions {
  /// How long a source may wait for its device's first reply or samples.
  std::chrono::milliseconds patience{5000};
  /// Polled while waiting; true: give up. May be empty.
  std::function<bool()> stopped{};
  std::string duckdb_library{};   ///< path of libduckdb.so, for Parquet; empty: the system's
  std::string nidaqmx_library{};  ///< path of libnidaqmx.so; empty: the system's
};

/// Opens "scheme:rest". All device settings are made and checked when this returns.
/// Errors: invalid_argument (the URI: which part, and what was expected), device (absent, refuses:
/// reason and remedy), unsupported (the library is not in this build).
[[nodiscard]] Result<std::unique_ptr<Source>> open_source(const std::string& uri,
                                                          const OpenOptions& options = {});

/// A source that can be opened now.
struct FoundSource {
  std::string uri;
  std::string what;  ///< "LIS3DH, 3 axes, trigger t0"
};

/// A kind of source, for help and lists.
struct SourceKind {
  std::string scheme;   ///< "serial"
  std::string grammar;  ///< "serial:DEVICE?baud=115200&framing=lines"
  std::string what;     ///< one sentence
  /// Searches for available sources, for at most some seconds; empty if a search is not possible.
  std::function<Result<std::vector<FoundSource>>(const OpenOptions& options)> find{};
};

/// All kinds, in the order of the documentation.
[[nodiscard]] std::vector<SourceKind> source_kinds();

}  // namespace proofmass::acquire
