#include "proofmass/acquire/clock/sample_period.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numeric>

namespace proofmass::acquire {
namespace {

constexpr std::size_t warm = 16;
constexpr std::size_t learns_every = 32;

double median_of(View<double> steps) {
  std::array<double, 64> sorted{};
  const auto end = std::ranges::copy(steps, sorted.begin()).out;
  const auto middle = sorted.begin() + static_cast<std::ptrdiff_t>((steps.size() - 1) / 2);
  std::nth_element(sorted.begin(), middle, end);
  return *middle;
}

double share(View<double> steps, auto is) {
  return static_cast<double>(std::ranges::count_if(steps, is)) / static_cast<double>(steps.size());
}

bool is_single(double step_s, double usual_s) {
  return step_s > 0.5 * usual_s && step_s < 1.5 * usual_s;
}

/// Mean of the intervals within half of it.
double mean_single(View<double> steps, double usual_s) {
  double sum_s = 0.0;
  std::size_t count = 0;
  for (const double step_s : steps) {
    if (!is_single(step_s, usual_s)) continue;
    sum_s += step_s;
    ++count;
  }
  return count > 0 ? sum_s / static_cast<double>(count) : usual_s;
}

/// The mean distance from the nearest multiple.
double deviation_s(View<double> steps, double usual_s) {
  double sum_s = 0.0;
  for (const double step_s : steps)
    sum_s += std::abs(step_s - usual_s * std::max(1.0, std::round(step_s / usual_s)));
  return sum_s / static_cast<double>(steps.size());
}

/// True if most of the time is in intervals much longer than the typical one: rows come in bursts,
/// and these are not holes.
bool is_in_bursts(View<double> steps, double usual_s) {
  constexpr double long_steps = 4.5;
  double long_s = 0.0;
  std::size_t count = 0;
  for (const double step_s : steps) {
    if (step_s < long_steps * usual_s) continue;
    long_s += step_s;
    ++count;
  }
  // A single one may be a hole, once there are enough others to decide.
  return (count > 1 || steps.size() < 2 * warm) &&
         long_s > 0.5 * std::accumulate(steps.begin(), steps.end(), 0.0);
}

/// Boundary between an interval of one row and one of two. Both scatter with an exponentially
/// decaying density (Laplace, mean deviation d); an interval in between is more likely two if
///   step > 1.5 usual + d/2 ln(p1/p2),
/// p1 and p2 their fractions. If these are not determined by the data, p2 is 1e-7.
double longest_single_s(double usual_s, double deviation_s, double skips) {
  constexpr double rare = 1e-7, narrow = 0.1;
  const double p2 = deviation_s < narrow * usual_s ? std::clamp(skips, rare, 0.5) : rare;
  return 1.5 * usual_s + 0.5 * deviation_s * std::log((1.0 - p2) / p2);
}

}  // namespace

View<double> SamplePeriod::recent() const {
  return View<double>(recent_).first(std::min(count_, memory));
}

void SamplePeriod::add(double step_s) {
  if (!(step_s > 0.0)) return;
  recent_[count_ % memory] = step_s;
  ++count_;
  if (std::has_single_bit(count_) || count_ % learns_every == 0) learn();
}

/// The grant is valid if some intervals are as granted: longer ones then skip rows, however many
/// there are.
bool SamplePeriod::is_by_grant() const {
  constexpr double near = 0.25, some = 0.25;
  if (!(granted_s_ > 0.0)) return false;
  return share(recent(), [this](double step_s) {
           return std::abs(step_s - granted_s_) <= near * granted_s_;
         }) >= some;
}

void SamplePeriod::learn() {
  const View<double> steps = recent();
  const bool by_grant = is_by_grant();
  const double about_s = by_grant ? granted_s_ : median_of(steps);
  step_s_ = mean_single(steps, about_s);
  const double deviation = deviation_s(steps, step_s_);
  constexpr double irregular = 0.3, most = 0.55;
  const auto is_one = [this](double step_s) { return is_single(step_s, step_s_); };
  const bool has_usual = by_grant || share(steps, is_one) >= most;
  if (!has_usual || deviation > irregular * step_s_ || is_in_bursts(steps, step_s_))
    return learn_irregular();
  learn_skips();
  longest_s_ = longest_single_s(step_s_, deviation, skips_);
}

/// Estimates the fraction of double intervals, over some hundreds.
void SamplePeriod::learn_skips() {
  constexpr double fading = 1.0 / 16.0;
  const double now = share(recent(), [this](double step_s) {
    return step_s > 1.75 * step_s_ && step_s < 2.25 * step_s_;
  });
  skips_ = count_ <= memory ? now : skips_ + fading * (now - skips_);
}

void SamplePeriod::learn_irregular() {
  const auto longest_of = [](double usual_s) { return std::max(50.0 * usual_s, 1.0); };
  const View<double> steps = recent();
  const double hole_s = longest_of(median_of(steps));
  double sum_s = 0.0, count = 0.0;
  for (const double step_s : steps) {
    if (step_s > hole_s) continue;
    sum_s += step_s;
    ++count;
  }
  step_s_ = sum_s / count;
  longest_s_ = longest_of(step_s_);
}

bool SamplePeriod::is_hole(double step_s) const {
  return count_ >= warm && step_s > longest_s_;
}

}  // namespace proofmass::acquire
