#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "proofmass/acquire/framing_rows.hpp"
#include "proofmass/acquire/source.hpp"
#include "proofmass/acquire/source_uri.hpp"
#include "proofmass/core/result.hpp"

// From the bytes of a serial line, a pipe or a datagram to rows. docs/methods/framing.md has the
// grammar.
namespace proofmass::acquire {

/// How rows lie in the bytes.
enum class Framing {
  lines,   ///< of text: tables, label:value pairs, JSON objects; in datagrams OSC too
  cobs,    ///< fields, byte-stuffed, between zeros
  slip,    ///< fields, escaped, between 0xC0
  sync,    ///< fields behind a word that begins each frame
  packet,  ///< fields, one or several frames in a datagram
};

/// Whether bytes come in a stream, which may begin anywhere, or in pieces that are whole.
enum class Carrier { stream, pipe, datagrams };

struct FramingOptions {
  Framing framing = Framing::lines;
  Carrier carrier = Carrier::stream;
  std::string sync{};                  ///< bytes of the word of Framing::sync
  std::string fields{};                ///< "u32 t_us, i16 x y z, crc16"; of all but lines
  bool big_endian = false;             ///< fields that do not say otherwise
  std::vector<std::string> columns{};  ///< names where lines have none; else those to keep
  std::string time{};                  ///< column of the device's clock; "none"; empty: find it
  std::string time_unit{};             ///< s, ms, us, ns; empty: find it
  std::string counter{};               ///< column that counts rows; "none"; empty: find it
  std::string unit{};                  ///< "g" of all channels, or "ax:g,gx:deg/s"
  std::string scale{};                 ///< the same with factors: "0.001", "x:0.001,y:0.002"
  double rate_hz = 0.0;                ///< of the rows, where there is no clock; 0 unknown
};

/// Asks a URI for framing=, fields=, endian=, columns=, time=, time-unit=, counter=, unit=, scale=
/// and rate=. Errors: invalid_argument.
[[nodiscard]] Result<FramingOptions> framing_options(SourceUri& uri, Carrier carrier);

/// What was passed over on the way to the rows.
struct DecodeCounts {
  std::uint64_t rows = 0;           ///< that came out
  std::uint64_t lost = 0;           ///< rows known to be missing
  std::uint64_t lines = 0;          ///< that fitted no row
  std::uint64_t bytes = 0;          ///< that belonged to no frame or line
  std::uint64_t bad_checksums = 0;  ///< frames
  std::uint64_t untimed = 0;        ///< rows whose clock's reading is none
  std::uint64_t late = 0;           ///< rows that a datagram brought after their successors
};

/// Takes bytes and gives rows. Whatever comes is passed over, counted and told if it fits nowhere;
/// memory is bounded, as long as rows are handed out between the bytes.
class Decoder {
 public:
  /// Errors: invalid_argument (fields=, scale=, … that make no sense).
  [[nodiscard]] static Result<std::unique_ptr<Decoder>> make(const FramingOptions& options);

  explicit Decoder(const FramingOptions& options) : options_(options) {}
  Decoder(const Decoder&) = delete;
  Decoder& operator=(const Decoder&) = delete;
  virtual ~Decoder() = default;

  /// The next bytes of a stream, cut anywhere; they were there at host_ns.
  virtual void take(std::string_view bytes, std::int64_t host_ns) = 0;
  /// A whole datagram: one or more lines, frames, a JSON document, an OSC message.
  virtual void take_packet(std::string_view packet, std::int64_t host_ns) = 0;
  /// No more bytes: a last line needs no end.
  virtual void finish(std::int64_t host_ns) = 0;

  /// Decides on the columns by what has come, if that is enough; at the last chance one row is.
  /// True once they are decided; before, rows wait. Errors: invalid_argument (columns=, time=, …
  /// that what came does not have).
  [[nodiscard]] virtual Result<bool> settle(bool is_last_chance) = 0;
  /// What came and why it is no row, for the error of a source that could not be opened:
  /// "312 bytes came, but no line of figures". Empty if nothing came.
  [[nodiscard]] virtual std::string what_came() const = 0;

  /// Rows that the source knows to be missing here (a kernel's count of drops). A counter column
  /// knows better, where there is one.
  void lose(std::uint64_t rows) { rows_.lose(rows); }
  /// Fills channels, time, notes and settings in, and has_device_clock. Expects settled columns.
  void describe(SourceHead& head) const;
  /// Moves the next rows that belong together and all notes into `arrival`, which is cleared
  /// before; false if there are no rows.
  [[nodiscard]] bool hand_out(Arrival& arrival) { return rows_.hand_out(arrival); }
  [[nodiscard]] bool has_rows() const { return !rows_.empty(); }
  [[nodiscard]] DecodeCounts counts() const;

 protected:
  FramingOptions options_;
  RowQueue rows_;
  DecodeCounts counts_;
  std::vector<std::pair<std::string, std::string>> settings_;  ///< what was decided, in words
};

/// Feeds the decoder with what comes within the time; false: there will be no more.
using Pump = std::function<Result<bool>(std::chrono::milliseconds patience)>;

/// Pumps until the columns are decided and a row is there. Errors: device (nothing came, or nothing
/// that fits, within the patience), those of settle() and of the pump.
[[nodiscard]] Status await_rows(Decoder& decoder, const OpenOptions& options, const Pump& pump);

}  // namespace proofmass::acquire
