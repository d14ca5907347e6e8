#include "proofmass/calibrate/multi_position/pose_selection.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

#include "proofmass/calibrate/multi_position/pose_hypotheses.hpp"
#include "proofmass/core/chi_square.hpp"

namespace proofmass::calibrate {
namespace {

constexpr double suspect_p = 0.01;     // after Bonferroni's correction
constexpr double clearly_worse = 9.0;  // three standard deviations
constexpr double rounding_g = 1e-9;    // smaller residuals do not count as contradictions
constexpr double noticed_stds = 4.13;  // see the header
constexpr double largest_F = 1e12;     // beyond which there is no probability left

// n choose k.
double sets_of(std::size_t k, std::size_t n) {
  double count = 1.0;
  for (std::size_t i = 0; i < k; ++i)
    count *= static_cast<double>(n - i) / static_cast<double>(i + 1);
  return count;
}

// How many poses are bad.
class Choice {
 public:
  Choice(PoseHypotheses& hypotheses, std::size_t poses, const SelectionOptions& options)
      : hypotheses_(hypotheses), poses_(poses), options_(options) {}

  /// The smallest set of poses without which the others agree.
  PoseSet fewest();

  /// The empty set, and each possibly bad pose, if ambiguous: no pose is suspect, but the residuals
  /// are significant at 5 %.
  std::vector<PoseSet> in_question();

  Scatter scatter_without(const PoseSet& out) {
    const NormFit& fit = *hypotheses_.without(out);
    return scatter_of(fit.rss, static_cast<double>(fit.dof()), options_.noise_dof);
  }

 private:
  // p-value of the reduction of the sum, against the remaining noise.
  double chance(const PoseSet& from, const PoseSet& to, double noise_dof);
  bool worth_fitting(const PoseSet& from, std::size_t size);
  std::optional<PoseSet> larger(const PoseSet& from, std::size_t size);
  std::optional<PoseSet> many(const PoseSet& from);
  std::vector<PoseSet> with_one_back(const PoseSet& out);
  std::optional<PoseSet> without_weakest(const PoseSet& out);
  bool explained(const PoseSet& out);

