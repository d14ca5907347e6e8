#include "proofmass/acquire/recorder/tally.hpp"

#include <fmt/format.h>

namespace proofmass::acquire {
namespace {

bool is_gap(EventKind kind) {
  return kind == EventKind::lost || kind == EventKind::overrun || kind == EventKind::gap;
}

}  // namespace

bool RecordTally::add(const RecordEvent& event) {
  constexpr std::size_t most_listed = 10'000;
  auto& list = is_gap(event.kind) ? summary.gaps : summary.events;
  if (is_gap(event.kind)) {
    ++summary.gap_count;
    summary.lost += event.rows;
  }
  if (event.kind == EventKind::overrun) summary.overrun += event.rows;
  if (list.size() >= most_listed) return false;
  list.push_back(event);
  return true;
}

void RecordTally::add_arrival(const TimeLine& line, const SourceHead& head, std::int64_t host_ns) {
  if (!head.is_paced) return;
  const double host_s = line.host_s(host_ns);
  const double rate_hz = head.recording.time.rate_hz;
  const bool has_clock = head.has_device_clock || rate_hz > 0.0;
  if (has_clock) time_fit_.add(line.last_s(), host_s);
  // The rows' own clock, at approximately their rate.
  constexpr std::uint64_t enough_rows = 64;
  if (nominal_hz_ == 0.0 && rate_hz > 0.0) nominal_hz_ = rate_hz;
  if (nominal_hz_ == 0.0 && line.rows() > enough_rows && line.step_s() > 0.0)
    nominal_hz_ = 1.0 / line.step_s();
  if (nominal_hz_ > 0.0) rows_fit_.add(static_cast<double>(line.rows()) / nominal_hz_, host_s);
}

void RecordTally::report_clock() {
  summary.clock.rate_error = time_fit_.rate_error();
  summary.clock.rate_hz.reset();
  const auto rows_error = rows_fit_.rate_error();
  if (!rows_error) return;
  const double stretch = 1.0 + rows_error->value;
  summary.clock.rate_hz =
      Uncertain{nominal_hz_ / stretch, nominal_hz_ * rows_error->std / (stretch * stretch)};
}

RecordWords RecordTally::words() const {
  RecordWords out{{"lost", std::to_string(summary.lost)},
                  {"overrun", std::to_string(summary.overrun)},
                  {"gaps", std::to_string(summary.gap_count)},
                  {"not_kept", std::to_string(summary.not_kept)}};
  const auto put = [&](const char* name, const std::optional<Uncertain>& figure) {
    if (!figure) return;
    out[name] = fmt::format("{:.12g}", figure->value);
    out[std::string(name) + "_std"] = fmt::format("{:.3g}", figure->std);
  };
  put("clock_rate_error", summary.clock.rate_error);
  put("host_rate_hz", summary.clock.rate_hz);
  if (!summary.end_reason.empty()) out["end_reason"] = summary.end_reason;
  return out;
}

}  // namespace proofmass::acquire
