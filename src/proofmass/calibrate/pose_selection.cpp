#include "proofmass/calibrate/pose_selection.hpp"

#include <algorithm>
#include <cmath>

#include "proofmass/core/chi_square.hpp"

namespace proofmass::calibrate {
namespace {

constexpr double suspect_p = 0.01;     // after Bonferroni's correction
constexpr double tell_apart = 9.0;     // three standard deviations
constexpr double rounding_g = 1e-9;    // less than this contradicts nobody
constexpr double all_leverage = 1e-6;  // of 1 − h: the pose alone carries a parameter

// One pose left out of the fit, or judged by a fit that it had no part in.
struct Deleted {
  std::optional<double> residual, studentised;
  double p = 1.0;  // of so large a residual in any of the poses
};

Deleted deleted(const PoseSelection& now, bool used, std::size_t k, double noise_dof) {
  const NormFit& fit = now.fit;
  const NormTerm& term = fit.terms[k];
  const double e = term.residual / std::sqrt(term.variance);
  const double h = fit.leverage[k];
  Deleted out;
  if (used && !(1.0 - h > all_leverage)) return out;
  if (used && fit.dof() == 0) return out;
  out.residual = used ? term.residual / (1.0 - h) : term.residual;
  const double rss = used ? std::max(0.0, fit.rss - e * e / (1.0 - h)) : fit.rss;
  const Scatter scatter =
      scatter_of(rss, static_cast<double>(fit.dof() - std::size_t{used}), noise_dof);
  if (scatter.dof == 0.0 || !(scatter.factor > 0.0)) return out;
  out.studentised = e / std::sqrt(scatter.factor * (used ? 1.0 - h : 1.0 + h));
  if (std::abs(*out.residual) < rounding_g) return out;
  const auto n = static_cast<double>(fit.terms.size());
  out.p = std::min(1.0, n * student_t_p(*out.studentised, scatter.dof));
  return out;
}

// The pose that is to be left out or taken back next, if any.
std::optional<std::size_t> next_change(const std::vector<Deleted>& all,
                                       const std::vector<double>& weights,
                                       PoseSelection& now) {
  std::optional<std::size_t> back, out;
  for (std::size_t k = 0; k < all.size(); ++k) {
    if (weights[k] == 0.0 && all[k].p >= suspect_p && (!back || all[k].p > all[*back].p)) back = k;
    const bool bad = weights[k] != 0.0 && all[k].p < suspect_p;
    if (bad && (!out || std::abs(*all[k].studentised) > std::abs(*all[*out].studentised))) out = k;
  }
  now.alike.clear();
  if (back) return back;
  if (!out) return std::nullopt;
  const double worst = std::abs(*all[*out].studentised);
  // Leaving a pose out lowers the sum by e²/(1 − h); for the worst that is its t² in units of the
  // noise that then remains.
  const auto gain = [&](std::size_t k) {
    const NormTerm& term = now.fit.terms[k];
    return term.residual * term.residual / term.variance / (1.0 - now.fit.leverage[k]);
  };
  const double unit = gain(*out) / (worst * worst);
  for (std::size_t k = 0; k < all.size(); ++k) {
    if (weights[k] == 0.0 || k == *out || !all[k].studentised) continue;
    if (gain(*out) - gain(k) < tell_apart * unit) now.alike.push_back(k);
  }
  if (now.alike.empty()) return out;
  now.alike.insert(now.alike.begin(), *out);
  return std::nullopt;
}

}  // namespace

Scatter scatter_of(double rss, double dof, double noise_dof) {
  if (noise_dof == 0.0) return dof > 0.0 ? Scatter{rss / dof, dof, {}} : Scatter{};
  if (!(dof > 0.0)) return {1.0, noise_dof, {}};
  const LackOfFit test{rss / dof, fisher_f_p(rss / dof, dof, noise_dof), dof};
  if (test.p < 0.05) return {rss / dof, dof, test};
  return {(rss + noise_dof) / (dof + noise_dof), dof + noise_dof, test};
}

Result<PoseSelection> select_poses(View<NormalisedPose> poses,
                                   const Parameters& start,
                                   const SelectionOptions& options) {
  const auto free = static_cast<std::size_t>(options.free);
  RobustStart from{start, std::vector<double>(poses.size(), 1.0)};
  if (poses.size() >= free + 4) {
    RobustStart robust = robust_start(poses, options.free, start);
    const auto kept = std::count(robust.weights.begin(), robust.weights.end(), 1.0);
    if (static_cast<std::size_t>(kept) >= free + 2) from = std::move(robust);
  }
  PoseSelection now;
  std::vector<Deleted> all(poses.size());
  for (std::size_t round = 0;; ++round) {
    const Result<NormFit> fit = fit_norm(poses, from.weights, options.free, from.p);
    if (!fit) return fit.error();
    now.fit = *fit;
    from.p = fit->p;
    for (std::size_t k = 0; k < poses.size(); ++k)
      all[k] = deleted(now, from.weights[k] != 0.0, k, options.noise_dof);
    const std::optional<std::size_t> change = next_change(all, from.weights, now);
    if (!change || round == 2 * poses.size()) break;
    from.weights[*change] = 1.0 - from.weights[*change];
  }
  for (const double weight : from.weights) now.suspect.push_back(weight == 0.0);
  if (options.keep_suspects && now.fit.used < poses.size()) {
    std::fill(from.weights.begin(), from.weights.end(), 1.0);
    const Result<NormFit> fit = fit_norm(poses, from.weights, options.free, from.p);
    if (!fit) return fit.error();
    now.fit = *fit;
    for (std::size_t k = 0; k < poses.size(); ++k)
      all[k] = deleted(now, true, k, options.noise_dof);
  }
  for (const double weight : from.weights) now.used.push_back(weight != 0.0);
  now.scatter = scatter_of(now.fit.rss, static_cast<double>(now.fit.dof()), options.noise_dof);
  for (const Deleted& one : all) {
    now.leave_one_out.push_back(one.residual);
    now.studentised.push_back(one.studentised);
  }
  return now;
}

}  // namespace proofmass::calibrate
