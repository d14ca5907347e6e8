#include "proofmass/signal/events/findings.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace proofmass::signal {

void merge_hits(std::vector<Hit>& hits, std::size_t apart) {
  std::ranges::sort(hits, {}, [](const Hit& hit) { return hit.at.first; });
  std::size_t kept = 0;
  for (const Hit& hit : hits) {
    if (kept > 0 && hit.at.first <= hits[kept - 1].at.last + apart) {
      Hit& before = hits[kept - 1];
      before.at.last = std::max(before.at.last, hit.at.last);
      before.sigmas = std::max(before.sigmas, hit.sigmas);
    } else {
      hits[kept++] = hit;
    }
  }
  hits.resize(kept);
}

double departure(View<double> m, std::size_t k, std::size_t w, bool ends) {
  const auto at = [&](std::ptrdiff_t windows) {
    const auto place = static_cast<std::ptrdiff_t>(k) + windows * static_cast<std::ptrdiff_t>(w);
    const bool inside = place >= 0 && place < static_cast<std::ptrdiff_t>(m.size());
    return inside ? m[static_cast<std::size_t>(place)] : nan;
  };
  const auto level = [&](std::ptrdiff_t way) {
    const double near = at(way);
    const double far = at(2 * way);
    return std::isnan(near) ? far : std::isnan(far) ? near : 0.5 * (near + far);
  };
  const double from_before = m[k] - level(-1);
  const double from_after = m[k] - level(1);
  if (!std::isnan(from_before + from_after)) {
    if (from_before * from_after <= 0.0) return 0.0;
    return std::abs(from_before) < std::abs(from_after) ? from_before : from_after;
  }
  if (!ends) return nan;
  const std::ptrdiff_t way = std::isnan(from_after) ? -1 : 1;
  // The factor 1/√2 gives the same scatter as the filter output away from the ends.
  return (m[k] - at(way) - 0.5 * at(2 * way) + 0.5 * at(4 * way)) * (0.5 * std::numbers::sqrt2);
}

}  // namespace proofmass::signal