  PoseHypotheses& hypotheses_;
  std::size_t poses_;
  const SelectionOptions& options_;
};

double Choice::chance(const PoseSet& from, const PoseSet& to, double noise_dof) {
  const NormFit* before = hypotheses_.without(from);
  const NormFit* after = hypotheses_.without(to);
  if (before == nullptr || after == nullptr) return 1.0;
  const Scatter scatter = scatter_of(after->rss, static_cast<double>(after->dof()), noise_dof);
  const double gain = before->rss - after->rss;
  const bool rounding = std::ranges::all_of(
      to, [&](std::size_t k) { return std::abs(after->terms[k].residual) < rounding_g; });
  if (scatter.dof == 0.0 || !(gain > 0.0) || rounding) return 1.0;
  const auto extra = static_cast<double>(to.size() - from.size());
  const double F = std::min(gain / extra / std::max(scatter.factor, 1e-300), largest_F);
  const double sets = std::ranges::includes(to, from)
                          ? sets_of(to.size() - from.size(), poses_ - from.size())
                          : sets_of(to.size(), poses_);
  return sets * fisher_f_p(F, extra, scatter.dof);
}

// Sets far from significance are not fitted.
bool Choice::worth_fitting(const PoseSet& from, std::size_t size) {
  constexpr double far = 0.1;
  const NormFit& before = *hypotheses_.without(from);
  const std::optional<double> rss = hypotheses_.linear_rss(size);
  const auto free = static_cast<std::size_t>(options_.free);
  if (!rss || poses_ < free + size) return false;
  const Scatter scatter =
      scatter_of(*rss, static_cast<double>(poses_ - free - size), options_.noise_dof);
  const auto extra = static_cast<double>(size - from.size());
  const double gain = before.rss - *rss;
  if (scatter.dof == 0.0 || !(gain > 0.0)) return false;
  const double F = std::min(gain / extra / std::max(scatter.factor, 1e-300), largest_F);
  return sets_of(size - from.size(), poses_) * fisher_f_p(F, extra, scatter.dof) < far;
}

std::optional<PoseSet> Choice::larger(const PoseSet& from, std::size_t size) {
  if (!worth_fitting(from, size)) return std::nullopt;
  const std::vector<PoseSet> sets = hypotheses_.best(size);
  // If the noise is larger than stated, two are easily found that agree with the stated one: sets
  // of two are tested by the remaining residuals alone.
  const double noise_dof = size == from.size() + 1 ? options_.noise_dof : 0.0;
  if (sets.empty() || chance(from, sets.front(), noise_dof) >= suspect_p) return std::nullopt;
  return sets.front();
}

bool Choice::explained(const PoseSet& out) {
  const auto test = scatter_without(out).lack_of_fit;
  return test ? test->p >= suspect_p : !hypotheses_.suspicious();
}

// `out` without one of its members: the few members whose errors are least significant in the
// linear model. A fit without each one of some fifty would take a minute.
std::vector<PoseSet> Choice::with_one_back(const PoseSet& out) {
  constexpr std::size_t most = 6;
  const std::vector<double> gains = hypotheses_.shifts(*hypotheses_.without(out)).gains(out);
  std::vector<std::pair<double, PoseSet>> by_gain;
  for (std::size_t member = 0; member < out.size(); ++member) {
    PoseSet others = out;
    others.erase(others.begin() + static_cast<std::ptrdiff_t>(member));
    by_gain.emplace_back(std::isfinite(gains[member]) ? gains[member] : 0.0, std::move(others));
  }
  std::ranges::sort(by_gain);
  by_gain.resize(std::min(by_gain.size(), most));
  std::vector<PoseSet> sets;
  for (auto& [gain, others] : by_gain) sets.push_back(std::move(others));
  return sets;
}

// `out` without the member whose error is least significant, if it is not significant.
std::optional<PoseSet> Choice::without_weakest(const PoseSet& out) {
  double largest = 0.0;
  std::optional<PoseSet> found;
  for (PoseSet& others : with_one_back(out)) {
    if (hypotheses_.without(others) == nullptr) continue;
    const double p = chance(others, out, 0.0);
    if (p <= largest) continue;
    largest = p;
    found = std::move(others);
  }
  return largest < suspect_p ? std::nullopt : found;
}

// More than two: the trimmed ones, without those that do not contradict the others after all.
std::optional<PoseSet> Choice::many(const PoseSet& from) {
  const auto free = static_cast<std::size_t>(options_.free);
  if (poses_ < free + 4) return std::nullopt;
  const std::size_t most = std::min(poses_ / 4, (poses_ - free) / 2);
  if (most < 3) return std::nullopt;
  PoseSet out = hypotheses_.trimmed(most);
  if (hypotheses_.without(out) == nullptr) return std::nullopt;
  while (out.size() > 2) {
    std::optional<PoseSet> others = without_weakest(out);
    if (!others) break;
    out = std::move(*others);
  }
  if (out.size() <= std::max<std::size_t>(2, from.size()) || chance(from, out, 0.0) >= suspect_p)
    return std::nullopt;
  return out;
}

PoseSet Choice::fewest() {
  PoseSet out;
  while (out.size() < 2) {
    std::optional<PoseSet> next = larger(out, out.size() + 1);
    // Two that compensate each other may be hidden while one of them stays.
    if (!next && out.empty()) next = larger(out, 2);
    if (!next) break;
    out = *next;
  }
  if (explained(out)) return out;
  return many(out).value_or(out);
}

std::vector<PoseSet> Choice::in_question() {
  const Scatter scatter = scatter_without({});
  if (!scatter.lack_of_fit || scatter.lack_of_fit->p >= 0.05) return {{}};
  const std::vector<PoseSet> sets = hypotheses_.best(1);
  if (sets.empty()) return {{}};
  const NormFit& best = *hypotheses_.without(sets.front());
  const Scatter left = scatter_without(sets.front());
  std::vector<PoseSet> out =
      hypotheses_.alike(sets.front(), best.rss + clearly_worse * std::max(left.factor, 1e-20));
  out.emplace_back();
  return out;
}

// The mean over the fits that are not distinguishable.
void average(PoseHypotheses& hypotheses, const std::vector<PoseSet>& alike, PoseSelection& now) {
  const auto count = static_cast<double>(alike.size());
  const Eigen::Index free = now.fit.cofactor.rows();
  Parameters mean = Parameters::Zero();
  Eigen::MatrixXd cofactor = Eigen::MatrixXd::Zero(free, free);
  for (const PoseSet& out : alike) {
    mean += hypotheses.without(out)->p / count;
    cofactor += hypotheses.without(out)->cofactor / count;
  }
  now.by_choice = Eigen::MatrixXd::Zero(free, free);
  for (const PoseSet& out : alike) {
    const Eigen::VectorXd apart = (hypotheses.without(out)->p - mean).head(free);
    now.by_choice += apart * apart.transpose() / count;
  }
  now.fit.p = mean;
  now.fit.cofactor = cofactor;
}

// The poses in all of the sets, or the first set if the others without those cannot be fitted; and
// the further ones in some of the sets.
std::pair<PoseSet, PoseSet> suspects_and_doubtful(const std::vector<PoseSet>& sets,
                                                  PoseHypotheses& hypotheses) {
  PoseSet all = sets.front(), some = sets.front();
  for (const PoseSet& set : sets) {
    PoseSet both, either;
    std::ranges::set_intersection(all, set, std::back_inserter(both));
    std::ranges::set_union(some, set, std::back_inserter(either));
    all = std::move(both);
    some = std::move(either);
  }
  if (hypotheses.without(all) == nullptr) all = sets.front();
  PoseSet doubtful;
  std::ranges::set_difference(some, all, std::back_inserter(doubtful));
  return {std::move(all), std::move(doubtful)};
}

// Tests each pose against the others, without those of `out`.
void judge(const PoseShifts& shifts, const PoseSet& out, double noise_dof, PoseSelection& now) {
  const PoseShifts rest = shifts.without(out);
  const auto dof = static_cast<double>(now.fit.dof());
  const std::optional<double> rss = shifts.rss_without(out);
  for (std::size_t k = 0; k < shifts.poses(); ++k) {
    const bool left_out = std::ranges::count(out, k) > 0;
    PoseSet others = out;
    if (left_out) others.erase(std::ranges::find(others, k));
    const auto shift = left_out ? shifts.without(others).shift_of(k) : rest.shift_of(k);
    auto& residual = now.leave_one_out.emplace_back();
    auto& studentised = now.studentised.emplace_back();
    auto& detectable = now.detectable.emplace_back();
    if (!shift || !rss || (!left_out && dof == 0.0)) continue;
    residual = shift->value;
    const double own = left_out ? 0.0 : shift->value * shift->value / shift->cofactor;
    const Scatter scatter =
        scatter_of(std::max(0.0, *rss - own), left_out ? dof : dof - 1.0, noise_dof);
    if (scatter.dof == 0.0 || !(scatter.factor > 0.0)) continue;
    studentised = shift->value / std::sqrt(scatter.factor * shift->cofactor);
    detectable = noticed_stds * std::sqrt(now.scatter.factor * shift->cofactor);
  }
}

}  // namespace

Scatter scatter_of(double rss, double dof, double noise_dof) {
  if (noise_dof == 0.0) return dof > 0.0 ? Scatter{rss / dof, dof, {}} : Scatter{};
  if (!(dof > 0.0)) return {1.0, noise_dof, {}};
  const LackOfFit test{rss / dof, fisher_f_p(std::min(rss / dof, largest_F), dof, noise_dof), dof};
  if (test.p < 0.05) return {rss / dof, dof, test};
  return {(rss + noise_dof) / (dof + noise_dof), dof + noise_dof, test};
}

namespace {

// A fit that the poses do not determine gives no information on any of them.
PoseSelection without_search(const NormData& data, const NormFit& fit, PoseSelection now) {
  const std::size_t n = data.poses.size();
  now.fit = fit;
  now.leave_one_out.resize(n);
  now.studentised.resize(n);
  now.detectable.resize(n);
  return now;
}

bool well_conditioned(const NormFit& fit) {
  constexpr double singular = 1e6;
  return fit.condition < singular && std::isfinite(fit.rss) && fit.cofactor.allFinite();
}

}  // namespace

Result<PoseSelection> select_poses(const NormData& data,
                                   const Parameters& start,
                                   const SelectionOptions& options) {
  const std::size_t n = data.poses.size();
  PoseSelection now;
  now.used.assign(n, true);
  now.suspect.assign(n, false);
  const Result<NormFit> full = fit_norm(data, now.used, options.free, start);
  if (!full) return full.error();
  if (!well_conditioned(*full)) return without_search(data, *full, std::move(now));
  PoseHypotheses hypotheses(data, options.free, *full);
  Choice choice(hypotheses, n, options);
  const PoseSet out = choice.fewest();
  const Scatter unexplained = choice.scatter_without(out);
  const double room = clearly_worse * std::max(unexplained.factor, 1e-20);
  const std::vector<PoseSet> alike = hypotheses.alike(out, hypotheses.without(out)->rss + room);
  auto [bad, doubtful] = suspects_and_doubtful(alike, hypotheses);
  now.alike = std::move(doubtful);
  for (const std::size_t k : bad) now.suspect[k] = true;
  if (options.keep_suspects) bad.clear();
  for (const std::size_t k : bad) now.used[k] = false;
  now.fit = *hypotheses.without(bad);
  now.scatter = options.keep_suspects ? choice.scatter_without(bad) : unexplained;
  now.lack_of_fit = choice.scatter_without(bad).lack_of_fit;
  judge(hypotheses.shifts(now.fit), bad, options.noise_dof, now);
  const std::vector<PoseSet> possible = out.empty() ? choice.in_question() : alike;
  if (possible.size() > 1 && !options.keep_suspects) {
    average(hypotheses, possible, now);
    now.fit.terms = terms_of(data.poses, now.fit.p);
  }
  now.weights = residual_weights(data, now.fit.terms, now.used);
  return now;
}

}  // namespace proofmass::calibrate
