#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "proofmass/acquire/sim/faults.hpp"
#include "proofmass/acquire/sim/signal.hpp"
#include "proofmass/acquire/source_list.hpp"
#include "proofmass/acquire/stream/pacer.hpp"
#include "proofmass/core/random.hpp"

namespace proofmass::acquire {
namespace {

constexpr std::uint64_t never = std::numeric_limits<std::uint64_t>::max();

/// Number of the first row at or after a time; without a time, never.
std::uint64_t row_at(std::optional<double> time_s, double rate_hz) {
  constexpr double most = 1e18;
  if (!time_s || *time_s * rate_hz > most) return never;
  return static_cast<std::uint64_t>(std::ceil(*time_s * rate_hz));
}

/// Timing of the rows, as requested.
struct SimCourse {
  std::optional<double> speed{};  ///< speed of time; absent: as fast as they are read
  std::uint64_t block = 1;        ///< rows per transfer of the device
  std::uint64_t rows = never;     ///< total
  SimFaults faults{};
};

/// The twin as a device: it fills blocks, and transfers full ones.
class SimSource final : public Source {
 public:
  SimSource(SourceHead head, SimSignal signal, const SimCourse& course)
      : head_(std::move(head)),
        signal_(std::move(signal)),
        course_(course),
        rate_hz_(head_.recording.time.rate_hz),
        unplug_row_(row_at(course.faults.unplug_s, rate_hz_)) {
    const SimFaults& faults = course.faults;
    if (faults.stall) stall_row_ = row_at(faults.stall->at_s, rate_hz_);
    if (faults.clock_jump) jump_row_ = row_at(faults.clock_jump->at_s, rate_hz_);
    if (course.speed) pacer_.emplace(*course.speed);
    // A tenth of a second of rows, as Source::read() requires; most_rows is a limit for any rate.
    constexpr double reading_s = 0.1, most_rows = 65536.0;
    reading_rows_ = static_cast<std::uint64_t>(std::min(reading_s * rate_hz_, most_rows));
    draw_loss();
  }

  [[nodiscard]] const SourceHead& head() const override { return head_; }

  [[nodiscard]] Result<Arrived> read(Arrival& arrival,
                                     std::chrono::milliseconds patience) override {
    arrival.clear(head_.recording.channels.size());
    if (next_ >= unplug_row_)
      return Error{Errc::device, fmt::format("disconnected after {} s, as requested by unplug=",
                                             *course_.faults.unplug_s)};
    if (next_ >= course_.rows) return Arrived::ended;
    if (next_ == stall_row_ && !stalled_.wait_until(stall_ns(), patience)) return Arrived::nothing;
    if (pacer_ && !pacer_->wait_until(true_ns(block_end() - 1), patience)) return Arrived::nothing;
    const std::uint64_t first = next_, most = std::max(reading_rows_, block_end() - next_);
    do take_block(arrival);
    while (goes_on() && block_end() - first <= most && !(is_lost_ && arrival.rows() > 0));
    arrival.host_ns = host_now_ns();
    return arrival.rows() > 0 ? Arrived::rows : Arrived::nothing;
  }

 private:
  /// The next limit of a block: the end of the rows, or a fault.
  [[nodiscard]] std::uint64_t barrier() const {
    const std::uint64_t end = std::min(course_.rows, unplug_row_);
    return next_ < stall_row_ ? std::min(end, stall_row_) : end;
  }
  [[nodiscard]] std::uint64_t block_end() const {
    return std::min(next_ + course_.block, barrier());
  }
  /// True if another block is due and no fault precedes it.
  [[nodiscard]] bool goes_on() {
    return next_ != stall_row_ && next_ < barrier() &&
           (!pacer_ || pacer_->now_ns() >= true_ns(block_end() - 1));
  }

  [[nodiscard]] std::int64_t true_ns(std::uint64_t row) const {
    return std::llround(static_cast<double>(row) / rate_hz_ * ns_per_s);
  }
  [[nodiscard]] std::int64_t stall_ns() const {
    return std::llround(course_.faults.stall->for_s * ns_per_s);
  }
  /// Value of the device's clock.
  [[nodiscard]] std::int64_t shown_ns(std::uint64_t row) const {
    if (course_.faults.dead_clock) return 0;
    if (row < jump_row_) return true_ns(row);
    return true_ns(row) + std::llround(course_.faults.clock_jump->by_s * ns_per_s);
  }

