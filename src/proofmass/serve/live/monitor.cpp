#include "proofmass/serve/live/monitor.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <fmt/format.h>
#include <limits>
#include <nlohmann/json.hpp>
#include <utility>

#include "proofmass/report/noise/report.hpp"
#include "proofmass/report/page/json.hpp"
#include "proofmass/serve/live/json_numbers.hpp"
#include "proofmass/serve/live/lines.hpp"

namespace proofmass::serve {
namespace {

using MonitorClock = std::chrono::steady_clock;
using MonitorJson = nlohmann::ordered_json;

constexpr std::size_t most_noise_channels = 6;
constexpr std::size_t queue_rows = std::size_t{1} << 18;
constexpr double audit_s = 5.0;

std::vector<std::size_t> channels_for_noise(const Recording& head) {
  std::vector<std::size_t> out;
  for (const Quantity wanted : {Quantity::acceleration, Quantity::unknown}) {
    for (std::size_t c = 0; c < head.channels.size() && out.size() < most_noise_channels; ++c)
      if (wanted == Quantity::unknown || head.channels[c].unit.quantity == wanted) out.push_back(c);
    if (!out.empty()) break;
  }
  return out;
}

Rows copy_of(const Block& block) {
  Rows rows;
  rows.stamps_s.assign(block.stamps_s.begin(), block.stamps_s.end());
  for (const View<double>& channel : block.channels)
    rows.channels.emplace_back(channel.begin(), channel.end());
  return rows;
}

}  // namespace

LiveMonitor::LiveMonitor(const Recording& head, std::size_t most_noise_samples)
    : head_(head),
      most_noise_samples_(static_cast<double>(most_noise_samples)),
      rate_hz_(head.time.rate_hz),
      clipped_(head.channels.size(), 0) {
  for (const std::size_t channel : channels_for_noise(head)) noise_.push_back({channel});
  restart();
  thread_ = std::thread([this] { run(); });
}

LiveMonitor::~LiveMonitor() {
  {
    const std::lock_guard lock(mutex_);
    ends_ = true;
  }
  changed_.notify_all();
  thread_.join();
}

void LiveMonitor::add(const Block& block) {
  if (block.rows() == 0 || block.stamps_s.empty()) return;
  const std::lock_guard lock(mutex_);
  if (queued_rows_ + block.rows() > queue_rows) return;
  queue_.push_back(copy_of(block));
  queued_rows_ += block.rows();
  changed_.notify_one();
}

std::vector<std::string> LiveMonitor::take() {
  const std::lock_guard lock(mutex_);
  return std::exchange(lines_, {});
}

void LiveMonitor::hand_out(std::string line) {
  constexpr std::size_t most = 64;  // nobody takes them
  const std::lock_guard lock(mutex_);
  if (lines_.size() < most) lines_.push_back(std::move(line));
}

void LiveMonitor::run() {
  constexpr std::chrono::milliseconds shortest{500}, first{1500};
  MonitorClock::time_point due = MonitorClock::now() + first;
  std::unique_lock lock(mutex_);
  while (!ends_) {
    changed_.wait_until(lock, due, [&] { return ends_ || !queue_.empty(); });
    if (ends_) return;
    std::deque<Rows> taken = std::exchange(queue_, {});
    queued_rows_ = 0;
    lock.unlock();
    for (const Rows& rows : taken) work(rows);
    if (const auto begun = MonitorClock::now(); begun >= due) {
      characterise_next();
      const auto cost = MonitorClock::now() - begun;
      due = MonitorClock::now() + std::max<MonitorClock::duration>(shortest, 9 * cost);
    }
    lock.lock();
  }
}

void LiveMonitor::work(const Rows& rows) {
  audit(rows);
  if (rate_hz_ <= 0.0) find_rate(rows);
  if (rate_hz_ > 0.0) add_noise(rows);
}

void LiveMonitor::audit(const Rows& rows) {
  if (!audit_) {
    audit_.emplace(head_);
    audited_since_s_ = rows.stamps_s.front();
    audited_rows_ = 0;
  }
  audit_->add(view_of(rows, audited_rows_));
  audited_rows_ += rows.rows();
  if (rows.stamps_s.back() - audited_since_s_ >= audit_s) write_audit();
}

void LiveMonitor::write_audit() {
  const signal::RecordingAudit found = audit_->finish(head_);
  audit_.reset();
  MonitorJson channels = MonitorJson::array();
  for (std::size_t c = 0; c < std::min(clipped_.size(), found.channels.size()); ++c) {
    clipped_[c] += found.channels[c].clipped;
    channels.push_back({{"name", found.channels[c].name}, {"clipped", clipped_[c]}});
  }
  std::string jitter;
  append_number(jitter, found.timing.jitter_s.value_or(std::numeric_limits<double>::quiet_NaN()),
                4);
  hand_out(live_line(
      "audit", fmt::format("{{\"jitter_s\":{},\"channels\":{}}}", jitter,
                           channels.dump(-1, ' ', false, MonitorJson::error_handler_t::replace))));
}

/// The rate of a source that states none, from its stamps.
void LiveMonitor::find_rate(const Rows& rows) {
  constexpr std::size_t fewest = 64;
  const double span_s = rows.stamps_s.back() - audited_since_s_;
  if (audited_rows_ < fewest || !(span_s > 0.0)) return;
  rate_hz_ = static_cast<double>(audited_rows_ - 1) / span_s;
  restart();
}

void LiveMonitor::restart() {
  last_s_.reset();
  if (rate_hz_ <= 0.0) return;
  for (Noise& one : noise_) {
    auto started = characterise::NoiseStream::start({.rate_hz = rate_hz_});
    one.stream.reset();
    if (started) one.stream.emplace(std::move(started).value());
  }
}

/// Adds what is missing before a stamp, or starts anew.
void LiveMonitor::go_on_to(double first_s) {
  constexpr double most_missing = 1000.0;
  if (!last_s_) return;
  const double missing = std::round((first_s - *last_s_) * rate_hz_) - 1.0;
  const bool is_full = (*last_s_ - since_s_) * rate_hz_ >= most_noise_samples_;
  if (missing < -0.5 || missing > most_missing || is_full) return restart();
  const std::vector<double> none(static_cast<std::size_t>(std::max(0.0, missing)),
                                 std::numeric_limits<double>::quiet_NaN());
  for (Noise& one : noise_)
    if (one.stream && !none.empty()) one.stream->add(none);
}

void LiveMonitor::add_noise(const Rows& rows) {
  go_on_to(rows.stamps_s.front());
  if (!last_s_) since_s_ = rows.stamps_s.front();
  last_s_ = rows.stamps_s.back();
  for (Noise& one : noise_) {
    if (!one.stream) continue;
    std::vector<double> values = rows.channels[one.channel];
    const Unit& unit = head_.channels[one.channel].unit;
    if (unit.quantity == Quantity::acceleration)
      for (double& value : values) value = unit.si(value);
    one.stream->add(values);
  }
}

/// Channels whose noise cannot be characterised yet are skipped.
void LiveMonitor::characterise_next() {
  for (std::size_t tried = 0; tried < noise_.size(); ++tried) {
    Noise& one = noise_[next_noise_];
    next_noise_ = (next_noise_ + 1) % noise_.size();
    if (!one.stream) continue;
    auto analysis = one.stream->finish();
    report::NoiseReport report;
    const Channel& channel = head_.channels[one.channel];
    report.inputs = {channel.name};
    report::ChannelNoise& shown = report.channels.emplace_back();
    shown.name = channel.name;
    shown.unit =
        channel.unit.quantity == Quantity::acceleration ? *parse_unit("m/s^2") : channel.unit;
    if (!analysis) {
      if (analysis.error().code == Errc::too_few_samples) continue;
      shown.refused = analysis.error().message;
    } else {
      shown.analysis = std::move(analysis).value();
    }
    std::string seconds;
    append_number(seconds, last_s_.value_or(0.0) - since_s_, 6);
    hand_out(
        live_line("noise", fmt::format("{{\"channel\":{},\"seconds\":{},\"page\":{}}}", one.channel,
                                       seconds, report::page_json(report::describe(report).page))));
    return;
  }
}

}  // namespace proofmass::serve
