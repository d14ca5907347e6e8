#include "proofmass/calibrate/multi_position/pose_hypotheses.hpp"

#include <algorithm>
#include <iterator>

namespace proofmass::calibrate {
namespace {

constexpr std::size_t kept_of_all = 8;      // linear candidates to be fitted
constexpr std::size_t most_alike = 60;      // fits to sets that explain the residuals as well
constexpr std::size_t most_of_pairs = 400;  // poses up to which all pairs are tried
constexpr double unfit = 1e6;               // of a condition

struct Scored {
  double rss;
  PoseSet out;
};

void add_scored(const PoseShifts& shifts, PoseSet out, std::vector<Scored>& all) {
  std::ranges::sort(out);
  if (const auto rss = shifts.rss_without(out)) all.push_back({*rss, std::move(out)});
}

// Every set of one or two poses.
std::vector<Scored> every_set(const PoseShifts& shifts, std::size_t size) {
  std::vector<Scored> all;
  const std::size_t n = shifts.poses();
  for (std::size_t k = 0; k < n; ++k) {
    if (size == 1) add_scored(shifts, {k}, all);
    if (size == 1 || n > most_of_pairs) continue;
    for (std::size_t l = k + 1; l < n; ++l) add_scored(shifts, {k, l}, all);
  }
  return all;
}

// Sets with one pose exchanged.
std::vector<Scored> neighbours(const PoseShifts& shifts, const PoseSet& out) {
  std::vector<Scored> all;
  for (std::size_t member = 0; member < out.size(); ++member) {
    PoseSet others = out;
    others.erase(others.begin() + static_cast<std::ptrdiff_t>(member));
    const PoseShifts rest = shifts.without(others);
    for (std::size_t k = 0; k < shifts.poses(); ++k) {
      if (std::ranges::count(out, k) > 0) continue;
      const auto rss = rest.rss_without({k});
      if (!rss) continue;
      PoseSet set = others;
      set.insert(std::ranges::upper_bound(set, k), k);
      all.push_back({*rss, std::move(set)});
    }
  }
  return all;
}

std::vector<PoseSet> first_of(std::vector<Scored> all, std::size_t most) {
  const std::size_t count = std::min(most, all.size());
  const auto middle = all.begin() + static_cast<std::ptrdiff_t>(count);
  std::ranges::partial_sort(all, middle, {}, &Scored::rss);
  std::vector<PoseSet> out;
  std::transform(all.begin(), middle, std::back_inserter(out),
                 [](const Scored& scored) { return scored.out; });
  return out;
}

}  // namespace

PoseHypotheses::PoseHypotheses(const NormData& data, NormParameters free, const NormFit& full)
    : data_(data), free_(free), full_(full) {
  points_.push_back(shifts(full));
  const std::size_t n = data.poses.size(), count = static_cast<std::size_t>(free);
  if (n < count + 4) return;
  const RobustStart robust = robust_start(data.poses, free, full.p);
  const auto kept = static_cast<std::size_t>(std::ranges::count(robust.kept, true));
  suspicious_ = kept < n;
  if (!suspicious_ || kept < count + 2) return;
  const Result<NormFit> fit = fit_norm(data, robust.kept, free, robust.p);
  if (fit && fit->condition < unfit) points_.push_back(shifts(*fit));
}

PoseShifts PoseHypotheses::shifts(const NormFit& fit) const {
  return {data_, fit.terms, free_};
}

const NormFit* PoseHypotheses::without(const PoseSet& out) {
  if (out.empty()) return &full_;
  const auto [place, anew] = fits_.try_emplace(out);
  if (anew && out.size() + static_cast<std::size_t>(free_) <= data_.poses.size()) {
    std::vector<bool> used(data_.poses.size(), true);
    for (const std::size_t k : out) used[k] = false;
    Result<NormFit> fit = fit_norm(data_, used, free_, full_.p);
    if (fit && fit->condition < unfit && std::isfinite(fit->rss))
      place->second = std::move(fit).value();
  }
  return place->second ? &*place->second : nullptr;
}

// Those that can be fitted, the best one first.
std::vector<PoseSet> PoseHypotheses::fitted(const std::vector<PoseSet>& sets) {
  std::vector<Scored> all;
  for (const PoseSet& set : sets)
    if (const NormFit* fit = without(set)) all.push_back({fit->rss, set});
  return first_of(std::move(all), sets.size());
}

std::vector<PoseSet> PoseHypotheses::best(std::size_t size) {
  std::vector<PoseSet> sets;
  const auto add = [&](const PoseShifts& point) {
    for (PoseSet& set : first_of(every_set(point, size), kept_of_all))
      if (std::ranges::count(sets, set) == 0) sets.push_back(std::move(set));
    sets = fitted(sets);
  };
  for (const PoseShifts& point : points_) add(point);
  if (!sets.empty()) add(shifts(*without(sets.front())));
  return sets;
}

std::optional<double> PoseHypotheses::linear_rss(std::size_t size) const {
  std::optional<double> least;
  for (const PoseShifts& point : points_)
    for (const Scored& one : every_set(point, size))
      if (!least || one.rss < *least) least = one.rss;
  return least;
}

std::vector<PoseSet> PoseHypotheses::alike(const PoseSet& best, double rss) {
  const NormFit* fit = without(best);
  if (best.empty() || fit == nullptr) return {best};
  const PoseShifts point = shifts(*fit);
  std::vector<Scored> all =
      best.size() <= 2 ? every_set(point, best.size()) : neighbours(point, best);
  // The nonlinear part is small: twice the distance leaves room for it.
  std::erase_if(
      all, [&](const Scored& one) { return one.rss > 2.0 * rss - fit->rss || one.out == best; });
  std::vector<PoseSet> out{best};
  for (const PoseSet& set : fitted(first_of(std::move(all), most_alike)))
    if (without(set)->rss <= rss) out.push_back(set);
  return out;
}

PoseSet PoseHypotheses::trimmed(std::size_t most) const {
  const std::vector<bool> kept =
      least_trimmed(data_.poses, free_, full_.p, data_.poses.size() - most);
  PoseSet out;
  for (std::size_t k = 0; k < kept.size(); ++k)
    if (!kept[k]) out.push_back(k);
  return out;
}

}  // namespace proofmass::calibrate
