#include "proofmass/signal/encoder.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "proofmass/core/contract.hpp"
#include "proofmass/core/units.hpp"

namespace proofmass::signal {
namespace {

constexpr double no_angle = std::numeric_limits<double>::quiet_NaN();
// Bins of a sixteenth of a turn: motion_at() spreads a step over a twelfth to either side.
constexpr std::size_t slip_spread = 2;
constexpr double per_root_12 = 0.28867513459481287;  // standard deviation of a width of 1

/// Fixes of a small interval of angle and time as one: their weighted means.
struct FixBin {
  double time_s = 0.0, angle_rad = 0.0, weight = 0.0;
};

std::vector<FixBin> binned(const AngleFixes& fixes) {
  constexpr double width_rad = rad_per_turn / 256.0, longest_s = 0.1;
  std::vector<FixBin> bins;
  double start_s = 0.0, start_rad = 0.0;
  for (std::size_t i = 0; i < fixes.time_s.size(); ++i) {
    const double t = fixes.time_s[i], angle = fixes.angle_rad[i];
    if (bins.empty() || std::abs(angle - start_rad) > width_rad || t - start_s > longest_s) {
      bins.emplace_back();
      start_s = t;
      start_rad = angle;
    }
    FixBin& bin = bins.back();
    const double weight = 1.0 / (fixes.std_rad[i] * fixes.std_rad[i]);
    bin.weight += weight;
    bin.time_s += (t - bin.time_s) * weight / bin.weight;
    bin.angle_rad += (angle - bin.angle_rad) * weight / bin.weight;
  }
  return bins;
}

/// Angle, speed and acceleration at a bin.
struct LocalMotion {
  double angle_rad = no_angle, speed_radps = no_angle, accel_radps2 = no_angle;
};

/// Weighted polynomial of fourth degree through the bins [first, last), about the time of bin `at`.
LocalMotion polynomial_at(const std::vector<FixBin>& bins,
                          std::size_t first,
                          std::size_t last,
                          std::size_t at) {
  constexpr Eigen::Index terms = 5;
  const double span_s =
      std::max(bins[last - 1].time_s - bins[at].time_s, bins[at].time_s - bins[first].time_s);
  if (!(span_s > 0.0) || last - first < terms) return {};
  Eigen::Matrix<double, terms, terms> normal = Eigen::Matrix<double, terms, terms>::Zero();
  Eigen::Matrix<double, terms, 1> right = Eigen::Matrix<double, terms, 1>::Zero(), powers;
  for (std::size_t i = first; i < last; ++i) {
    const double x = (bins[i].time_s - bins[at].time_s) / span_s;
    powers << 1.0, x, x * x, x * x * x, x * x * x * x;
    normal += bins[i].weight * powers * powers.transpose();
    right += bins[i].weight * (bins[i].angle_rad - bins[at].angle_rad) * powers;
  }
  const Eigen::LDLT<Eigen::Matrix<double, terms, terms>> solver(normal);
  if (!(solver.rcond() > 1e-9)) return {};
  const Eigen::Matrix<double, terms, 1> c = solver.solve(right);
  return {bins[at].angle_rad + c(0), c(1) / span_s, 2.0 * c(2) / (span_s * span_s)};
}

std::vector<LocalMotion> local_motions(const std::vector<FixBin>& bins, double half_rad) {
  constexpr double half_s = 1.0;
  constexpr std::size_t fewest = 5;  // to either side
  std::vector<LocalMotion> out(bins.size());
  std::size_t first = 0, last = 0;
  for (std::size_t at = 0; at < bins.size(); ++at) {
    const auto inside = [&](std::size_t i) {
      const std::size_t apart = i > at ? i - at : at - i;
      return apart <= fewest || (std::abs(bins[i].angle_rad - bins[at].angle_rad) < half_rad &&
                                 std::abs(bins[i].time_s - bins[at].time_s) < half_s);
    };
    while (first < at && !inside(first)) ++first;
    last = std::max(last, at + 1);
    while (last < bins.size() && inside(last)) ++last;
    out[at] = polynomial_at(bins, first, last, at);
  }
  return out;
}

/// Cubic through values and slopes at both ends. Source: C. de Boor, A Practical Guide to Splines
/// (2001), chapter 4.
double hermite(double part, double span_s, const LocalMotion& a, const LocalMotion& b) {
  const double p2 = part * part, p3 = p2 * part;
  return (2.0 * p3 - 3.0 * p2 + 1.0) * a.angle_rad +
         (p3 - 2.0 * p2 + part) * span_s * a.speed_radps + (3.0 * p2 - 2.0 * p3) * b.angle_rad +
         (p3 - p2) * span_s * b.speed_radps;
}

/// Differences of the means of `width` values after and before each boundary; NaN near the ends.
std::vector<double> differences(const std::vector<double>& values, std::size_t width) {
  std::vector<double> sums(values.size() + 1, 0.0);
  for (std::size_t i = 0; i < values.size(); ++i) sums[i + 1] = sums[i] + values[i];
  std::vector<double> out(values.size(), no_angle);
  for (std::size_t i = width; i + width <= values.size(); ++i)
    out[i] = (sums[i + width] - 2.0 * sums[i] + sums[i - width]) / static_cast<double>(width);
  return out;
}

double scatter_of(const std::vector<double>& differences) {
  std::vector<double> sizes;
  for (const double d : differences)
    if (!std::isnan(d)) sizes.push_back(std::abs(d));
  const auto middle = sizes.begin() + static_cast<std::ptrdiff_t>(sizes.size() / 2);
  std::nth_element(sizes.begin(), middle, sizes.end());
  return 1.4826 * *middle;
}

/// Threshold of |z|, exceeded by chance in a thousandth of all series, with some 3 independent
/// values a width and bin.
double slip_threshold(std::size_t bins) {
  return std::sqrt(2.0 * std::log(3.0 * static_cast<double>(bins) / 1e-3));
}

struct SlipCandidate {
  std::size_t at = 0, width = 0;
  double z = 0.0, difference_rad = 0.0, std_rad = 0.0;
};

constexpr std::size_t narrowest = 4, widest = 256;

/// The most significant step that is a whole number of counts. One that is none hides what overlaps
/// with it, since windows beside it see any part of it.
SlipCandidate strongest(const std::vector<double>& values, double step_rad) {
  std::vector<SlipCandidate> all;
  const double threshold = slip_threshold(values.size());
  for (std::size_t width = narrowest; width <= std::min(widest, values.size() / 6); width *= 2) {
    const std::vector<double> steps = differences(values, width);
    const double std_rad = scatter_of(steps);
    if (!(std_rad > 0.0)) continue;
    for (std::size_t i = 0; i < steps.size(); ++i) {
      const double z = std::abs(steps[i]) / std_rad;
      if (z >= threshold && std::abs(steps[i]) >= 0.5 * step_rad)
        all.push_back({i, width, z, steps[i], std_rad});
    }
  }
  std::ranges::sort(all, std::ranges::greater{}, &SlipCandidate::z);
  std::vector<bool> hidden(values.size(), false);
  for (const SlipCandidate& one : all) {
    if (hidden[one.at]) continue;
    const double counts = one.difference_rad / step_rad;
    if (std::abs(counts - std::round(counts)) * step_rad <= 4.0 * one.std_rad) return one;
    for (std::size_t i = one.at - one.width; i < one.at + one.width; ++i) hidden[i] = true;
  }
  return {};
}

/// The boundary within the window at which a step of this size leaves the least squares, and the
/// range in which they are up to 4 variances more.
CountSlip located(const SlipCandidate& found,
                  const std::vector<double>& values,
                  const std::vector<double>& times,
                  double step_rad) {
  const double size = std::round(found.difference_rad / step_rad) * step_rad;
  const double level = [&] {
    double sum = 0.0;
    for (std::size_t i = found.at - found.width; i < found.at; ++i) sum += values[i];
    return sum / static_cast<double>(found.width);
  }();
  // Variance of one value: that of the difference of two means, times half their width.
  const double variance = found.std_rad * found.std_rad * static_cast<double>(found.width) / 2.0;
  const std::size_t first = found.at - found.width, last = found.at + found.width;
  std::vector<double> costs{0.0};  // of a step before each value, relative to one before the first
  for (std::size_t i = first; i < last; ++i)
    costs.push_back(costs.back() + size * (2.0 * (values[i] - level) - size) / variance);
  const double least = *std::ranges::min_element(costs);
  CountSlip slip{.counts = static_cast<int>(std::lround(found.difference_rad / step_rad))};
  const auto boundary_s = [&](std::size_t i) {
    const std::size_t at = std::clamp<std::size_t>(first + i, 1, times.size() - 1);
    return 0.5 * (times[at - 1] + times[at]);
  };
  std::size_t earliest = costs.size(), latest = 0;
  for (std::size_t i = 0; i < costs.size(); ++i) {
    if (costs[i] == least) slip.time_s = boundary_s(i);
    if (costs[i] > least + 4.0) continue;
    earliest = std::min(earliest, i);
    latest = i;
  }
  slip.start_s = boundary_s(earliest - std::min(earliest, slip_spread));
  slip.end_s = boundary_s(latest + slip_spread);
  return slip;
}

}  // namespace

UnwrappedAngle unwrap_angle(View<double> values, double modulus, double rad_per_unit) {
  UnwrappedAngle out{{values.begin(), values.end()}, 0};
  std::vector<double>& v = out.angle_rad;
  double turns = 0.0, previous = no_angle;
  for (double& value : v) {
    if (std::isnan(value)) continue;
    if (modulus > 0.0 && !std::isnan(previous))
      turns -= std::round((value + turns * modulus - previous) / modulus);
    value += turns * modulus;
    previous = value;
  }
  const std::vector<double> raw = v;
  for (std::size_t k = 1; k + 1 < raw.size(); ++k) {
    const double before = raw[k] - raw[k - 1], after = raw[k] - raw[k + 1];
    const double usual = 0.5 * std::abs(raw[k + 1] - raw[k - 1]) + 2.0;
    if (before * after > 0.0 && std::min(std::abs(before), std::abs(after)) > 5.0 * usual) {
      v[k] = no_angle;
      ++out.glitches;
    }
  }
  for (double& value : v) value *= rad_per_unit;
  return out;
}

AngleFixes fixes_of_samples(View<double> time_s,
                            View<double> angle_rad,
                            double step_rad,
                            double std_rad) {
  PM_EXPECTS(time_s.size() == angle_rad.size());
  constexpr double repeat_s = 0.5;
  AngleFixes out;
  const auto add = [&](double t, double angle, double std) {
    if (!out.time_s.empty() && t <= out.time_s.back()) return;
    out.time_s.push_back(t);
    out.angle_rad.push_back(angle);
    out.std_rad.push_back(std);
  };
  std::size_t previous = 0;
  double fixed_s = -std::numeric_limits<double>::infinity(), edge_s = fixed_s;
  bool any = false;
  for (std::size_t k = 0; k < time_s.size(); ++k) {
    if (std::isnan(angle_rad[k])) continue;
    if (step_rad <= 0.0) {
      add(time_s[k], angle_rad[k], std_rad);
      continue;
    }
    const double counts = any ? std::round((angle_rad[k] - angle_rad[previous]) / step_rad) : 0.0;
    const double dt = any ? time_s[k] - time_s[previous] : 0.0;
    if (std::abs(counts) == 1.0) {
      const double edge = std::max(angle_rad[k], angle_rad[previous]);
      const double since_s = std::max(time_s[k] - edge_s, dt);
      const double speed = step_rad / since_s;
      add(time_s[k] - 0.5 * dt, edge, std::max(speed * dt * per_root_12, 1e-3 * step_rad));
    } else if (counts != 0.0) {
      add(time_s[k] - 0.5 * dt, 0.5 * (angle_rad[k] + angle_rad[previous] + step_rad),
          step_rad * per_root_12);
    } else if (time_s[k] - fixed_s > repeat_s) {
      add(time_s[k], angle_rad[k] + 0.5 * step_rad, step_rad * per_root_12);
      fixed_s = time_s[k];
    }
    if (counts != 0.0) fixed_s = edge_s = time_s[k];
    any = true;
    previous = k;
  }
  return out;
}

AngleFixes fixes_of_edges(View<double> time_s,
                          View<double> angle_rad,
                          double step_rad,
                          double stamp_std_s) {
  PM_EXPECTS(time_s.size() == angle_rad.size());
  AngleFixes out;
  for (std::size_t k = 1; k < time_s.size(); ++k) {
    const double moved = angle_rad[k] - angle_rad[k - 1], dt = time_s[k] - time_s[k - 1];
    if (std::isnan(moved) || !(dt > 0.0) || moved == 0.0) continue;
    out.time_s.push_back(time_s[k]);
    out.angle_rad.push_back(moved > 0.0 ? angle_rad[k] : angle_rad[k] + step_rad);
    out.std_rad.push_back(std::hypot(std::abs(moved) / dt * stamp_std_s, 1e-3 * step_rad));
  }
  return out;
}

AngleMotion motion_at(const AngleFixes& fixes, View<double> time_s, double half_rad) {
  AngleMotion out;
  for (auto* column : {&out.angle_rad, &out.speed_radps, &out.accel_radps2})
    column->assign(time_s.size(), no_angle);
  const std::vector<FixBin> bins = binned(fixes);
  if (bins.size() < 4) return out;
  const std::vector<LocalMotion> curves = local_motions(bins, half_rad);
  std::size_t at = 0;
  for (std::size_t k = 0; k < time_s.size(); ++k) {
    const double t = time_s[k];
    while (at + 2 < bins.size() && bins[at + 1].time_s <= t) ++at;
    if (t < bins[at].time_s || t > bins[at + 1].time_s) continue;
    const double span_s = bins[at + 1].time_s - bins[at].time_s;
    const double part = (t - bins[at].time_s) / span_s;
    out.angle_rad[k] = hermite(part, span_s, curves[at], curves[at + 1]);
    out.speed_radps[k] = std::lerp(curves[at].speed_radps, curves[at + 1].speed_radps, part);
    out.accel_radps2[k] = std::lerp(curves[at].accel_radps2, curves[at + 1].accel_radps2, part);
  }
  return out;
}

std::vector<CountSlip> find_count_slips(View<double> time_s,
                                        View<double> offset_rad,
                                        double step_rad) {
  PM_EXPECTS(time_s.size() == offset_rad.size());
  std::vector<double> times, values;
  for (std::size_t i = 0; i < offset_rad.size(); ++i) {
    if (std::isnan(offset_rad[i])) continue;
    times.push_back(time_s[i]);
    values.push_back(offset_rad[i]);
  }
  std::vector<CountSlip> out;
  if (!(step_rad > 0.0) || values.size() < 6 * narrowest) return out;
  constexpr std::size_t most = 200;
  while (out.size() < most) {
    const SlipCandidate found = strongest(values, step_rad);
    if (found.z < slip_threshold(values.size())) break;
    const CountSlip slip = located(found, values, times, step_rad);
    if (slip.counts == 0) break;
    for (std::size_t i = 0; i < values.size(); ++i)
      if (times[i] > slip.time_s) values[i] -= slip.counts * step_rad;
    out.push_back(slip);
  }
  std::ranges::sort(out, {}, &CountSlip::time_s);
  return out;
}

bool relocate_slips(View<double> time_s,
                    View<double> residual_rad,
                    double step_rad,
                    std::vector<CountSlip>& slips) {
  PM_EXPECTS(time_s.size() == residual_rad.size());
  constexpr std::size_t reach = 24;  // a turn and a half of sixteenths
  std::vector<double> times, r;
  for (std::size_t i = 0; i < residual_rad.size(); ++i) {
    if (std::isnan(residual_rad[i])) continue;
    times.push_back(time_s[i]);
    r.push_back(residual_rad[i]);
  }
  if (r.size() < 2) return false;
  const double variance = std::pow(scatter_of(r), 2);
  bool any_moved = false;
  for (CountSlip& slip : slips) {
    const double size = slip.counts * step_rad;
    const auto now =
        static_cast<std::size_t>(std::ranges::upper_bound(times, slip.time_s) - times.begin());
    const std::size_t first = std::max<std::size_t>(1, now - std::min(now, reach));
    const std::size_t last = std::min(now + reach, r.size() - 1);
    if (now < first || now > last) continue;
    // Sum of squares with the boundary before each bin, less that with it where it is now.
    std::vector<double> costs(last - first + 1, 0.0);
    for (std::size_t j = now; j-- > first;)
      costs[j - first] = costs[j + 1 - first] + size * (size - 2.0 * r[j]);
    for (std::size_t j = now + 1; j <= last; ++j)
      costs[j - first] = costs[j - 1 - first] + size * (size + 2.0 * r[j - 1]);
    const auto least = std::ranges::min_element(costs);
    const std::size_t to = first + static_cast<std::size_t>(least - costs.begin());
    const auto alike = [&](double cost) { return cost <= *least + 4.0 * variance; };
    const auto earliest = std::ranges::find_if(costs, alike) - costs.begin();
    const auto after = std::find_if(costs.rbegin(), costs.rend(), alike) - costs.rbegin();
    const std::size_t latest = last - static_cast<std::size_t>(after);
    slip.time_s = 0.5 * (times[to - 1] + times[to]);
    const std::size_t before = first + static_cast<std::size_t>(earliest);
    slip.start_s = times[before - std::min(before, slip_spread)];
    slip.end_s = times[std::min(latest + slip_spread - 1, times.size() - 1)];
    for (std::size_t j = to; j < now; ++j) r[j] -= size;
    for (std::size_t j = now; j < to; ++j) r[j] += size;
    any_moved = any_moved || to != now;
  }
  return any_moved;
}

std::optional<int> detectable_counts(View<double> offset_rad, double step_rad) {
  std::vector<double> values;
  for (const double offset : offset_rad)
    if (!std::isnan(offset)) values.push_back(offset);
  if (!(step_rad > 0.0) || values.size() < 6 * narrowest) return std::nullopt;
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t width = narrowest; width <= std::min(widest, values.size() / 6); width *= 2)
    least = std::min(least, scatter_of(differences(values, width)));
  return static_cast<int>(
      std::max(1.0, std::ceil(least * slip_threshold(values.size()) / step_rad)));
}

void remove_slips(View<CountSlip> slips, double step_rad, AngleFixes& fixes) {
  for (const CountSlip& slip : slips)
    for (std::size_t i = 0; i < fixes.time_s.size(); ++i)
      if (fixes.time_s[i] > slip.time_s) fixes.angle_rad[i] -= slip.counts * step_rad;
}

}  // namespace proofmass::signal
