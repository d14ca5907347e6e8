#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "proofmass/core/view.hpp"
#include "proofmass/io/stamp_steps.hpp"
#include "proofmass/io/wrap.hpp"

namespace proofmass::io {

/// How many samples something befell, and where the first of them are: of millions as of two.
struct SampleTally {
  std::size_t count = 0;
  std::vector<std::size_t> first;  ///< five at most

  void add(std::size_t sample);
  /// "lines 12, 40, 41 and 7 more", as places().
  [[nodiscard]] std::string where(std::size_t first_line) const;
};

/// What was done to a column of stamps.
struct MendedStamps {
  SampleTally samples;            ///< that were replaced
  std::size_t backwards = 0;      ///< of these: were below the stamp before
  std::size_t by_counter = 0;     ///< of these: put where the instrument's counter says
  SampleTally wraps;              ///< where a counter ran over
  std::string wrapped;            ///< what of: "32 bits"
  double longest_wrap_gap = 0.0;  ///< between the stamps on either side, if above a usual step
  SampleTally hours;              ///< summer time began or ended: the hour was taken out
  std::size_t hours_back = 0;     ///< of these: the clock was put back
  SampleTally restarts;           ///< the clock fell back for good: it goes on one step later
  double fell_from = 0.0;         ///< reading before the first of them
  double fell_to = 0.0;           ///< and at it
  SampleTally settings;           ///< the clock leapt by more than ten years: likewise
};

/// What a column's stamps are judged by, all in its own unit.
struct StampRules {
  double nominal = 1.0;  ///< one step
  double usual = 1.5;    ///< longest step that needs no second look
  double origin = 0.0;   ///< the reading where the column's stamps are 0
  double unit_s = 1.0;
  bool has_summer_time = false;  ///< a wall clock without a zone
  std::size_t first_good = 0;    ///< the first row that is a time, and its stamp
  double first_stamp = 0.0;
};

/// Unrolls and mends a column of stamps, row after row: what ran over goes on; what is no number or
/// lies apart from those before and after it is put where the instrument's counter says, or evenly
/// between its good neighbours. An hour forwards or back on a wall clock is taken out. A clock that
/// falls back for good (a reboot), or leaps by more than ten years, goes on one step later: how
/// long it stood nobody knows. Gaps and repeats are kept.
class StampMender {
 public:
  /// Rows behind a stamp that it is judged by.
  static constexpr std::size_t window = 24;
  /// A stretch without stamps is put between its ends if it is not longer; else it goes on at the
  /// nominal step.
  static constexpr std::size_t longest_stretch = 4096;
  static constexpr std::size_t most_unsettled = longest_stretch + window;

  StampMender() = default;
  explicit StampMender(const StampRules& rules) : rules_(rules), wraps_(rules.unit_s) {}

  /// The first row that can be a time: most of those behind it come after it, and not ages later.
  /// nullopt if there is no number.
  [[nodiscard]] static std::optional<std::size_t> first_good(View<double> stamps,
                                                             const StampRules& rules);

  /// As RunningTimeBase::mend(), in the column's unit: stamps are less the origin before and after.
  [[nodiscard]] std::size_t fold(std::span<double> stamps, View<double> counter, bool is_end);
  [[nodiscard]] const MendedStamps& done() const { return done_; }
  [[nodiscard]] double usual() const { return rules_.usual; }

 private:
  struct Good {
    std::size_t row = 0;
    double reading = 0.0;  ///< as it came, less the origin
    double stamp = 0.0;    ///< as it is given out
    double count = 0.0;    ///< of the instrument's counter
  };
  enum class Event { none, bad, wrap, hour, restart, setting, undecided };
  struct Judgement {
    Event event = Event::none;
    double shift = 0.0;  ///< from the reading to the stamp
    std::optional<std::size_t> wrap{};
  };
  /// Rows as they are handed over; row_ is that of their front.
  struct Rows {
    std::span<double> stamps;
    View<double> counter;
    bool is_end = false;
  };
  /// Rows without a usable stamp, and what they end at.
  struct Stretch {
    std::size_t first = 0;
    std::size_t end = 0;
    std::optional<double> right{};  ///< stamp at the end, if it is known
    bool is_open = false;           ///< its end is not to be seen yet
  };

  [[nodiscard]] Judgement judge(const Rows& rows, std::size_t k) const;
  [[nodiscard]] Judgement judge_fall(const Rows& rows, std::size_t k) const;
  [[nodiscard]] Judgement judge_leap(const Rows& rows, std::size_t k) const;
  [[nodiscard]] double rows_since_last(std::size_t k) const;
  [[nodiscard]] bool counts_on(const Rows& rows, std::size_t k) const;
  [[nodiscard]] Stretch stretch_from(const Rows& rows, std::size_t k) const;
  void accept(const Rows& rows, std::size_t k, const Judgement& as);
  void tell(const Judgement& as, double reading, std::size_t row);
  void place(const Rows& rows, const Stretch& stretch);
  [[nodiscard]] std::size_t place_before_first(const Rows& rows);
  [[nodiscard]] bool pass_regular(const Rows& rows, std::size_t k, std::size_t count);

  StampRules rules_;
  WrapFinder wraps_;
  MendedStamps done_;
  std::size_t row_ = 0;
  std::optional<Good> last_;
  double shift_ = 0.0;
  std::optional<std::size_t> seen_;  ///< what ran over before
};

}  // namespace proofmass::io
