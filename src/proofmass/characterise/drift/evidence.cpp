#include "proofmass/characterise/drift/evidence.hpp"

#include <array>
#include <cmath>
#include <fmt/format.h>
#include <numbers>
#include <numeric>

#include "proofmass/signal/fourier.hpp"

namespace proofmass::characterise {
namespace {

using Eigen::Index;
using Eigen::VectorXd;

// Interpolates each gap linearly, to avoid edges in the transform.
void fill(std::vector<double>& values) {
  std::size_t last = values.size();  // last block that is there
  for (std::size_t k = 0; k < values.size(); ++k) {
    if (std::isnan(values[k])) continue;
    const std::size_t from = last == values.size() ? 0 : last + 1;
    const double before = last == values.size() ? values[k] : values[last];
    const auto width = static_cast<double>(k - from + 1);
    for (std::size_t j = from; j < k; ++j)
      values[j] = before + (values[k] - before) * static_cast<double>(j - from + 1) / width;
    last = k;
  }
  for (std::size_t j = last + 1; j < values.size(); ++j) values[j] = values[last];
}

VectorXd transform(View<double> values, double to_density) {
  const std::vector<double> amplitudes = signal::cosine_transform(values);
  return to_density *
         Eigen::Map<const VectorXd>(amplitudes.data(), static_cast<Index>(amplitudes.size()));
}

}  // namespace

Result<DriftEvidence> DriftEvidence::make(View<double> block_means,
                                          const Sampling& sampling,
                                          double start_s) {
  DriftEvidence evidence(sampling, start_s);
  const std::size_t n = block_means.size();
  for (std::size_t k = 0; k < n; ++k)
    if (std::isnan(block_means[k])) evidence.missing_.push_back(k);
  if (n < fewest_blocks || 2 * evidence.missing_.size() > n)
    return Error{
        Errc::too_few_samples,
        fmt::format("{} block means of which {} are missing, expected at least {} and half "
                    "of them present",
                    n, evidence.missing_.size(), fewest_blocks)};
  evidence.n_ = static_cast<Index>(n);
  evidence.sines_.resize(4 * n);
  for (std::size_t k = 0; k < 4 * n; ++k)
    evidence.sines_[k] =
        std::sin(0.5 * std::numbers::pi * static_cast<double>(k) / static_cast<double>(n));
  const Eigen::Map<const VectorXd> turn(evidence.sines_.data(), 4 * evidence.n_);
  evidence.half_sine_ = turn.head(evidence.n_);
  evidence.half_cosine_ = turn.segment(evidence.n_, evidence.n_);
  std::vector<double> values(block_means.begin(), block_means.end());
  fill(values);
  const double to_density = std::sqrt(evidence.block_s());
  evidence.z_ = transform(values, to_density);
  for (std::size_t k = 0; k < n; ++k)
    values[k] =
        start_s / evidence.duration_s() + (static_cast<double>(k) + 0.5) / static_cast<double>(n);
  evidence.line_ = transform(values, to_density);
  evidence.dummies_.resize(evidence.n_, static_cast<Index>(evidence.missing_.size()));
  for (std::size_t j = 0; j < evidence.missing_.size(); ++j) {
    const double middle =
        start_s + (static_cast<double>(evidence.missing_[j]) + 0.5) * evidence.block_s();
    // An impulse's transform is the weight of the ordinates there, up to the density's factor.
    evidence.dummies_.col(static_cast<Index>(j)) = evidence.at(middle) * evidence.block_s();
  }
  return evidence;
}

// The geometric series Σ ρ^j cos((j + ½) θ) = (1 − ρ) cos(θ/2) (1 − (−1)^k ρ^n) / |1 − ρ e^iθ|² at
// θ = π k/n; the mean over a block of e^(−t/T) is e^(−start/T) (T/h) (1 − ρ) ρ^j.
VectorXd DriftEvidence::rise(double time_constant_s) const {
  const double h = block_s(), decay = h / time_constant_s;
  const double rho = std::exp(-decay), one_less_rho = -std::expm1(-decay);
  const auto n = static_cast<double>(n_);
  const double rho_n = std::exp(-n * decay), one_less_rho_n = -std::expm1(-n * decay);
  // Long after power-on e^(-start/T) underflows to zero: the columns keep the exponential's shape
  // within the recording, whatever its amplitude would have been.
  constexpr double longest_ago = 30.0;  // in time constants
  const double first =
      -std::exp(-std::min(start_s_ / time_constant_s, longest_ago)) * one_less_rho / decay;
  const double scale = first * std::sqrt(2.0 * h / n) * one_less_rho;
  VectorXd e = (scale * half_cosine_.array() /
                (one_less_rho * one_less_rho + 4.0 * rho * half_sine_.array().square()))
                   .matrix();
  for (Index k = 0; k < n_; k += 2) e(k) *= one_less_rho_n;
  for (Index k = 1; k < n_; k += 2) e(k) *= 1.0 + rho_n;
  e(0) = std::sqrt(h * n) + first * std::sqrt(h / n) * one_less_rho_n / one_less_rho;
  return e;
}

VectorXd DriftEvidence::rise_by_log_time(double time_constant_s) const {
  constexpr double step = 1e-4;
  return (rise(time_constant_s * std::exp(step)) - rise(time_constant_s * std::exp(-step))) /
         (2.0 * step);
}

// The exact mean over few samples; over many by four-node Gauss–Legendre. From the 16th block on
// the midpoint is used: for curvature up to that of ln t the error is t²|ẍ|/(24 · 16²) ≤ 1/6000.
VectorXd DriftEvidence::of(const std::function<double(double)>& curve) const {
  constexpr std::array nodes{0.0694318442029737, 0.3300094782075719, 0.6699905217924281,
                             0.9305681557970263};
  constexpr std::array weights{0.1739274225687269, 0.3260725774312731, 0.3260725774312731,
                               0.1739274225687269};
  constexpr std::size_t steep = 16;
  const auto n = static_cast<std::size_t>(n_);
  const bool few = sampling_.block <= nodes.size();
  const std::size_t count = few ? sampling_.block : nodes.size();
  const double even = 1.0 / static_cast<double>(count);
  const auto at = [&](std::size_t block, double share) {
    return curve(start_s_ + (static_cast<double>(block) + share) * block_s());
  };
  std::vector<double> values(n, 0.0);
  for (std::size_t k = 0; k < n; ++k) {
    if (k >= steep) values[k] = at(k, 0.5);
    for (std::size_t j = 0; k < steep && j < count; ++j)
      values[k] +=
          few ? even * at(k, (static_cast<double>(j) + 0.5) * even) : weights[j] * at(k, nodes[j]);
  }
  return transform(values, std::sqrt(block_s()));
}

// Σ_{j ≥ block} cos((j + ½) θ) = −sin(block θ) / (2 sin(θ/2)).
VectorXd DriftEvidence::step(std::size_t block) const {
  const auto n = static_cast<double>(n_);
  VectorXd s(n_);
  s(0) = std::sqrt(block_s() / n) * (n - static_cast<double>(block));
  const double scale = -0.5 * std::sqrt(2.0 * block_s() / n);
  const std::size_t turn = sines_.size();
  std::size_t place = 0;
  for (Index k = 1; k < n_; ++k) {
    place += 2 * block;
    if (place >= turn) place -= turn;
    s(k) = scale * sines_[place] / half_sine_(k);
  }
  return s;
}

VectorXd DriftEvidence::at(double t_s) const {
  const auto n = static_cast<double>(n_);
  const double phase = std::numbers::pi * (t_s - start_s_) / duration_s();
  VectorXd weights(n_);
  weights(0) = std::sqrt(1.0 / (n * block_s()));
  for (Index k = 1; k < n_; ++k)
    weights(k) = std::sqrt(2.0 / (n * block_s())) * std::cos(phase * static_cast<double>(k));
  return weights;
}

std::vector<double> DriftEvidence::series(const VectorXd& ordinates) const {
  const auto n = static_cast<std::size_t>(n_);
  const double first = ordinates(0) / std::sqrt(static_cast<double>(n) * block_s());
  const double scale = std::sqrt(2.0 / (static_cast<double>(n) * block_s()));
  std::vector<double> values(n);
  for (std::size_t j = 0; j < n; ++j) {
    double sum = 0.0;
    std::size_t place = n;  // a quarter turn: the cosine
    for (std::size_t k = 1; k < n; ++k) {
      place += 2 * j + 1;
      if (place >= sines_.size()) place -= sines_.size();
      sum += ordinates(static_cast<Index>(k)) * sines_[place];
    }
    values[j] = first + scale * sum;
  }
  return values;
}

}  // namespace proofmass::characterise
