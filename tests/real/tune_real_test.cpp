// Noise parameters of published recordings: a static ADIS16405 (100 Hz), a static Xsens unit
// (counts) and a barbell in motion.
#include <cmath>
#include <filesystem>
#include <gtest/gtest.h>
#include <string>
#include <vector>

#include "proofmass/core/units.hpp"
#include "proofmass/estimate/tune.hpp"
#include "proofmass/estimate/tune/score.hpp"
#include "proofmass/io/read_recording.hpp"
#include "published_data.hpp"

namespace proofmass::tune_real_test {
namespace {

using estimate::TuneModel;
using estimate::Tuning;

Recording part_of(const std::filesystem::path& file, double rate_hz, double duration_s) {
  io::ReadOptions options;
  options.rate_hz = rate_hz;
  const Recording recording = io::read_recording(file.string(), options).value();
  return cut(recording, 0.0, duration_s).value();
}

Tuning tuned(const std::vector<double>& values, TuneModel model) {
  return estimate::tune({{.name = "x", .rate_hz = 100.0, .segments = {values}}}, {.model = model})
      .value();
}

// At one standard deviation along each axis, the log-likelihood is lower by about a half: that of
// the values which the tuning used, all but the outliers.
void expect_summit(const Tuning& tuning, std::vector<double> values) {
  const std::vector<double>& innovation = tuning.series[0].innovation;
  std::size_t unused = 0;
  for (std::size_t k = 1; k < values.size(); ++k) {
    if (!std::isnan(innovation[k])) continue;
    values[k] = innovation[k];
    ++unused;
  }
  EXPECT_EQ(unused, tuning.series[0].outliers.count);
  for (std::size_t j = 0; j < tuning.parameters.size(); ++j) {
    if (!tuning.parameters[j].value) continue;
    for (const double sign : {-1.0, 1.0}) {
      std::vector<double> moved = tuning.series[0].values;
      const Uncertain& figure = *tuning.parameters[j].value;
      moved[j] *= std::exp(sign * figure.std / figure.value);
      const double lost =
          tuning.log_likelihood -
          log_likelihood(estimate::system_of(tuning.model, moved, 0.01), values).log_likelihood;
      EXPECT_GT(lost, 0.3) << tuning.parameters[j].name;
      EXPECT_LT(lost, 1.5) << tuning.parameters[j].name;
    }
  }
}

TEST(TunedAdis16405, HasTheDensityThatItsSpectrumHas) {
  const auto file = published_data() / "adis16405-static" / "adis16405_run1_acc_g.csv.xz";
  if (!std::filesystem::exists(file)) GTEST_SKIP() << absent(file);
  const Recording recording = part_of(file, 100.0, 600.0);
  std::vector<double> values = recording.channels[0].values.copy();
  for (double& value : values) value *= standard_gravity_mps2;
  const Tuning found = tuned(values, TuneModel::rest);
  // One-sided floor 0.524 mg/√Hz at 20 to 40 Hz; the building's lines add to the white noise.
  const double floor = 0.524e-3 * standard_gravity_mps2 / std::sqrt(2.0);
  ASSERT_TRUE(found.parameters[0].value.has_value());
  EXPECT_NEAR(found.parameters[0].value->value / floor, 1.05, 0.05);
  EXPECT_TRUE(found.parameters[1].value.has_value());
  expect_summit(found, values);
  // An apparent fast random walk is due to the building's sway, which averages to zero.
  const estimate::Consistency consistency = estimate::consistency_of(found);
  EXPECT_EQ(consistency.verdict, estimate::Verdict::coloured);
  EXPECT_EQ(consistency.nis > 0.99 && consistency.nis < 1.01, true);
}

TEST(TunedXsens, WalksOnOneAxisAndNotToBeSeenOnAnother) {
  const auto file = published_data() / "imu-tk-xsens" / "xsens_acc.mat.xz";
  if (!std::filesystem::exists(file)) GTEST_SKIP() << absent(file);
  const Recording recording = part_of(file, 100.0, 50.0);
  std::vector<Tuning> axes;
  for (const char* name : {"x", "z"}) {
    const Channel* channel = recording.find(name);
    ASSERT_NE(channel, nullptr) << name;
    axes.push_back(tuned(channel->values.copy(), TuneModel::rest));
    expect_summit(axes.back(), channel->values.copy());
  }
  EXPECT_NEAR(axes[0].parameters[0].value->value, 0.334, 0.02);  // counts/√Hz
  EXPECT_FALSE(axes[0].parameters[1].value.has_value());
  EXPECT_LT(axes[0].parameters[1].upper_95.value_or(1.0), 0.3);
  ASSERT_TRUE(axes[1].parameters[1].value.has_value());
  EXPECT_NEAR(axes[1].parameters[1].value->value, 0.79, 0.3);
}

TEST(TunedBarbell, MovesUpAndDownMoreThanSideways) {
  const auto file = published_data() / "phyphox-barbell-strokes" /
                    "Acceleration without g 2024-01-17 08-15-45" / "Raw Data.csv.xz";
  if (!std::filesystem::exists(file)) GTEST_SKIP() << absent(file);
  const Recording recording = io::read_recording(file.string(), {}).value();
  const auto jerk_psd = [&](const char* name) {
    const Tuning found = tuned(recording.find(name)->values.copy(), TuneModel::pva);
    return found.parameters[1].value ? found.parameters[1].value->value : 0.0;
  };
  const double up = jerk_psd("Linear Acceleration z"), sideways = jerk_psd("Linear Acceleration x");
  EXPECT_GT(sideways, 0.0);
  EXPECT_GT(up, 100.0 * sideways);
}

}  // namespace
}  // namespace proofmass::tune_real_test
