#include "proofmass/acquire/framing/rows.hpp"

#include <fmt/format.h>
#include <utility>

namespace proofmass::acquire {

void RepeatedNote::add(const std::string& text, std::vector<Note>& notes) {
  constexpr std::uint64_t in_words = 3;
  if (++count_ <= in_words) notes.push_back({Severity::warning, text});
  if (count_ < next_) return;
  notes.push_back({Severity::warning, fmt::format("{} {} by now", count_, plural_)});
  next_ *= 10;
}

void RowQueue::begin(RowPlan plan, bool may_be_late) {
  plan_ = std::move(plan);
  channels_.resize(plan_.columns.size());
  if (plan_.clock) clock_.emplace(plan_.clock->unit_ns, plan_.clock->bits);
  if (plan_.counter) {
    counter_.emplace(plan_.counter->bits, may_be_late);
    pending_lost_ = 0;
  }
}

void RowQueue::lose(std::uint64_t rows) {
  if (!counter_) pending_lost_ += rows;
}

void RowQueue::begin_anew() {
  if (clock_) clock_->forget();
  if (counter_) counter_->forget();
}

void RowQueue::add(View<double> fields, const std::optional<Tick>& tick, std::int64_t host_ns) {
  if (counter_ && !count(fields)) return;
  if (clock_ && !place(tick)) return;
  join_group(host_ns);
  for (std::size_t c = 0; c < plan_.columns.size(); ++c)
    channels_[c].push_back(fields[plan_.columns[c].field] * plan_.columns[c].scale);
  ++rows_;
}

bool RowQueue::place(const std::optional<Tick>& tick) {
  const std::size_t wraps = clock_->wraps();
  const auto device_ns = tick ? clock_->place(*tick) : std::nullopt;
  if (!device_ns) {
    ++untimed_;
    ++pending_lost_;
    untimed_notes_.add(fmt::format("skipped a row whose {} is not a time", plan_.clock->name),
                       notes_);
    return false;
  }
  if (wraps == 0 && clock_->wraps() == 1)
    note(Severity::info, fmt::format("{} ran over: counted on", plan_.clock->name));
  if (rows_ == 0) first_device_ns_ = device_ns;
  // Before the row joins its group, because all columns grow together.
  device_ns_.push_back(*device_ns);
  return true;
}

bool RowQueue::count(View<double> fields) {
  const double count = fields[plan_.counter->field];
  const CounterStep step = counter_->add(count);
  if (step.is_late) {
    ++late_;
    late_notes_.add(fmt::format("the row with {} = {:.0f} came late, or again: skipped",
                                plan_.counter->name, count),
                    notes_);
    return false;
  }
  if (step.restarted)
    restart_notes_.add(
        fmt::format("{} went to {:.0f}: the device restarted, or many rows are missing",
                    plan_.counter->name, count),
        notes_);
  pending_lost_ += step.lost;
  count_ = count;
  return true;
}

void RowQueue::join_group(std::int64_t host_ns) {
  constexpr std::int64_t longest_ns = 50'000'000;
  const std::uint64_t lost = std::exchange(pending_lost_, 0);
  lost_ += lost;
  const bool joins = !empty() && lost == 0 && host_ns - groups_.back().first_host_ns <= longest_ns;
  if (!joins) groups_.push_back({channels_.front().size(), lost, host_ns, host_ns, count_, count_});
  groups_.back().host_ns = host_ns;
  groups_.back().last_count = count_;
}

bool RowQueue::hand_out(Arrival& arrival) {
  arrival.clear(plan_.columns.size());
  arrival.notes.swap(notes_);
  if (empty()) return false;
  const Group& group = groups_[next_group_++];
  const std::size_t end = empty() ? channels_.front().size() : groups_[next_group_].first;
  const auto copy = [&](const auto& from, auto& to) {
    to.assign(from.begin() + static_cast<std::ptrdiff_t>(group.first),
              from.begin() + static_cast<std::ptrdiff_t>(end));
  };
  for (std::size_t c = 0; c < channels_.size(); ++c) copy(channels_[c], arrival.channels[c]);
  if (clock_) copy(device_ns_, arrival.device_ns);
  arrival.lost_before = group.lost_before;
  if (counter_) {
    arrival.first_count = group.first_count;
    arrival.last_count = group.last_count;
  }
  arrival.host_ns = group.host_ns;
  if (!empty()) return true;
  for (std::vector<double>& channel : channels_) channel.clear();
  device_ns_.clear();
  groups_.clear();
  next_group_ = 0;
  return true;
}

}  // namespace proofmass::acquire
