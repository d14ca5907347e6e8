#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "proofmass/acquire/framing/clock.hpp"
#include "proofmass/acquire/framing/plan.hpp"

namespace proofmass::acquire {

/// A line that waits until the columns are known.
struct HeldLine {
  std::string text{};
  std::int64_t host_ns = 0;
};

/// Match of a line to the columns.
enum class LineFit {
  row,
  blank,   ///< none of the requested columns is in it
  header,  ///< the header again: the device has restarted
  words,   ///< not a row
  broken,  ///< a damaged row
};

/// Parses lines of one kind: those of a table, or lines with names and values.
class LineDialect {
 public:
  virtual ~LineDialect() = default;
  [[nodiscard]] virtual const std::vector<RowField>& fields() const = 0;
  [[nodiscard]] virtual bool has_names() const = 0;
  /// The values of a line, one per field, NaN where there is none, and the value of the clock
  /// field.
  [[nodiscard]] virtual LineFit read(std::string_view line,
                                     std::optional<std::size_t> clock,
                                     std::span<double> values,
                                     std::optional<Tick>& tick) = 0;
  /// Selects the requested fields, once that is known.
  virtual void keep(const RowPlan& /*plan*/) {}
  [[nodiscard]] std::vector<Note>& notes() { return notes_; }

 protected:
  std::vector<Note> notes_;
};

/// A number as a clock value, exact; nullopt if it is not a number.
[[nodiscard]] std::optional<Tick> tick_in(std::string_view figure, char point);

/// The detected dialect, and the first line that is a row.
struct FoundDialect {
  std::unique_ptr<LineDialect> dialect{};  ///< nullptr: another format
  std::size_t begin = 0;
  std::vector<Note> notes{};  ///< about the names
};

/// A table with or without a header. In a stream a first line of numbers is dropped, because its
/// beginning may be missing; so is everything above the last header, which is from before a restart
/// of the device. Errors: invalid_argument (columns= with a different number of columns than the
/// table).
[[nodiscard]] Result<FoundDialect> find_table(std::span<const HeldLine> lines,
                                              const FramingOptions& options);

/// Lines of "label:value" pairs, JSON objects or OSC messages, if most are. In a stream the first
/// is dropped.
[[nodiscard]] FoundDialect find_keyed(std::span<const HeldLine> lines,
                                      const FramingOptions& options);

}  // namespace proofmass::acquire
