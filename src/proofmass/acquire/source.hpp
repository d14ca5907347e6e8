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

// Where samples come from while they are taken: a device, a network, a pipe, the twin.
namespace proofmass::acquire {

inline constexpr std::int64_t ns_per_s = 1'000'000'000;

/// What a source says of itself once it is open.
struct SourceHead {
  /// source: its URI; format: "IIO", "serial", …; channels without values, in the units they come
  /// in (Quantity::unknown where nobody says); time: the rate that was granted, 0 if it has none of
  /// its own, and start_ns where what comes was taken at another time than now.
  Recording recording;
  bool has_device_clock = false;  ///< arrivals bring device_ns
  /// It comes at its own pace, whether or not anybody takes it; else it waits for whoever reads.
  bool is_paced = true;
  /// What was asked for and what was granted, in words: {"trigger", "t0"}, {"range", "±5 V"}.
  std::vector<std::pair<std::string, std::string>> settings{};
};

/// Nanoseconds of the clock that never jumps (CLOCK_MONOTONIC).
[[nodiscard]] std::int64_t host_now_ns();

/// Rows that came together, none known to be missing between them. Belongs to whoever reads, and
/// keeps its memory from one reading to the next.
struct Arrival {
  std::vector<std::vector<double>> channels{};  ///< in the head's order, equally long
  /// The device's own clock at each row, of any origin, unwrapped: it goes back only where the
  /// device's does. Empty without one.
  std::vector<std::int64_t> device_ns{};
  /// Rows that the device or the protocol knows to be missing in front of the first: a counter's
  /// step, an overrun. What only the clocks betray is not in it.
  std::uint64_t lost_before = 0;
  /// The device's own count of rows at the first and the last, where it counts them.
  std::optional<double> first_count{}, last_count{};
  std::int64_t host_ns = 0;  ///< host_now_ns() when the last row was there
  /// What happened since the last reading: "passed over 17 bytes up to the next frame".
  std::vector<Note> notes{};

  [[nodiscard]] std::size_t rows() const { return channels.empty() ? 0 : channels.front().size(); }
  /// Empty, with room for so many channels.
  void clear(std::size_t channel_count);
};

enum class Arrived {
  rows,     ///< at least one
  nothing,  ///< none within the time; there may be notes
  ended,    ///< there will be no more: the file or the stream is at its end
};

/// A source that is open. It is read by one thread; what it needs to never stop listening is its
/// own. Whatever blocks for ever in a library stands on a thread of its own, so that read() keeps
/// its time and the destructor returns.
class Source {
 public:
  Source() = default;
  Source(const Source&) = delete;
  Source& operator=(const Source&) = delete;
  virtual ~Source() = default;

  [[nodiscard]] virtual const SourceHead& head() const = 0;
  /// Puts what is there into `arrival`, which is cleared before; waits `patience` for it at most.
  /// A reading holds about a tenth of a second's rows at most, where the source can choose.
  /// Errors: device (gone, refused, broken: the source is at its end), corrupt (of files).
  [[nodiscard]] virtual Result<Arrived> read(Arrival& arrival,
                                             std::chrono::milliseconds patience) = 0;
};

/// A source's URI as it may be shown and kept: without what password= says, or stands before an @.
[[nodiscard]] std::string shown_uri(const std::string& uri);

struct OpenOptions {
  /// How long a source may wait for its device's first words or samples.
  std::chrono::milliseconds patience{5000};
  /// Asked now and then while it waits; true: give up. May be empty.
  std::function<bool()> stopped{};
  std::string duckdb_library{};  ///< path of libduckdb.so, which reads Parquet; empty: the system's
  std::string nidaqmx_library{};  ///< path of libnidaqmx.so; empty: the system's
};

/// Opens "scheme:rest". What the device needs to be told is told and checked when this returns.
/// Errors: invalid_argument (the URI: which part, and what was expected), device (not there,
/// refuses: why, and what to do), unsupported (this build lacks the library).
[[nodiscard]] Result<std::unique_ptr<Source>> open_source(const std::string& uri,
                                                          const OpenOptions& options = {});

/// Something that can be opened now.
struct FoundSource {
  std::string uri;
  std::string what;  ///< "LIS3DH, 3 axes, trigger t0"
};

/// A kind of source, for help and lists.
struct SourceKind {
  std::string scheme;   ///< "serial"
  std::string grammar;  ///< "serial:DEVICE?baud=115200&framing=lines"
  std::string what;     ///< one sentence
  /// Looks for what is there, for some seconds at most; empty where it cannot be looked for.
  std::function<Result<std::vector<FoundSource>>(const OpenOptions& options)> find{};
};

/// All kinds there are, in the order of the documentation.
[[nodiscard]] std::vector<SourceKind> source_kinds();

}  // namespace proofmass::acquire
