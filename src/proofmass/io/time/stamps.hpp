#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "proofmass/core/view.hpp"
#include "proofmass/io/time/stamp_steps.hpp"
#include "proofmass/io/time/wrap.hpp"

namespace proofmass::io {

/// Count and first positions of affected samples.
struct SampleTally {
  std::size_t count = 0;
  std::vector<std::size_t> first;  ///< at most five

  void add(std::size_t sample);
  /// "lines 12, 40, 41 and 7 more", as places().
  [[nodiscard]] std::string where(std::size_t first_line) const;
};

/// Corrections of a column of stamps.
struct MendedStamps {
  SampleTally samples;            ///< replaced samples
  std::size_t backwards = 0;      ///< replaced stamps that were below the previous one
  std::size_t by_counter = 0;     ///< replaced stamps determined by the instrument's counter
  SampleTally wraps;              ///< positions of counter wraps
  std::string wrapped;            ///< its range: "32 bits"
  double longest_wrap_gap = 0.0;  ///< between the stamps on either side, if above a usual interval
  SampleTally hours;              ///< daylight saving began or ended: the hour was removed
  std::size_t hours_back = 0;     ///< number of `hours` with the clock set back
  SampleTally restarts;           ///< the clock decreased permanently: continued one step later
  double fell_from = 0.0;         ///< clock value before the first of them
  double fell_to = 0.0;           ///< clock value at the first of them
  SampleTally settings;           ///< the clock jumped by more than ten years: likewise
};

/// Parameters for judging a column's stamps, all in its own unit.
struct StampRules {
  double nominal = 1.0;  ///< one period
  double usual = 1.5;    ///< longest interval that needs no check
  double origin = 0.0;   ///< clock value where the column's stamps are 0
  double unit_s = 1.0;
  bool has_summer_time = false;  ///< a wall clock without a zone
  std::size_t first_good = 0;    ///< the first row with a valid time, and its stamp
  double first_stamp = 0.0;
};

/// Unwraps and corrects a column of stamps, row by row.
///
/// - Wraps are unwrapped.
/// - A stamp that is not a number, or deviates from those before and after it, is replaced by the
///   instrument's counter, or evenly between its good neighbours.
/// - An hour forwards or back on a wall clock is removed.
/// - A clock that decreases permanently (a reboot), or jumps by more than ten years, continues one
///   step later: the duration of the interruption is unknown.
/// - Gaps and repeats are kept.
class StampMender {
 public:
  /// Number of following rows by which a stamp is judged.
  static constexpr std::size_t window = 24;
  /// An interval without stamps is interpolated between its ends if it is not longer; else it is
  /// extrapolated at the nominal period.
  static constexpr std::size_t longest_stretch = 4096;
  static constexpr std::size_t most_unsettled = longest_stretch + window;

  StampMender() = default;
  explicit StampMender(const StampRules& rules) : rules_(rules), wraps_(rules.unit_s) {}

  /// The first row with a plausible time: most of the following rows come after it, and within a
  /// reasonable time. nullopt if there is not a number.
  [[nodiscard]] static std::optional<std::size_t> first_good(View<double> stamps,
                                                             const StampRules& rules);

  /// As RunningTimeBase::mend(), in the column's unit: stamps are relative to the origin before and
  /// after.
  [[nodiscard]] std::size_t fold(std::span<double> stamps, View<double> counter, bool is_end);
  [[nodiscard]] const MendedStamps& done() const { return done_; }
  [[nodiscard]] double usual() const { return rules_.usual; }

 private:
  struct Good {
    std::size_t row = 0;
    double reading = 0.0;  ///< as read, minus the origin
    double stamp = 0.0;    ///< as returned
    double count = 0.0;    ///< the instrument's counter
  };
  enum class Event { none, bad, wrap, hour, restart, setting, undecided };
  struct Judgement {
    Event event = Event::none;
    double shift = 0.0;  ///< from the read value to the stamp
    std::optional<std::size_t> wrap{};
  };
  /// Rows as passed in; row_ is the number of the first.
  struct Rows {
    std::span<double> stamps;
    View<double> counter;
    bool is_end = false;
  };
  /// Rows without a usable stamp, and the stamps at both ends.
  struct Stretch {
    std::size_t first = 0;
    std::size_t end = 0;
    std::optional<double> right{};  ///< stamp at the end, if known
    bool is_open = false;           ///< its end is not yet visible
  };

  [[nodiscard]] Judgement judge(const Rows& rows, std::size_t k) const;
  [[nodiscard]] Judgement judge_fall(const Rows& rows, std::size_t k) const;
  [[nodiscard]] Judgement judge_leap(const Rows& rows, std::size_t k) const;
  [[nodiscard]] double rows_since_last(std::size_t k) const;
  [[nodiscard]] bool counts_on(const Rows& rows, std::size_t k) const;
  [[nodiscard]] Stretch stretch_from(const Rows& rows, std::size_t k) const;
  void accept(const Rows& rows, std::size_t k, const Judgement& as);
  void report(const Judgement& as, double reading, std::size_t row);
  void place(const Rows& rows, const Stretch& stretch);
  [[nodiscard]] std::size_t place_before_first(const Rows& rows);
  [[nodiscard]] bool pass_regular(const Rows& rows, std::size_t k, std::size_t count);

  StampRules rules_;
  WrapFinder wraps_;
  MendedStamps done_;
  std::size_t row_ = 0;
  std::optional<Good> last_;
  double shift_ = 0.0;
  std::optional<std::size_t> seen_;  ///< the range that has wrapped before
};

}  // namespace proofmass::io
