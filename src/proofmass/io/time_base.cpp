#include "proofmass/io/time_base.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <fmt/format.h>

#include "proofmass/io/stamps.hpp"
#include "proofmass/io/wording.hpp"

namespace proofmass::io {
namespace {

/// Seconds from a figure in `unit_s`: divided where the unit is a decimal fraction, so that 8333 µs
/// is the double that "0.008333" is.
double in_seconds(double figure, double unit_s) {
  return unit_s < 1.0 ? figure / std::round(1.0 / unit_s) : figure * unit_s;
}

struct GuessedUnit {
  std::string_view symbol;
  std::string_view why;
};

/// The unit that makes the first stamp an epoch of this century at a plausible rate, else the one
/// whose rate is nearest 100 Hz in ratio.
GuessedUnit guess_unit(const StampColumn& stamps, double step) {
  struct Candidate {
    std::string_view symbol;
    double unit_s;
  };
  constexpr std::array<Candidate, 4> candidates{
      {{"s", 1.0}, {"ms", 1e-3}, {"us", 1e-6}, {"ns", 1e-9}}};
  constexpr double year_2000_s = 946'684'800.0;
  constexpr double year_2100_s = 4'102'444'800.0;
  const double first = stamps.origin.value();
  for (const auto& [symbol, unit_s] : candidates) {
    const double rate_hz = 1.0 / (step * unit_s);
    const double epoch_s = first * unit_s;
    if (epoch_s > year_2000_s && epoch_s < year_2100_s && rate_hz > 0.01 && rate_hz < 1e5)
      return {symbol, "the first stamp is a date of this century in it"};
  }
  const auto distance = [&](const Candidate& candidate) {
    return std::abs(std::log10(1.0 / (step * candidate.unit_s)) - 2.0);
  };
  const auto best = std::ranges::min_element(candidates, {}, distance);
  return {best->symbol, "of s, ms, us, ns it gives the rate nearest to 100 Hz"};
}

/// Xsens' SampleTimeFine: microseconds in the DOT, ticks of 100 µs in the MTi.
/// Source: Xsens DOT user manual, "SampleTimeFine"; MT low level communication protocol.
std::optional<double> xsens_unit_s(const StampColumn& stamps, double step) {
  if (stamps.name != "SampleTimeFine") return std::nullopt;
  return step > 400.0 ? 1e-6 : 1e-4;
}

double unit_of_stamps_s(const StampColumn& stamps, double step, std::vector<Note>& notes) {
  if (stamps.unit.quantity == Quantity::time) return stamps.unit.to_si;
  if (const auto unit_s = xsens_unit_s(stamps, step)) {
    notes.push_back({Severity::info, fmt::format("{}: in steps of {} us, as Xsens units write it",
                                                 stamps.name, in_words(*unit_s * 1e6))});
    return *unit_s;
  }
  const GuessedUnit guess = guess_unit(stamps, step);
  const double unit_s = parse_unit(guess.symbol)->to_si;
  notes.push_back(
      {Severity::info, fmt::format("{}: unit taken to be {} ({} Hz), as {}", stamps.name,
                                   guess.symbol, in_words(1.0 / (step * unit_s)), guess.why)});
  return unit_s;
}

void tell_mended(const MendedStamps& mended,
                 const TimeEvidence& evidence,
                 std::vector<Note>& notes) {
  if (mended.samples.empty()) return;
  const std::size_t count = mended.samples.size();
  std::string how = "set evenly between their neighbours";
  if (mended.by_counter == count)
    how = fmt::format("set from {}", evidence.counter_name);
  else if (mended.by_counter > 0)
    how = fmt::format("{} set from {}, the others evenly between their neighbours",
                      mended.by_counter, evidence.counter_name);
  notes.push_back({Severity::warning,
                   fmt::format("{}: {} no usable stamp ({}): {}", evidence.stamps->name,
                               count == 1 ? "1 sample has" : fmt::format("{} samples have", count),
                               places(mended.samples, evidence.first_line), how)});
}

void tell_rate_conflict(double rate_hz, const TimeEvidence& evidence, std::vector<Note>& notes) {
  if (!evidence.header_rate_hz || rate_hz <= 0.0) return;
  const double ratio = rate_hz / *evidence.header_rate_hz;
  if (std::abs(ratio - 1.0) < 0.05) return;
  notes.push_back(
      {Severity::warning,
       fmt::format("{}: the stamps say {} Hz, the file's preamble {} Hz: one of them is "
                   "wrong; the stamps are used, --rate overrides",
                   evidence.stamps->name, in_words(rate_hz), in_words(*evidence.header_rate_hz))});
}

/// Rate by the steps of stamps in units of `unit_s`.
double rate_of(const StampSteps& steps,
               View<double> stamps,
               double unit_s,
               std::vector<Note>& notes) {
  if (steps.repeated > 0.5 && stamps.back() > stamps.front()) {
    notes.push_back({Severity::warning,
                     fmt::format("{:.0f} % of the stamps repeat the one before (sent in bursts): "
                                 "the rate is the number of samples over the duration",
                                 100.0 * steps.repeated)});
    return static_cast<double>(stamps.size() - 1) /
           in_seconds(stamps.back() - stamps.front(), unit_s);
  }
  return 1.0 / in_seconds(steps.rounding > 0.0 ? steps.mean_near : steps.median, unit_s);
}

/// Unrolls and mends the stamps where they need it; returns their steps.
StampSteps repair(TimeEvidence& evidence, const StampSteps& rough, TimeBaseFound& found) {
  StampColumn& stamps = *evidence.stamps;
  if (are_regular(stamps.values, rough.median)) return rough;
  if (const auto turns = unroll(stamps.values, stamps.origin.value(), rough.median); turns > 0)
    found.notes.push_back(
        {Severity::info, fmt::format("{}: counter ran over {}", stamps.name, times(turns))});
  const MendedStamps mended = mend(stamps.values, rough.median, evidence.counter);
  tell_mended(mended, evidence, found.notes);
  found.base.mended = mended.samples.size();
  found.base.mended_backwards = mended.backwards;
  const StampSteps repaired = measure_steps(stamps.values);
  return repaired.median > 0.0 ? repaired : rough;
}

/// Repairs and scales the stamps, and takes the base from them.
void use_stamps(TimeEvidence& evidence, const StampSteps& rough, TimeBaseFound& found) {
  StampColumn& stamps = *evidence.stamps;
  const double unit_s = unit_of_stamps_s(stamps, rough.median, found.notes);
  const StampSteps steps = repair(evidence, rough, found);
  TimeBase& base = found.base;
  base.source = TimeSource::stamps;
  base.channel = stamps.name;
  base.rate_hz = rate_of(steps, stamps.values, unit_s, found.notes);
  const double first = stamps.values.front();
  base.start_ns = stamps.origin.ns(unit_s);
  if (base.start_ns && first != 0.0) *base.start_ns += std::llround(first * unit_s * 1e9);
  base.stamps_s = std::move(stamps.values);
  if (first != 0.0 || unit_s != 1.0)
    for (double& stamp : base.stamps_s) stamp = in_seconds(stamp - first, unit_s);
  tell_rate_conflict(base.rate_hz, evidence, found.notes);
  if (const double rate_hz = uniform_rate_hz(base.stamps_s); rate_hz > 0.0) {
    base.rate_hz = rate_hz;
    std::vector<double>().swap(base.stamps_s);
  }
}

/// Whether the counter goes up by one nearly always and never back: then it says which are lost.
bool counts_samples(View<double> counter) {
  if (counter.size() < 2) return false;
  std::size_t ones = 0;
  for (std::size_t k = 1; k < counter.size(); ++k) {
    const double step = counter[k] - counter[k - 1];
    const bool is_usual = step >= 1.0 && step < 1e6;
    if (!is_usual) return false;
    if (step == 1.0) ++ones;
  }
  return ones * 10 >= (counter.size() - 1) * 9 && ones < counter.size() - 1;
}

void use_rate(const TimeEvidence& evidence, double rate_hz, TimeBaseFound& found) {
  found.base.rate_hz = rate_hz;
  found.base.source = TimeSource::given_rate;
  if (!counts_samples(evidence.counter)) return;
  found.base.source = TimeSource::counter;
  found.base.channel = evidence.counter_name;
  found.base.stamps_s.reserve(evidence.counter.size());
  for (const double count : evidence.counter)
    found.base.stamps_s.push_back((count - evidence.counter.front()) / rate_hz);
  found.notes.push_back(
      {Severity::info, fmt::format("samples placed by {}, which shows where rows are missing",
                                   evidence.counter_name)});
}

}  // namespace

TimeBaseFound find_time_base(TimeEvidence evidence, const ReadOptions& options) {
  TimeBaseFound found;
  if (options.rate_hz) {
    use_rate(evidence, *options.rate_hz, found);
    if (evidence.stamps)
      found.notes.push_back(
          {Severity::info,
           fmt::format("{}: its stamps are not used, as a rate was given", evidence.stamps->name)});
    return found;
  }
  if (evidence.stamps) {
    const StampSteps steps = measure_steps(evidence.stamps->values);
    const bool is_count = !evidence.stamps->is_named && steps.median == 1.0;
    // No clock has steps beyond these, in whatever unit.
    const bool is_step = steps.median > 1e-12 && steps.median < 1e15;
    if (is_step && steps.ascending >= 0.8 && !is_count) {
      use_stamps(evidence, steps, found);
      return found;
    }
    found.notes.push_back(
        {Severity::warning, fmt::format("{}: is no time base, as it {}", evidence.stamps->name,
                                        is_count ? "counts in ones" : "does not ascend")});
    found.rejected = std::move(evidence.stamps);
  }
  if (evidence.header_rate_hz) {
    use_rate(evidence, *evidence.header_rate_hz, found);
    found.notes.push_back({Severity::info, fmt::format("rate of {} Hz, as the file says",
                                                       in_words(*evidence.header_rate_hz))});
  } else if (evidence.samples > 1) {
    found.notes.push_back(
        {Severity::warning, "no time column and no rate: samples are numbered; give --rate HZ"});
  }
  return found;
}

}  // namespace proofmass::io
