#include <gtest/gtest.h>
#include <map>

#include "proofmass/calibrate/tumble_test_support.hpp"

// Coverage of the 95 % intervals on a simulated table.
namespace proofmass::calibrate::tumble_slow_test {
namespace {

struct Mode {
  const char* name;
  std::vector<TumblePosition> plan;
  TableTruth truth;
  TumbleOptions options = table_options();
  bool noise_stated = false;
};

TableTruth drifting() {
  TableTruth truth;
  truth.noise = 3e-6;
  truth.drift_mps2 = 2e-5;
  return truth;
}

TableTruth with_play() {
  TableTruth truth = drifting();
  truth.hysteresis_mps2 = 3e-4;
  truth.backlash_rad = 1e-4;
  return truth;
}

TableTruth with_indexing(TableTruth truth) {
  truth.index_cos = 3e-5;
  truth.index_sin = -2e-5;
  return truth;
}

std::vector<Mode> modes() {
  std::vector<TumblePosition> planes = table_turn(12, true), mounts = planes, all;
  append(planes, in_plane(table_turn(12, true), 2));
  append(mounts, mounted_at(table_turn(12, true), 180.0));
  std::vector<TumblePosition> three = mounts, turns = table_turn(4, true);
  append(three, mounted_at(table_turn(12, true), 90.0));
  append(all, there_and_back(12));
  append(all, mounted_at(there_and_back(12), 180.0));
  append(all, in_plane(there_and_back(12), 2));
  for (int k = 0; k < 2; ++k) append(turns, table_turn(4, true));
  TableTruth twice = with_indexing(drifting()), unset = drifting(), no_cube = drifting();
  twice.index_cos2 = 1e-5;
  twice.index_sin2 = 2e-5;
  unset.setting_rad = 2e-5;
  no_cube.K3 = 0.0;
  TumbleOptions indexed = table_options();
  indexed.indexing_std_rad = 2e-5;
  return {{"one plane", table_turn(12, true), drifting()},
          {"one plane, noise stated", table_turn(24, true), drifting(), table_options(), true},
          {"four points, three turns", turns, no_cube},
          {"two planes", planes, drifting()},
          {"two planes, noise stated", planes, drifting(), table_options(), true},
          {"forwards and backwards", there_and_back(12), with_play()},
          {"mounted at 0 and 180", mounts, with_indexing(drifting())},
          {"mounted at 0, 180 and 90", three, twice},
          {"all of it", all, with_indexing(with_play())},
          {"indexing stated", table_turn(24, true), unset, indexed},
          {"indexing stated, both ways", there_and_back(12), unset, indexed},
          {"indexing and noise stated", table_turn(24, true), unset, indexed, true}};
}

struct Count {
  int inside = 0, all = 0;
};

TEST(Tumble, HoldsTheTruthInside95PercentOfItsIntervals) {
  constexpr int runs = 3000;
  std::mt19937_64 random(5);
  for (const Mode& mode : modes()) {
    std::map<TumbleQuantity, Count> counts;
    int suspects = 0;
    for (int run = 0; run < runs; ++run) {
      std::vector<TumblePosition> read = read_table(mode.plan, mode.truth, random);
      if (mode.noise_stated)
        for (TumblePosition& p : read) p.output_std = mode.truth.noise;
      const TumbleFit fit = fit_tumble(read, mode.options).value();
      for (const TumbleCoefficient& c : fit.coefficients) {
        if (!c.half_width_95 || (c.plane == 1 && c.mount_rad > 1e-9)) continue;
        Count& count = counts[c.quantity];
        const double truth = true_value(mode.truth, c.quantity, read.size());
        ++count.all;
        if (std::abs(*c.value - truth) <= *c.half_width_95) ++count.inside;
      }
      for (const TumbleResidual& r : fit.positions) suspects += r.suspect ? 1 : 0;
    }
    // A stated error of the angles is adjusted to the residuals, which is cautious.
    const double most = mode.options.indexing_std_rad == 2e-5 ? 0.99 : 0.97;
    for (const auto& [quantity, count] : counts) {
      const double part = static_cast<double>(count.inside) / count.all;
      EXPECT_GT(part, 0.93) << mode.name << ": " << name_of(quantity);
      EXPECT_LT(part, most) << mode.name << ": " << name_of(quantity);
      EXPECT_GT(count.all, runs / 2) << mode.name << ": " << name_of(quantity);
    }
    EXPECT_LT(suspects, runs / 33) << mode.name;
  }
}

}  // namespace
}  // namespace proofmass::calibrate::tumble_slow_test
