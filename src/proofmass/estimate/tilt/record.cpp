#include "proofmass/estimate/tilt/record.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>

#include "proofmass/core/statistics.hpp"
#include "proofmass/estimate/wheel/plane.hpp"

namespace proofmass::estimate {
namespace {

constexpr double still_share = 0.9;
constexpr std::size_t fewest_moving = 50;

Status check_lengths(const TiltRecord& record, std::size_t& samples) {
  const auto& axes = record.accel_mps2;
  const auto first = std::ranges::find_if(axes, [](const auto& axis) { return !axis.empty(); });
  if (first == axes.end()) return Error{Errc::invalid_argument, "no accelerometer axis"};
  samples = first->size();
  const auto fits = [&](const auto& values) { return values.empty() || values.size() == samples; };
  if (!std::ranges::all_of(axes, fits) || !std::ranges::all_of(record.rate_radps, fits) ||
      !fits(record.time_s))
    return Error{Errc::invalid_argument, "channels of different length"};
  for (std::size_t k = 0; k < record.time_s.size(); ++k)
    if (!std::isfinite(record.time_s[k]) || (k > 0 && record.time_s[k] < record.time_s[k - 1]))
      return Error{Errc::invalid_argument,
                   "time must ascend, but does not at sample " + std::to_string(k)};
  return Done{};
}

// Rejects a median norm that is impossible for the force on a body under gravity.
Status check_force(const TiltRecord& record, const TiltOptions& options, TiltSolution& solution) {
  std::vector<double> norms;
  for (std::size_t k = 0; k < solution.samples; ++k) {
    const Mat<3> f = vector_at(record.accel_mps2, k);
    const auto present = static_cast<std::size_t>(f.array().isFinite().count());
    if (present < solution.axes)
      ++solution.unusable;
    else
      norms.push_back(f.norm());
  }
  if (norms.empty()) return Error{Errc::too_few_samples, "no sample has a value on every axis"};
  if (solution.axes < 3) return Done{};
  const double usual = *median(norms), g = options.gravity_mps2.value;
  if (usual < 0.5 * g || usual > 2.0 * g)
    return Error{Errc::not_observable,
                 "the force has a median of " + decimal(usual) + " m/s² where gravity is " +
                     decimal(g) +
                     (usual < g ? ": gravity was removed from it, or its unit is another"
                                : ": its unit is another, or it needs a calibration")};
  return Done{};
}

void note_unusable(TiltSolution& solution) {
  if (solution.unusable == 0) return;
  solution.notes.push_back({Severity::warning, std::to_string(solution.unusable) + " of " +
                                                   std::to_string(solution.samples) +
                                                   " samples lack a value on some axis"});
}

std::size_t count_beyond(double most, const std::array<std::vector<double>, 3>& axes) {
  std::ptrdiff_t count = 0;
  for (const std::vector<double>& axis : axes)
    count += std::ranges::count_if(axis, [most](double value) { return std::abs(value) > most; });
  return static_cast<std::size_t>(count);
}

void drop_beyond(double most, std::array<std::vector<double>, 3>& axes) {
  for (std::vector<double>& axis : axes)
    for (double& value : axis)
      if (std::abs(value) > most) value = no_value;
}

}  // namespace

std::optional<TiltRecord> without_unusable(const TiltRecord& record, std::vector<Note>& notes) {
  const std::size_t forces = count_beyond(beyond_belief_mps2, record.accel_mps2);
  const std::size_t count = forces + count_beyond(beyond_belief_radps, record.rate_radps);
  // A majority means a wrong unit.
  const bool most = 2 * forces > record.accel_mps2[0].size();
  if (count == 0 || most) return std::nullopt;
  TiltRecord out = record;
  drop_beyond(beyond_belief_mps2, out.accel_mps2);
  drop_beyond(beyond_belief_radps, out.rate_radps);
  notes.push_back({Severity::warning, std::to_string(count) +
                                          (count == 1 ? " reading is" : " readings are") +
                                          " beyond 1000 g or 10000 rad/s and not used"});
  return out;
}

std::string decimal(double value, int decimals) {
  char text[32];
  // Implausible values are not written out digit by digit.
  constexpr double longest = 1e7;
  const auto format =
      std::abs(value) < longest ? std::chars_format::fixed : std::chars_format::scientific;
  const auto end = std::to_chars(text, text + sizeof text, value, format, decimals);
  return end.ec == std::errc() ? std::string(text, end.ptr) : std::to_string(value);
}

bool has_rates(const TiltRecord& record) {
  return std::ranges::all_of(record.rate_radps, [](const auto& axis) { return !axis.empty(); });
}

Mat<3> vector_at(const std::array<std::vector<double>, 3>& axes, std::size_t k) {
  Mat<3> out = Mat<3>::Constant(std::numeric_limits<double>::quiet_NaN());
  for (std::size_t i = 0; i < 3; ++i)
    if (!axes[i].empty() && std::isfinite(axes[i][k]))
      out(static_cast<Eigen::Index>(i)) = axes[i][k];
  return out;
}

Status check_record(const TiltRecord& record, const TiltOptions& options, TiltSolution& solution) {
  if (Status fits = check_lengths(record, solution.samples); !fits) return fits;
  for (const auto& axis : record.accel_mps2)
    if (!axis.empty()) ++solution.axes;
  if (Status force = check_force(record, options, solution); !force) return force;
  note_unusable(solution);
  return Done{};
}

Result<bool> is_moving(const TiltRecord& record,
                       const TiltOptions& options,
                       const signal::RestSearch& found,
                       const TiltSolution& solution) {
  std::size_t resting = 0;
  for (const signal::Rest& rest : found.rests) resting += rest.last - rest.first + 1;
  const bool mostly =
      static_cast<double>(resting) >= still_share * static_cast<double>(solution.samples);
  const bool timed = record.time_s.size() > 1;
  if (options.base == TiltBase::still || (options.base == TiltBase::automatic && mostly))
    return false;
  const bool can_follow = timed && solution.axes == 3;
  if (options.base == TiltBase::automatic && !can_follow && !found.rests.empty()) return false;
  if (!timed)
    return Error{Errc::not_observable, "a moving base needs time: give a time column or the rate"};
  if (solution.axes < 3)
    return Error{Errc::not_observable,
                 "a moving base needs three axes, not " + std::to_string(solution.axes) +
                     "; if it is still, state it",
                 {Advice{"base", "still"}}};
  if (solution.samples < solution.unusable + fewest_moving)
    return Error{Errc::too_few_samples, "a moving base needs at least 50 measurements"};
  return true;
}

}  // namespace proofmass::estimate
