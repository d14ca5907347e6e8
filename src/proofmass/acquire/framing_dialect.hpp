#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "proofmass/acquire/framing_clock.hpp"
#include "proofmass/acquire/framing_plan.hpp"

namespace proofmass::acquire {

/// A line that waits until it is known what the columns are.
struct HeldLine {
  std::string text{};
  std::int64_t host_ns = 0;
};

/// How a line fits the columns.
enum class LineFit {
  row,
  blank,   ///< nothing that was asked for is in it
  header,  ///< the names once more: the device has begun anew
  words,   ///< no row at all
  broken,  ///< a row that was damaged
};

/// Takes lines of one kind apart: a table's, or such that bring names with their figures.
class LineDialect {
 public:
  virtual ~LineDialect() = default;
  [[nodiscard]] virtual const std::vector<RowField>& fields() const = 0;
  [[nodiscard]] virtual bool has_names() const = 0;
  /// The figures of a line, as many as fields, NaN where there is none, and the reading of the
  /// field that is the clock.
  [[nodiscard]] virtual LineFit read(std::string_view line,
                                     std::optional<std::size_t> clock,
                                     std::span<double> values,
                                     std::optional<Tick>& tick) = 0;
  /// Which fields are asked for, once that is known.
  virtual void keep(const RowPlan& /*plan*/) {}
  [[nodiscard]] std::vector<Note>& notes() { return notes_; }

 protected:
  std::vector<Note> notes_;
};

/// A figure as a clock's reading, exact; nullopt if it is none.
[[nodiscard]] std::optional<Tick> tick_in(std::string_view figure, char point);

/// What the lines are, and the first of them that is a row.
struct FoundDialect {
  std::unique_ptr<LineDialect> dialect{};  ///< nullptr: they are something else
  std::size_t begin = 0;
  std::vector<Note> notes{};  ///< of the names
};

/// A table with or without a header. Of a stream a first line of figures is left away, as it may
/// lack its beginning, and so is what stands above the last header: rows from before the device
/// began anew. Errors: invalid_argument (columns= of another number than the table has).
[[nodiscard]] Result<FoundDialect> find_table(std::span<const HeldLine> lines,
                                              const FramingOptions& options);

/// Lines of "label:value" pairs, JSON objects, OSC messages, if most are. Of a stream the first is
/// left away.
[[nodiscard]] FoundDialect find_keyed(std::span<const HeldLine> lines,
                                      const FramingOptions& options);

}  // namespace proofmass::acquire
