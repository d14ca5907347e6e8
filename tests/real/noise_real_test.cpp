// Two runs of a static ADIS16405 (100 Hz, a million samples per axis, quantisation step 3.33 mg)
// and the phase record distributed with Stable32. The values for the first were computed once with
// NumPy and SciPy from their definitions.
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <gtest/gtest.h>
#include <string>

#include "proofmass/characterise/noise_analysis.hpp"
#include "proofmass/io/read_recording.hpp"
#include "published_data.hpp"

namespace proofmass::noise_real_test {
namespace {

using characterise::DeviationPoint;
using characterise::NoiseAnalysis;
using characterise::NoiseOptions;
using characterise::SeriesKind;
using characterise::Statistic;
using characterise::TauGrid;
using characterise::Verdict;

constexpr double rate_hz = 100.0;
constexpr double lsb_mg = 3.33;

struct Axis {
  int run;
  const char* channel;
  double at_100_ms, at_1_s, at_10_s, at_100_s, at_1000_s;  ///< Allan deviation, mg
  double density_mg_rthz;  ///< one-sided, root of the mean PSD from 20 to 40 Hz
};

// GoogleTest requires a printer of exactly this name.
// NOLINTNEXTLINE(readability-identifier-naming)
void PrintTo(const Axis& axis, std::ostream* out) {
  *out << "run " << axis.run << " " << axis.channel;
}

std::filesystem::path file_of(const Axis& axis) {
  return published_data() / "adis16405-static" /
         ("adis16405_run" + std::to_string(axis.run) + "_acc_g.csv.xz");
}

/// One axis in mg.
std::vector<double> samples_of(const Axis& axis) {
  const Recording recording =
      io::read_recording(file_of(axis).string(), {.rate_hz = rate_hz}).value();
  const auto channel =
      std::find_if(recording.channels.begin(), recording.channels.end(),
                   [&](const Channel& c) { return c.name.starts_with(axis.channel); });
  EXPECT_NE(channel, recording.channels.end()) << axis.channel;
  if (channel == recording.channels.end()) return {};
  std::vector<double> mg = channel->values.copy();
  for (double& value : mg) value *= 1e3;
  return mg;
}

class RestingAdis16405 : public testing::TestWithParam<Axis> {
 protected:
  void SetUp() override {
    if (!std::filesystem::exists(file_of(GetParam()))) GTEST_SKIP() << absent(file_of(GetParam()));
  }
  [[nodiscard]] static NoiseAnalysis analysed(TauGrid taus = {}) {
    NoiseOptions options;
    options.rate_hz = rate_hz;
    options.taus = std::move(taus);
    options.lsb = lsb_mg;
    return analyse_noise(samples_of(GetParam()), options).value();
  }
};

TEST_P(RestingAdis16405, HasTheAllanDeviationOfItsDefinition) {
  const Axis& axis = GetParam();
  const NoiseAnalysis found =
      analysed({.kind = TauGrid::Kind::given, .times_s = {0.1, 1.0, 10.0, 100.0, 1000.0}});
  EXPECT_EQ(found.samples, 1'000'000U);
  EXPECT_EQ(found.missing, 0U);
  const std::vector expected{axis.at_100_ms, axis.at_1_s, axis.at_10_s, axis.at_100_s,
                             axis.at_1000_s};
  ASSERT_EQ(found.deviation.points.size(), expected.size());
  for (std::size_t k = 0; k < expected.size(); ++k) {
    const DeviationPoint& point = found.deviation.points[k];
    EXPECT_NEAR(point.value / expected[k], 1.0, 0.001) << point.tau_s << " s";
    EXPECT_LT(point.lower, point.value);
    EXPECT_GT(point.upper, point.value);
  }
}

TEST_P(RestingAdis16405, HasTheFloorsThatWerePublished) {
  const NoiseAnalysis found = analysed();
  const auto lowest =
      std::min_element(found.deviation.points.begin(), found.deviation.points.end(),
                       [](const auto& a, const auto& b) { return a.value < b.value; });
  EXPECT_GT(lowest->value, 0.18);
  EXPECT_LT(lowest->value, 0.34);
  // The level of the spectrum, in a band selected by the analysis.
  EXPECT_NEAR(found.lines.floor.one_sided_density / GetParam().density_mg_rthz, 1.0, 0.1);
}

TEST_P(RestingAdis16405, HasTheSpectrumThatSciPyFinds) {
  const NoiseAnalysis found = analysed();
  double sum = 0.0, bins = 0.0;
  for (std::size_t k = 0; k < found.spectrum.frequency_hz.size(); ++k) {
    const double f = found.spectrum.frequency_hz[k];
    if (f <= 20.0 || f >= 40.0) continue;
    sum += found.spectrum.one_sided_psd[k];
    bins += 1.0;
  }
  EXPECT_NEAR(std::sqrt(sum / bins) / GetParam().density_mg_rthz, 1.0, 0.001);
}

TEST_P(RestingAdis16405, ShowsTheBuildingAndKeepsItOutOfTheWhiteNoise) {
  const NoiseAnalysis found = analysed();
  const auto near = [&](double frequency_hz, double within_hz) {
    return std::any_of(found.lines.lines.begin(), found.lines.lines.end(), [&](const auto& line) {
      return std::abs(line.frequency_hz - frequency_hz) < within_hz;
    });
  };
  EXPECT_TRUE(near(0.562, 0.025));
}

// At 1 s the curve shows the motion of the building; the white coefficient is the level below the
// filter, which removes a fifth of it at 30 Hz.
TEST_P(RestingAdis16405, ItsWhiteCoefficientIsThatOfTheSpectrumWithoutTheBuilding) {
  const NoiseAnalysis found = analysed();
  EXPECT_EQ(found.model.white.verdict, Verdict::identified);
  const double in_band = std::sqrt(2.0 * found.model.density(30.0));
  EXPECT_NEAR(in_band / GetParam().density_mg_rthz, 1.0, 0.05);
  double sum = 0.0, bins = 0.0;
  for (std::size_t k = 0; k < found.spectrum.frequency_hz.size(); ++k) {
    const double f = found.spectrum.frequency_hz[k];
    if (f <= 4.0 || f >= 8.0) continue;
    sum += 0.5 * found.spectrum.one_sided_psd[k];
    bins += 1.0;
  }
  EXPECT_NEAR(found.model.white.value / std::sqrt(sum / bins), 1.0, 0.05);
  EXPECT_LT(found.model.white.value, 0.8 * GetParam().at_1_s);
}

TEST_P(RestingAdis16405, ItsConverterIsCoarseAndItSaysSo) {
  const NoiseAnalysis found = analysed();
  EXPECT_TRUE(std::any_of(found.notes.begin(), found.notes.end(), [](const Note& note) {
    return note.severity == Severity::warning &&
           note.text.find("quantisation step") != std::string::npos;
  }));
}

INSTANTIATE_TEST_SUITE_P(
    Axes,
    RestingAdis16405,
    testing::Values(Axis{1, "acc_x", 1.4140, 0.7207, 0.2948, 0.3381, 0.8664, 0.5237},
                    Axis{1, "acc_y", 1.1509, 0.5122, 0.2238, 0.2845, 0.3155, 0.4334},
                    Axis{1, "acc_z", 1.4484, 0.6206, 0.2344, 0.2406, 0.4198, 0.5499},
                    Axis{2, "acc_x", 1.3697, 0.7272, 0.3256, 0.5058, 0.3770, 0.5135},
                    Axis{2, "acc_y", 1.0482, 0.4472, 0.1988, 0.3095, 0.4364, 0.4001},
                    Axis{2, "acc_z", 1.4268, 0.6279, 0.2293, 0.3271, 0.5003, 0.5459}));

// Stable32's own phase record, with its Allan deviation and limits (phase_dat_oadev_octave.txt).
TEST(Stable32Phase, ReadAsAFileHasItsDeviationAndLimits) {
  const auto file = published_data() / "allan-reference/phasedat/PHASE.DAT";
  if (!std::filesystem::exists(file)) GTEST_SKIP() << absent(file);
  const auto recording = io::read_recording(file.string(), {.rate_hz = 1.0});
  ASSERT_TRUE(recording.has_value()) << recording.error().message;
  ASSERT_EQ(recording->samples(), 1001U);
  NoiseOptions options;
  options.rate_hz = 1.0;
  options.kind = SeriesKind::phase;
  options.taus.kind = TauGrid::Kind::octave;
  options.noise_type = characterise::NoiseTypeSource::lag1;
  const auto found = analyse_noise(recording->channels.front().values, options).value();
  struct Row {
    double lower, deviation, upper;
  };
  const std::vector<Row> rows = {
      {2.8515e-01, 2.9223e-01, 2.9987e-01}, {1.9520e-01, 2.0102e-01, 2.0738e-01},
      {1.3931e-01, 1.4479e-01, 1.5098e-01}, {1.0038e-01, 1.0570e-01, 1.1198e-01},
      {5.7696e-02, 6.1915e-02, 6.7217e-02}, {4.3654e-02, 4.8082e-02, 5.4202e-02},
      {3.1755e-02, 3.6237e-02, 4.3377e-02}};
  ASSERT_GE(found.deviation.points.size(), rows.size());
  for (std::size_t k = 0; k < rows.size(); ++k) {
    const DeviationPoint& point = found.deviation.points[k];
    EXPECT_NEAR(point.value / rows[k].deviation, 1.0, 5e-5) << point.tau_s;
    EXPECT_NEAR(point.lower / rows[k].lower, 1.0, 0.005) << point.tau_s;
    EXPECT_NEAR(point.upper / rows[k].upper, 1.0, 0.005) << point.tau_s;
  }
}

}  // namespace
}  // namespace proofmass::noise_real_test
