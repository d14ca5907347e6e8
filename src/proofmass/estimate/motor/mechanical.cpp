#include "proofmass/estimate/motor/mechanical.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

#include "proofmass/estimate/motor/angle_errors.hpp"

namespace proofmass::estimate::motor {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr Index always = stribeck;  // unknowns before the two of the Stribeck curve

// Samples that are used, and where a motion begins.
struct Rows {
  std::vector<std::size_t> samples, starts;
};

Rows moving_rows(const Motion& motion, double least_radps) {
  std::vector<std::int8_t> contact = motion.contact;
  for (std::size_t k = 0; k < contact.size(); ++k)
    if (std::abs(motion.speed_radps[k]) < least_radps) contact[k] = 0;
  if (least_radps > motion.rest_radps) shorten_runs(contact, motion.half_window + 1);
  Rows rows;
  for (std::size_t k = 0; k < contact.size(); ++k) {
    if (contact[k] == 0) continue;
    if (k == 0 || contact[k - 1] != contact[k]) rows.starts.push_back(rows.samples.size());
    rows.samples.push_back(k);
  }
  return rows;
}

// Each motion costs a row for its constant.
Status check(const Rows& rows) {
  constexpr std::size_t least = 100;
  if (rows.samples.size() >= rows.starts.size() + least) return Done{};
  return Error{Errc::not_observable, "the load moves too briefly: nothing shows the drive"};
}

/// The regression without the columns of the Stribeck curve, which depend on its speed.
class Equation {
 public:
  using Column = std::vector<double>;

  Equation(const Series& series, const Motion& motion) : series_(series), motion_(motion) {
    Column one, angle_cos, angle_sin, direction;
    for (std::size_t k = 0; k < series.size(); ++k) {
      one.push_back(-1.0);
      angle_cos.push_back(-std::cos(motion.angle_rad[k]));
      angle_sin.push_back(-std::sin(motion.angle_rad[k]));
      direction.push_back(-sign(k));
    }
    columns_.resize(always);
    columns_[coulomb] = integral(direction, series.step_s);
    columns_[load_torque] = integral(one, series.step_s);
    columns_[unbalance_cos] = integral(angle_cos, series.step_s);
    columns_[unbalance_sin] = integral(angle_sin, series.step_s);
  }

  void set(Index unknown, Column column) {
    columns_[static_cast<std::size_t>(unknown)] = std::move(column);
  }
  void set_target(Column target) { target_ = std::move(target); }
  /// Nuisances of an angle as the target.
  void set_errors(const AngleErrors* errors) { errors_ = errors; }
  [[nodiscard]] Index errors() const { return errors_ == nullptr ? 0 : errors_->count(); }

  /// Order of the unknowns: Mechanical as far as it is used, then the errors. `excess` is the
  /// current estimate of the Stribeck coefficient, for the derivative by the logarithm of its
  /// speed.
  [[nodiscard]] LevelRegression regression(const Rows& rows,
                                           double stribeck_radps,
                                           const std::optional<double>& excess) const {
    const Index curve = excess ? 2 : 1;
    const Index unknowns = always + curve + errors();
    LevelRegression out{.columns = MatrixXd(unknowns + 1, static_cast<Index>(rows.samples.size())),
                        .starts = rows.starts,
                        .prior_std = VectorXd::Zero(unknowns),
                        .prior_mean = VectorXd::Zero(unknowns)};
    const auto [fall, slope] = stribeck_columns(stribeck_radps);
    for (std::size_t row = 0; row < rows.samples.size(); ++row) {
      const std::size_t k = rows.samples[row];
      auto column = out.columns.col(static_cast<Index>(row));
      for (Index i = 0; i < always; ++i) column(i) = columns_[static_cast<std::size_t>(i)][k];
      column(stribeck) = fall[k];
      if (curve > 1) column(stribeck_speed) = *excess * slope[k];
      if (errors_ != nullptr) errors_->write(k, column.segment(always + curve, errors()));
      column(unknowns) = target_[k];
      out.time_s.push_back(series_.time_s(k));
    }
    set_priors(out, curve);
    return out;
  }

 private:
  [[nodiscard]] double sign(std::size_t k) const {
    return motion_.speed_radps[k] < 0.0 ? -1.0 : 1.0;
  }

