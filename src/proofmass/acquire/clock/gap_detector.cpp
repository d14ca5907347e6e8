#include "proofmass/acquire/clock/gap_detector.hpp"

#include <algorithm>
#include <utility>

namespace proofmass::acquire {
namespace {

double seconds(std::int64_t from_ns, std::int64_t to_ns) {
  return static_cast<double>(to_ns - from_ns) * 1e-9;
}

bool is_rows(const QueueItem& item) {
  return item.kind == QueueItem::Kind::rows;
}

}  // namespace

GapDetector::GapDetector(bool has_device_clock, bool is_paced, double rate_hz, double stall_s)
    : counts_(!has_device_clock && is_paced && rate_hz > 0.0),
      waits_for_second_(!has_device_clock && !(rate_hz > 0.0)),
      rate_hz_(rate_hz),
      stall_s_(stall_s) {}

void GapDetector::put(QueueItem item) {
  const bool begins_hold = counts_ && is_rows(item) && !quiet_ns_ && last_ns_ &&
                           seconds(*last_ns_, item.arrival.host_ns) > stall_s_;
  if (begins_hold) quiet_ns_ = last_ns_;
  if (is_rows(item)) last_ns_ = item.arrival.host_ns;
  // An item that ends or interrupts the rows shows that no more of them will decide.
  const bool breaks = item.kind == QueueItem::Kind::gone || item.kind == QueueItem::Kind::ended ||
                      item.kind == QueueItem::Kind::gave_up;
  held_.push_back(std::move(item));
  if (breaks || is_settled()) settle();
}

bool GapDetector::is_settled() const {
  const auto rows = std::ranges::count_if(held_, is_rows);
  if (waits_for_second_) return rows != 1 || settled_ > 0;
  if (!quiet_ns_) return true;
  constexpr double hold_s = 0.35;
  const auto first = std::ranges::find_if(held_.begin() + static_cast<std::ptrdiff_t>(settled_),
                                          held_.end(), is_rows);
  return first == held_.end() || seconds(first->arrival.host_ns, *last_ns_) >= hold_s;
}

void GapDetector::settle() {
  const auto begin = held_.begin() + static_cast<std::ptrdiff_t>(settled_);
  const auto first = std::find_if(begin, held_.end(), is_rows);
  settled_ = held_.size();
  if (first == held_.end()) return;
  double rows = 0.0;
  for (auto item = first; item != held_.end(); ++item)
    if (is_rows(*item))
      rows += static_cast<double>(item->arrival.rows() + item->arrival.lost_before + item->overrun);
  if (waits_for_second_) {
    const double behind_first = rows - static_cast<double>(first->arrival.rows());
    if (behind_first > 0.0)
      first->step_s = seconds(first->arrival.host_ns, *last_ns_) / behind_first;
    waits_for_second_ = false;
  }
  if (!quiet_ns_) return;
  const double missing_s = seconds(*quiet_ns_, *last_ns_) - rows / rate_hz_;
  if (missing_s > 0.5 * stall_s_) first->gap_s = missing_s;
  quiet_ns_.reset();
}

bool GapDetector::take(QueueItem& item, bool at_end) {
  if (at_end && settled_ < held_.size()) settle();
  if (settled_ == 0) return false;
  item = std::move(held_.front());
  held_.pop_front();
  --settled_;
  return true;
}

}  // namespace proofmass::acquire
