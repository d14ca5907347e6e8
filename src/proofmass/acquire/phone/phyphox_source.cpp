#include "proofmass/acquire/phone/phyphox_source.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <thread>

#include "proofmass/acquire/phone/advice.hpp"
#include "proofmass/acquire/stream/host_text.hpp"

namespace proofmass::acquire {
namespace {

using std::chrono::milliseconds;

constexpr milliseconds between_questions{50};
/// After this time without rows during a measurement, the ends of the time buffers are requested.
constexpr milliseconds suspicious_silence{500};
constexpr int most_bad_answers = 5;

std::vector<std::size_t> widths_of(const std::vector<PhyphoxGroup>& groups) {
  std::vector<std::size_t> widths;
  for (const PhyphoxGroup& group : groups) widths.push_back(group.buffers.size());
  return widths;
}

}  // namespace

PhyphoxSource::PhyphoxSource(std::unique_ptr<HttpClient> client,
                             PhyphoxStart start,
                             SourceHead head)
    : client_(std::move(client)),
      start_(std::move(start)),
      head_(std::move(head)),
      merge_(widths_of(start_.groups)) {
  for (const PhyphoxGroup& group : start_.groups) {
    ends_target_ += (times_.empty() ? "/get?" : "&") + query_text(group.time);
    times_.push_back(group.time);
    names_.push_back(group.time);
    names_.insert(names_.end(), group.buffers.begin(), group.buffers.end());
  }
  last_rows_ = Clock::now();
}

/// Sends the next request when it is due and takes the next response; false if none arrives by
/// then.
Result<bool> PhyphoxSource::take_next(Clock::time_point until) {
  if (!client_->is_waiting()) {
    std::this_thread::sleep_until(std::min(next_question_, until));
    if (Clock::now() < next_question_) return false;
    ask();
  }
  const auto left = std::chrono::ceil<milliseconds>(until - Clock::now());
  const auto answer = client_->answer(std::max(left, milliseconds(0)));
  if (!answer) return phyphox_gone(answer.error());
  if (!*answer) return false;
  if (const Status taken = take(**answer); !taken) return taken.error();
  return true;
}

Result<Arrived> PhyphoxSource::read(Arrival& arrival, milliseconds patience) {
  arrival.clear(head_.recording.channels.size());
  const auto until = Clock::now() + patience;
  do {
    const auto taken = take_next(until);
    if (!taken) return taken.error();
    if (!*taken) break;
    if (!is_behind_) merge_.take(arrival);
  } while (arrival.rows() == 0 && Clock::now() < until);
  for (Note& note : merge_.take_notes()) notes_.push_back(std::move(note));
  arrival.host_ns = host_now_ns();
  arrival.notes.swap(notes_);
  return arrival.rows() > 0 ? Arrived::rows : Arrived::nothing;
}

void PhyphoxSource::ask() {
  const auto now = Clock::now();
  next_question_ = now + between_questions;
  asks_ends_ = was_measuring_ && now - last_rows_ > suspicious_silence && !asks_ends_;
  if (asks_ends_) return client_->ask(ends_target_);
  is_searching_ = std::ranges::any_of(start_.cursors, &PhyphoxCursor::is_searching);
  std::string target = "/get";
  for (std::size_t k = 0; k < start_.groups.size(); ++k) {
    const PhyphoxGroup& group = start_.groups[k];
    const std::string time = query_text(group.time), from = start_.cursors[k].threshold();
    // For a full request the phone accepts no reference buffer.
    const std::string after = from == "full" ? from : from + "%7C" + time;
    target += fmt::format("{}{}={}", k == 0 ? '?' : '&', time, from);
    for (const std::string& buffer : group.buffers)
      target += fmt::format("&{}={}", query_text(buffer), after);
  }
  client_->ask(std::move(target));
}

Status PhyphoxSource::take(const HttpAnswer& answer) {
  if (answer.status != 200) return take_bad(fmt::format("status {}", answer.status));
  if (const Status read = parse_phyphox_reply(answer.body, asks_ends_ ? times_ : names_, reply_);
      !read)
    return take_bad(read.error().message);
  bad_answers_ = 0;
  if (const Status same = take_session(reply_); !same) return same;
  asks_ends_ ? take_ends(reply_) : take_rows(reply_);
  // A long response took long to transfer: the next one shows when the last row was available.
  is_behind_ = is_searching_ && !asks_ends_ && !is_behind_;
  if (is_behind_) next_question_ = Clock::now();
  return Done{};
}

Status PhyphoxSource::take_bad(std::string why) {
  if (++bad_answers_ >= most_bad_answers)
    return phyphox_gone({Errc::device, fmt::format("{} consecutive invalid responses, the last: {}",
                                                   bad_answers_, why)});
  report(Severity::warning, fmt::format("phyphox: invalid response, retrying: {}", why));
  return Done{};
}

Status PhyphoxSource::take_session(const PhyphoxReply& reply) {
  const auto missing = std::ranges::find(reply.is_there, false);
  if (missing != reply.is_there.end())
    return Error{
        Errc::device,
        fmt::format(
            "the buffer {} is no longer there: another experiment was opened on the phone",
            (asks_ends_ ? times_
                        : names_)[static_cast<std::size_t>(missing - reply.is_there.begin())])};
  if (reply.session != start_.session) {
    start_.session = reply.session;
    report(Severity::warning,
           "phyphox: the experiment was reopened on the phone, its clock restarts");
    for (PhyphoxCursor& cursor : start_.cursors) cursor.start_anew();
  }
  if (reply.measuring != was_measuring_)
    report(Severity::warning, reply.measuring ? "phyphox: the measurement goes on"
                                              : "phyphox: the measurement was paused on the phone");
  was_measuring_ = reply.measuring;
  return Done{};
}

void PhyphoxSource::take_ends(const PhyphoxReply& reply) {
  for (std::size_t k = 0; k < start_.cursors.size(); ++k) {
    const auto& end = reply.buffers[k];
    const bool is_empty = end.empty() || !std::isfinite(end.back());
    is_empty ? start_.cursors[k].start_anew() : start_.cursors[k].see_end(end.back());
  }
}

void PhyphoxSource::take_rows(PhyphoxReply& reply) {
  std::vector<double>* columns = reply.buffers.data();
  for (std::size_t k = 0; k < start_.groups.size(); ++k) {
    take_group(k, columns);
    columns += 1 + start_.groups[k].buffers.size();
  }
}

void PhyphoxSource::take_group(std::size_t group, std::vector<double>* columns) {
  const std::size_t width = start_.groups[group].buffers.size();
  if (level_buffers({columns, 1 + width}) > 0 && !std::exchange(noted_timeless_, true))
    report(Severity::warning, fmt::format("phyphox: {} has rows without a time, which are skipped",
                                          start_.groups[group].time));
  const std::vector<double>& times_s = columns[0];
  const auto [first, end] = start_.cursors[group].take({columns, 1 + width});
  row_.resize(width);
  for (std::size_t k = first; k < end; ++k) {
    for (std::size_t c = 0; c < width; ++c) row_[c] = columns[1 + c][k];
    merge_.add(group, std::llround(times_s[k] * ns_per_s), row_);
  }
  if (first < end) last_rows_ = Clock::now();
}

}  // namespace proofmass::acquire