  void take_block(Arrival& arrival) {
    const std::uint64_t end = block_end();
    if (is_lost_) {
      for (std::vector<double>& column : unseen_) column.clear();
      signal_.make(end - next_, unseen_);
      lost_ += end - next_;
    } else {
      if (arrival.rows() == 0) arrival.lost_before = std::exchange(lost_, 0);
      signal_.make(end - next_, arrival.channels);
      for (std::uint64_t row = next_; row < end; ++row) arrival.device_ns.push_back(shown_ns(row));
    }
    next_ = end;
    draw_loss();
  }

  void draw_loss() { is_lost_ = course_.faults.drop > 0.0 && losses_.unit() < course_.faults.drop; }

  SourceHead head_;
  SimSignal signal_;
  SimCourse course_;
  double rate_hz_;
  std::uint64_t unplug_row_, stall_row_ = never, jump_row_ = never;
  std::uint64_t reading_rows_ = 1;
  std::optional<Pacer> pacer_;
  Pacer stalled_{1.0};  ///< on the host's clock, independent of the speed
  std::uint64_t next_ = 0;
  Random losses_{1, "lost blocks"};
  bool is_lost_ = false;
  std::uint64_t lost_ = 0;  ///< since the last transferred row
  std::vector<std::vector<double>> unseen_;
};

Result<SimCourse> course_of(SourceUri& uri, const SimSignal& signal) {
  SimCourse course;
  if (uri.value("speed") != "max") {
    const auto speed = uri.number("speed", 0.0);
    if (!speed)
      return Error{Errc::invalid_argument,
                   fmt::format("speed={}: expected a number above 0, or max", *uri.value("speed"))};
    course.speed = speed->value_or(1.0);
  }
  const double rate_hz = signal.head.time.rate_hz;
  const auto seconds = uri.number("seconds", 0.0);
  if (!seconds) return seconds.error();
  course.rows = std::min(row_at(*seconds, rate_hz), signal.rows.value_or(never));
  // Size of a device's buffer: short enough for low latency, long enough that fast rows do not come
  // one by one.
  constexpr double block_s = 0.01;
  constexpr std::uint64_t most_block = 65536;
  const auto block = uri.whole("block", 1, most_block);
  if (!block) return block.error();
  course.block = block->value_or(static_cast<std::uint64_t>(
      std::clamp(block_s * rate_hz, 1.0, static_cast<double>(most_block))));
  auto faults = sim_faults(uri);
  if (!faults) return faults.error();
  course.faults = *faults;
  return course;
}

/// All settings, so that the recording documents how it was made.
std::vector<std::pair<std::string, std::string>> settings_of(SourceUri& uri,
                                                             const SimSignal& signal,
                                                             const SimCourse& course) {
  std::vector<std::pair<std::string, std::string>> settings{
      {"rate", fmt::format("{} Hz", signal.head.time.rate_hz)},
      {"speed", course.speed ? fmt::format("{}", *course.speed) : "max"},
      {"block", fmt::format("{} rows", course.block)}};
  for (const char* fault : {"drop", "stall", "unplug", "clock-jump", "dead-clock"})
    if (auto text = uri.value(fault))
      settings.emplace_back(fmt::format("fault {}", fault), *std::move(text));
  return settings;
}

}  // namespace

Result<std::unique_ptr<Source>> open_sim(SourceUri& uri, const OpenOptions& /*options*/) {
  auto made = sim_signal(uri);
  if (!made) return made.error();
  SimSignal signal = std::move(made).value();
  const auto course = course_of(uri, signal);
  if (!course) return course.error();
  if (const Status known = uri.nothing_unknown(); !known) return known.error();
  SourceHead head{.recording = signal.head,
                  .has_device_clock = true,
                  // At another speed the host's clock gives no information on the device's.
                  .is_paced = course->speed == 1.0,
                  .settings = settings_of(uri, signal, *course)};
  head.recording.source = uri.text();
  return std::unique_ptr<Source>(
      std::make_unique<SimSource>(std::move(head), std::move(signal), *course));
}

Result<std::vector<FoundSource>> find_sim() {
  return std::vector<FoundSource>{
      {"sim:wheel", "a wheel at 11 rpm with two accelerometers, simulated: no hardware needed"}};
}

}  // namespace proofmass::acquire
