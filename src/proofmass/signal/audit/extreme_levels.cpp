#include "proofmass/signal/audit/extreme_levels.hpp"

#include <algorithm>
#include <limits>

namespace proofmass::signal {

ExtremeLevels levels_at_lowest(std::vector<double> values) {
  constexpr std::size_t most_beside = 8;
  std::ranges::sort(values);
  ExtremeLevels out;
  double step = std::numeric_limits<double>::infinity();
  for (std::size_t from = 0, end = 0; from < values.size() && out.beside < most_beside;
       from = end) {
    while (end < values.size() && values[end] == values[from]) ++end;
    if (from == 0) {
      out.at_extreme = end;
      continue;
    }
    ++out.beside;
    out.most_frequent = std::max(out.most_frequent, end - from);
    step = std::min(step, values[from] - values[from - 1]);
  }
  if (out.beside > 0) out.step = step;
  return out;
}

}  // namespace proofmass::signal
