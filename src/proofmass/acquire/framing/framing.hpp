#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "proofmass/acquire/framing/rows.hpp"
#include "proofmass/acquire/source.hpp"
#include "proofmass/acquire/source_uri.hpp"
#include "proofmass/core/result.hpp"

// Converts the bytes of a serial line, a pipe or a datagram to rows. See docs/methods/framing.md
// for the grammar.
namespace proofmass::acquire {

/// Encoding of rows in the bytes.
enum class Framing {
  lines,   ///< text lines: tables, label:value pairs, JSON objects; in datagrams OSC too
  cobs,    ///< fields, byte-stuffed, delimited by zeros
  slip,    ///< fields, escaped, delimited by 0xC0
  sync,    ///< fields after a word that begins each frame
  packet,  ///< fields, one or several frames in a datagram
};

/// Whether bytes come as a stream, which may begin anywhere, or as complete pieces.
enum class Carrier { stream, pipe, datagrams };

struct FramingOptions {
  Framing framing = Framing::lines;
  Carrier carrier = Carrier::stream;
  std::string sync{};                  ///< the word of Framing::sync
  std::string fields{};                ///< "u32 t_us, i16 x y z, crc16"; for all framings but lines
  bool big_endian = false;             ///< default byte order of the fields
  std::vector<std::string> columns{};  ///< names if the lines have none; else columns to keep
  std::string time{};                  ///< column of the device's clock; "none"; empty: detect
  std::string time_unit{};             ///< s, ms, us, ns; empty: detect
  std::string counter{};               ///< column that counts rows; "none"; empty: detect
  std::string unit{};                  ///< "g" for all channels, or "ax:g,gx:deg/s"
  std::string scale{};                 ///< the same for factors: "0.001", "x:0.001,y:0.002"
  double rate_hz = 0.0;                ///< row rate if there is no clock; 0 if unknown
};

/// Reads framing=, fields=, endian=, columns=, time=, time-unit=, counter=, unit=, scale= and rate=
/// from a URI. Errors: invalid_argument.
[[nodiscard]] Result<FramingOptions> framing_options(SourceUri& uri, Carrier carrier);

/// Counts of decoded and skipped data.
struct DecodeCounts {
  std::uint64_t rows = 0;           ///< rows decoded
  std::uint64_t lost = 0;           ///< rows known to be missing
  std::uint64_t lines = 0;          ///< lines that are not rows
  std::uint64_t bytes = 0;          ///< bytes outside any frame or line
  std::uint64_t bad_checksums = 0;  ///< frames
  std::uint64_t untimed = 0;        ///< rows with an invalid clock value
  std::uint64_t late = 0;           ///< rows that a datagram delivered after their successors
};

/// Decodes bytes to rows. Data that fit nowhere are skipped, counted and reported; memory is
/// bounded, provided that rows are handed out between the bytes.
class Decoder {
 public:
  /// Errors: invalid_argument (invalid fields=, scale=, …).
  [[nodiscard]] static Result<std::unique_ptr<Decoder>> make(const FramingOptions& options);

  explicit Decoder(const FramingOptions& options) : options_(options) {}
  Decoder(const Decoder&) = delete;
  Decoder& operator=(const Decoder&) = delete;
  virtual ~Decoder() = default;

  /// The next bytes of a stream, cut anywhere; they arrived at host_ns.
  virtual void take(std::string_view bytes, std::int64_t host_ns) = 0;
  /// A whole datagram: one or more lines, frames, a JSON document, an OSC message.
  virtual void take_packet(std::string_view packet, std::int64_t host_ns) = 0;
  /// End of the bytes: a last line needs no line end.
  virtual void finish(std::int64_t host_ns) = 0;

  /// Determines the columns from the data so far, if they suffice; at the last chance one row does.
  /// Returns true once they are determined; until then rows wait. Errors: invalid_argument
  /// (columns=, time=, … that are not in the data).
  [[nodiscard]] virtual Result<bool> settle(bool is_last_chance) = 0;
  /// Description of the received data and why it contains no row, for the error of a source that
  /// could not be opened: "312 bytes came, but no line of figures". Empty if nothing was received.
  [[nodiscard]] virtual std::string what_came() const = 0;

  /// Rows that the source reports as missing here (a kernel's count of drops). A counter column
  /// takes precedence if there is one.
  void lose(std::uint64_t rows) { rows_.lose(rows); }
  /// Fills in channels, time, notes and settings, and has_device_clock. Expects determined columns.
  void describe(SourceHead& head) const;
  /// Moves the next contiguous rows and all notes into `arrival`, which is cleared before; false if
  /// there are no rows.
  [[nodiscard]] bool hand_out(Arrival& arrival) { return rows_.hand_out(arrival); }
  [[nodiscard]] bool has_rows() const { return !rows_.empty(); }
  [[nodiscard]] DecodeCounts counts() const;

 protected:
  FramingOptions options_;
  RowQueue rows_;
  DecodeCounts counts_;
  std::vector<std::pair<std::string, std::string>> settings_;  ///< the decisions, as text
};

/// Feeds the decoder with the data that arrive within the time; false: no more data.
using Pump = std::function<Result<bool>(std::chrono::milliseconds patience)>;

/// Pumps until the columns are determined and a row has arrived. Errors: device (nothing valid
/// within the patience), those of settle() and of the pump.
[[nodiscard]] Status await_rows(Decoder& decoder, const OpenOptions& options, const Pump& pump);

}  // namespace proofmass::acquire