  // −∫ sgn ω exp(−r²) and −∫ sgn ω 2 r² exp(−r²) with r = ω/ωs.
  [[nodiscard]] std::pair<Column, Column> stribeck_columns(double speed_radps) const {
    Column fall, slope;
    for (std::size_t k = 0; k < series_.size(); ++k) {
      const double square = std::pow(motion_.speed_radps[k] / speed_radps, 2);
      fall.push_back(-sign(k) * std::exp(-square));
      slope.push_back(2.0 * square * fall.back());
    }
    return {integral(fall, series_.step_s), integral(slope, series_.step_s)};
  }

  // Practically none: a thousand times what makes a column as large as the target.
  void set_priors(LevelRegression& out, Index curve) const {
    constexpr double anything = 1e3;
    const Index unknowns = out.unknowns();
    const auto spread = [&](Index row) {
      double low = std::numeric_limits<double>::infinity(), high = -low;
      for (Index k = 0; k < out.columns.cols(); ++k) {
        low = std::min(low, out.columns(row, k));
        high = std::max(high, out.columns(row, k));
      }
      return std::max(high - low, 1e-9);
    };
    const double target = spread(unknowns);
    for (Index i = 0; i < always + curve; ++i) out.prior_std(i) = anything * target / spread(i);
    if (curve > 1) out.prior_std(stribeck_speed) = 1.0;
    if (errors_ != nullptr) errors_->set_priors(out.prior_std.tail(errors()));
  }

  const Series& series_;
  const Motion& motion_;
  std::vector<Column> columns_;
  Column target_;
  const AngleErrors* errors_ = nullptr;
};

struct Curve {
  double speed_radps = 0.0;
  std::optional<double> excess{};  // with it the speed is an unknown
};

// The Stribeck speed of the highest likelihood, on a logarithmic grid refined by a parabola;
// without an excess if that is not three standard deviations above zero.
Curve find_curve(const Equation& equation, const Rows& rows, const Motion& motion, double ratio) {
  constexpr int points = 29;
  const double low = std::log(0.7 * motion.rest_radps), high = std::log(0.5 * motion.top_radps());
  if (!(high > low)) return {};
  const double step = (high - low) / (points - 1);
  std::vector<double> costs;
  for (int i = 0; i < points; ++i)
    costs.push_back(
        fit_at(equation.regression(rows, std::exp(low + i * step), std::nullopt), ratio).cost);
  const auto best = std::ranges::min_element(costs) - costs.begin();
  double at = low + static_cast<double>(best) * step;
  if (best > 0 && best + 1 < points) {
    const auto i = static_cast<std::size_t>(best);
    const double bend = costs[i - 1] - 2.0 * costs[i] + costs[i + 1];
    if (bend > 0.0) at += 0.5 * step * (costs[i - 1] - costs[i + 1]) / bend;
  } else {
    return {};
  }
  const LevelFit found = fit_at(equation.regression(rows, std::exp(at), std::nullopt), ratio);
  const double std = std::sqrt(found.model_covariance(stribeck, stribeck));
  if (!(found.value(stribeck) > 3.0 * std)) return {};
  return {std::exp(at), found.value(stribeck)};
}

struct Solved {
  LevelRegression regression;
  LevelFit fit;
  Curve curve;
};

// The excess friction at a usual Stribeck speed, as a nuisance: without it the other terms would
// take its place.
Solved solve_at_usual_speed(const Equation& equation, const Rows& rows, const Motion& motion) {
  constexpr double usual_share = 0.06;
  const Curve curve{usual_share * motion.top_radps(), std::nullopt};
  LevelRegression regression = equation.regression(rows, curve.speed_radps, std::nullopt);
  LevelFit found = fit(regression);
  return {std::move(regression), std::move(found), curve};
}

Solved solve_with_curve(const Equation& equation, const Rows& rows, const Motion& motion) {
  Solved solved = solve_at_usual_speed(equation, rows, motion);
  const Curve curve = find_curve(equation, rows, motion, solved.fit.ratio);
  if (!curve.excess) return solved;
  solved.curve = curve;
  // Newton's steps for the speed, with the walk estimated anew.
  constexpr int steps = 5;
  for (int step = 0; step <= steps; ++step) {
    solved.regression = equation.regression(rows, solved.curve.speed_radps, solved.curve.excess);
    solved.fit = fit(solved.regression);
    if (step == steps) break;
    const double change = std::clamp(solved.fit.value(stribeck_speed), -0.5, 0.5);
    solved.curve = {solved.curve.speed_radps * std::exp(change), solved.fit.value(stribeck)};
  }
  return solved;
}

MechanicalFit mechanical_of(const Solved& solved) {
  const bool shows = solved.curve.excess.has_value();
  const Index used = shows ? mechanical_count : stribeck_speed;
  MechanicalFit out{.value = VectorXd::Zero(mechanical_count),
                    .covariance = MatrixXd::Zero(mechanical_count, mechanical_count),
                    .by_electrical = MatrixXd::Zero(mechanical_count, electrical_count),
                    .shows_stribeck = shows,
                    .correlation = solved.fit.correlation,
                    .white_std = solved.fit.white_std};
  out.value.head(used) = solved.fit.value.head(used);
  out.covariance.topLeftCorner(used, used) = solved.fit.covariance.topLeftCorner(used, used);
  out.value(stribeck_speed) = std::log(solved.curve.speed_radps);
  return out;
}

// The angle by the equation alone, each motion about its measured mean.
void set_predicted_angle(const Solved& solved,
                         const Rows& rows,
                         const Series& series,
                         Motion& motion) {
  const Index known = stribeck_speed;  // without the errors of the angle
  const std::size_t n = rows.samples.size();
  for (std::size_t s = 0; s < rows.starts.size(); ++s) {
    const std::size_t first = rows.starts[s],
                      last = s + 1 < rows.starts.size() ? rows.starts[s + 1] : n;
    double offset = 0.0;
    for (std::size_t row = first; row < last; ++row) {
      const double predicted = solved.regression.columns.col(static_cast<Index>(row))
                                   .head(known)
                                   .dot(solved.fit.value.head(known));
      motion.angle_rad[rows.samples[row]] = predicted;
      offset +=
          (series.angle_rad[rows.samples[row]] - predicted) / static_cast<double>(last - first);
    }
    for (std::size_t row = first; row < last; ++row) motion.angle_rad[rows.samples[row]] += offset;
  }
}

}  // namespace

