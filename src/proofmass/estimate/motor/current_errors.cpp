#include "proofmass/estimate/motor/current_errors.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <vector>

#include "proofmass/core/number_words.hpp"
#include "proofmass/core/random.hpp"
#include "proofmass/core/statistics.hpp"

namespace proofmass::estimate::motor {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr int repetitions = 6;

// Quantisation step: the usual least distance between values that occur; 0 if most occur once.
double step_of(const std::vector<double>& values) {
  std::vector<double> levels;
  for (const double v : values)
    if (std::isfinite(v)) levels.push_back(v);
  const std::size_t n = levels.size();
  std::ranges::sort(levels);
  levels.erase(std::ranges::unique(levels).begin(), levels.end());
  constexpr std::size_t least_repeats = 4;
  if (levels.size() < 2 || levels.size() * least_repeats > n) return 0.0;
  std::vector<double> distances;
  for (std::size_t k = 1; k < levels.size(); ++k) distances.push_back(levels[k] - levels[k - 1]);
  return median(distances).value_or(0.0);
}

// The current's noise per recorded sample, and its converter's step where that exceeds the noise.
struct Errors {
  double noise_a = 0.0, step_a = 0.0;
};

Errors errors_of(const MotorRecord& record) {
  constexpr double linear = 0.5;  // noise above this many steps makes the converter linear
  std::vector<double> finite;
  for (const double i : record.current_a)
    if (std::isfinite(i)) finite.push_back(i);
  Errors out{.noise_a = sample_noise(finite), .step_a = step_of(finite)};
  if (out.noise_a > linear * out.step_a) out.step_a = 0.0;
  return out;
}

MotorRecord with_errors(const MotorRecord& record, const Errors& errors, Random& random) {
  MotorRecord out = record;
  std::map<double, double> of_level;
  for (double& i : out.current_a) {
    const double recorded = i;
    i += errors.noise_a * random.normal();
    if (!(errors.step_a > 0.0)) continue;
    const auto [level, is_new] = of_level.try_emplace(recorded, 0.0);
    if (is_new) level->second = 0.5 * errors.step_a * random.uniform();
    i += level->second;
  }
  return out;
}

}  // namespace

VectorXd joint_coefficients(const Identified& found) {
  VectorXd out(joint_count);
  out << found.electrical->value, found.mechanical.value, found.electrical->half_backlash_rad;
  out(brush_knee) = 0.0;  // relative to where each fit is linear
  return out;
}

std::optional<std::string> unusable_current(const MotorRecord& record) {
  constexpr double upper = 0.75, most_share = 0.15;
  const double step_a = errors_of(record).step_a;
  std::vector<double> sizes;
  for (const double i : record.current_a)
    if (std::isfinite(i)) sizes.push_back(std::abs(i));
  const double usual_a = quantile(sizes, upper).value_or(0.0);
  if (!(step_a > most_share * usual_a)) return std::nullopt;
  return "current: steps of " + significant(step_a, 2) + " A are too coarse beside currents of " +
         significant(usual_a, 2) + " A: it is not used";
}

CurrentErrors current_errors(const MotorRecord& record,
                             const MotorOptions& options,
                             const Identified& found) {
  CurrentErrors out{VectorXd::Zero(joint_count), MatrixXd::Zero(joint_count, joint_count)};
  if (!found.electrical) return out;
  const Errors errors = errors_of(record);
  const VectorXd value = joint_coefficients(found);
  VectorXd sum = VectorXd::Zero(joint_count);
  MatrixXd squares = MatrixXd::Zero(joint_count, joint_count);
  int count = 0;
  Random random(1, "errors of the current");
  for (int k = 0; k < repetitions; ++k) {
    if (options.progress) options.progress("identification", (1.0 + k) / (1.0 + repetitions));
    const Result<Identified> repeated =
        identify(with_errors(record, errors, random), options, found.electrical->next);
    if (!repeated || repeated->mechanical.shows_stribeck != found.mechanical.shows_stribeck)
      continue;
    const VectorXd change = joint_coefficients(*repeated) - value;
    sum += change;
    squares += change * change.transpose();
    ++count;
  }
  if (count < 2) return out;
  const VectorXd mean = sum / count;
  const MatrixXd scatter = (squares - count * mean * mean.transpose()) / (count - 1);
  out.shift = -mean;
  out.covariance = mean * mean.transpose() + (errors.step_a > 0.0 ? 1.0 : 1.0 / count) * scatter;
  return out;
}

}  // namespace proofmass::estimate::motor
