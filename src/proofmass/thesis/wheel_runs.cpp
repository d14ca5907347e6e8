#include "proofmass/thesis/wheel_runs.hpp"

#include <algorithm>
#include <iterator>
#include <utility>

#include "proofmass/thesis/motor/speed_items.hpp"
#include "proofmass/thesis/motor/turning_items.hpp"
#include "proofmass/thesis/motor/wheel_path_items.hpp"
#include "proofmass/thesis/wheel/conclusion_items.hpp"
#include "proofmass/thesis/wheel/study.hpp"

namespace proofmass::thesis {

Result<std::vector<Item>> wheel_items(const std::vector<WheelRecord>& records,
                                      const WheelRunsOptions& options) {
  const Result<WheelStudy> study = study_wheel(records, options);
  if (!study) return study.error();
  Result<std::vector<Item>> paths = wheel_path_items(*study);
  if (!paths) return paths.error();
  Result<std::vector<Item>> turning = turning_items(*study);
  if (!turning) return turning.error();
  std::vector<Item> items = std::move(paths).value();
  items.push_back(speed_item(*study));
  for (std::vector<Item> more : {std::move(turning).value(), conclusion_items(*study)})
    std::ranges::move(more, std::back_inserter(items));
  return items;
}

}  // namespace proofmass::thesis