Result<MechanicalFit> fit_with_current(const Series& series,
                                       const Motion& motion,
                                       const ElectricalFit& electrical) {
  const Rows rows = moving_rows(motion, 0.0);
  if (const Status enough = check(rows); !enough) return enough.error();
  std::vector<double> minus_speed = motion.speed_radps;
  for (double& w : minus_speed) w = -w;
  const VectorXd speed = electrical.speed_terms * electrical.value;
  Equation equation(series, motion);
  equation.set(drive, integral(series.current_a, series.step_s));
  equation.set(viscous, integral(minus_speed, series.step_s));
  equation.set_target({speed.data(), speed.data() + speed.size()});
  const Solved solved = solve_with_curve(equation, rows, motion);
  MechanicalFit out = mechanical_of(solved);
  MatrixXd targets(static_cast<Index>(rows.samples.size()), electrical_count);
  for (std::size_t row = 0; row < rows.samples.size(); ++row)
    targets.row(static_cast<Index>(row)) =
        electrical.speed_terms.row(static_cast<Index>(rows.samples[row]));
  const MatrixXd moved = response(solved.regression, solved.fit, targets);
  const Index used = out.shows_stribeck ? mechanical_count : stribeck_speed;
  out.by_electrical.topRows(used) = moved.topRows(used);
  return out;
}

Result<MechanicalFit> fit_without_current(const Series& series, const Motion& load) {
  // Near a rest the speed by the load's angle is too noisy to show how friction rises.
  constexpr double fast_share = 0.15;
  constexpr int rounds = 3;
  const Rows rows = moving_rows(load, fast_share * load.top_radps());
  if (const Status enough = check(rows); !enough) return enough.error();
  Motion motion = load;
  std::optional<Solved> solved;
  for (int round = 0; round < rounds; ++round) {
    if (solved) set_predicted_angle(*solved, rows, series, motion);
    std::vector<double> minus_speed = motion.speed_radps;
    for (double& w : minus_speed) w = -w;
    const AngleErrors errors(series, motion);
    Equation equation(series, motion);
    equation.set(drive, integral(series.voltage_v, series.step_s));
    equation.set(viscous, std::move(minus_speed));
    equation.set_target(series.angle_rad);
    equation.set_errors(&errors);
    solved = solve_at_usual_speed(equation, rows, motion);
  }
  MechanicalFit out = mechanical_of(*solved);
  out.angle_noise_rad = out.white_std;
  return out;
}

}  // namespace proofmass::estimate::motor
