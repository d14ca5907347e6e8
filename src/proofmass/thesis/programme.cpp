#include "proofmass/thesis/programme.hpp"

#include <algorithm>
#include <array>
#include <functional>
#include <string_view>
#include <utility>

#include "proofmass/core/in_parallel.hpp"
#include "proofmass/thesis/budget_items.hpp"
#include "proofmass/thesis/gain_items.hpp"
#include "proofmass/thesis/motor_items.hpp"
#include "proofmass/thesis/servo_items.hpp"

namespace proofmass::thesis {
namespace {

// In the order in which the thesis has them.
constexpr std::array<std::string_view, 27> order{
    "table 2.1",   "figure 4.3",  "figure 4.5",  "table 4.1",   "figure 4.6",  "figure 5.2",
    "figure 5.3",  "figure 5.4",  "figure 5.5",  "figure 5.6",  "table 5.1",   "figure 5.7",
    "figure 5.8",  "figure 5.9",  "figure 5.10", "figure 5.12", "figure 5.13", "figure 5.14",
    "figure 5.15", "figure 5.16", "figure 5.17", "figure 5.18", "figure 5.19", "section 6.1",
    "section 6.2", "table A.1",   "section A.2"};

std::size_t place_of(const Item& item) {
  return static_cast<std::size_t>(std::ranges::find(order, item.id) - order.begin());
}

using Items = Result<std::vector<Item>>;

Items still_items(const OwnRecordings& own,
                  const ProgrammeOptions& options,
                  const Progress& report_progress) {
  Result<StaticRecord> record =
      own.still ? Result<StaticRecord>(*own.still)
                : simulate_static(options.seed, report_progress, options.static_duration_s);
  if (!record) return record.error();
  Result<StaticTest> test = analyse_static(std::move(record).value(), report_progress);
  if (!test) return test.error();
  return static_items(*test);
}

Items turned_items(const OwnRecordings& own, const ProgrammeOptions& options) {
  Result<TumbleRecord> record = own.tumble ? Result<TumbleRecord>(*own.tumble)
                                           : simulate_tumble(options.seed, options.gravity_mps2);
  if (!record) return record.error();
  return tumble_items(*record, options.gravity_mps2);
}

}  // namespace

Result<Programme> run_programme(const OwnRecordings& own, const ProgrammeOptions& options) {
  // The longest first, so that the others fill what is left of the processors.
  const std::vector<std::function<Items(const Progress&)>> work{
      [&](const Progress& report_progress) {
        return wheel_items(own.wheel, {.seed = options.seed,
                                       .seeds = options.seeds,
                                       .gravity_mps2 = options.gravity_mps2,
                                       .progress = report_progress});
      },
      [&](const Progress& report_progress) { return still_items(own, options, report_progress); },
      [&](const Progress&) { return Items(gain_items(options.seed)); },
      [&](const Progress&) { return turned_items(own, options); },
      [&](const Progress&) { return Items(budget_items()); },
      [&](const Progress&) { return Items(motor_items()); },
      [&](const Progress& report_progress) { return servo_items(options.seed, report_progress); }};
  std::vector<Items> parts(work.size(), std::vector<Item>{});
  in_parallel(work.size(), options.progress, [&](std::size_t k, const Progress& report_progress) {
    parts[k] = work[k](report_progress);
  });
  Programme programme;
  if (!own.still) programme.simulated.emplace_back("static");
  if (!own.tumble) programme.simulated.emplace_back("tumble");
  if (own.wheel.empty()) programme.simulated.emplace_back("wheel");
  for (Items& part : parts) {
    if (!part) return part.error();
    for (Item& item : std::move(part).value()) programme.items.push_back(std::move(item));
  }
  std::ranges::stable_sort(programme.items, {}, place_of);
  return programme;
}

}  // namespace proofmass::thesis
