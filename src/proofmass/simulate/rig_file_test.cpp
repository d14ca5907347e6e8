#include "proofmass/simulate/rig_file.hpp"

#include <filesystem>
#include <fstream>
#include <gtest/gtest.h>
#include <unistd.h>

namespace proofmass::simulate::rig_file_test {
namespace {

std::string error_of(std::string_view text) {
  const auto options = parse_rig_file(text, "rig.toml");
  return options ? "no error" : options.error().message;
}

RigOptions unusual() {
  RigOptions o;
  o.seed = 123456789012345;
  o.rate_hz = 1000.0 / 3.0;
  o.axes = 2;
  o.output = RigOutput::counts;
  o.datasheet_errors = true;
  o.wheel.start_angle_rad = 30.0 * rad_per_deg;
  o.wheel.profile = {{.duration_s = 1.5},
                     {.duration_s = 2.0, .speed_radps = -8.0 * radps_per_rpm, .ramp_s = 0.25}};
  o.wheel.ripple.random_fraction_rms = 0.01;
  o.supply.recorded = true;
  o.daq = {.bits = 14, .min_v = -1.0, .max_v = 1.0, .skew_s = 2.0833e-5};
  o.sensors.resize(1);
  o.sensors[0].cross_axis = {0.01, 0.02, 0.03, 0.04, 0.05, 0.06};
  o.sensors[0].bias_mps2 = {0.1, 1.0 / 3.0, -1e-9};
  o.sensors[0].filter_signal = true;
  return o;
}

// Checks that the options are equal in everything that a file can express, by comparing their
// texts.
void expect_same(const RigOptions& a, const RigOptions& b) {
  EXPECT_EQ(format_rig_file(a), format_rig_file(b));
}

TEST(RigFile, ComesBackTheSame) {
  for (const RigOptions& options : {RigOptions{}, unusual()}) {
    const std::string text = format_rig_file(options);
    const auto back = parse_rig_file(text, "rig.toml");
    ASSERT_TRUE(back) << back.error().message << text;
    expect_same(*back, options);
    EXPECT_EQ(back->seed, options.seed);
    EXPECT_EQ(back->rate_hz, options.rate_hz);
    EXPECT_EQ(back->output, options.output);
    EXPECT_EQ(back->wheel.profile.size(), options.wheel.profile.size());
    EXPECT_EQ(back->wheel.profile.back().speed_radps, options.wheel.profile.back().speed_radps);
    EXPECT_EQ(back->sensors.back().position_rad, options.sensors.back().position_rad);
    EXPECT_EQ(back->sensors[0].bias_mps2, options.sensors[0].bias_mps2);
    EXPECT_EQ(back->sensors[0].cross_axis, options.sensors[0].cross_axis);
    EXPECT_EQ(back->sensors[0].filter_signal, options.sensors[0].filter_signal);
    EXPECT_EQ(back->daq.skew_s, options.daq.skew_s);
  }
}

TEST(RigFile, PrintsWhatAPersonWouldWrite) {
  const std::string text = format_rig_file(RigOptions{});
  for (const char* line : {"\nspeed_rpm = 11 ", "\nrate_hz = 200 ", "\nposition_deg = 180 ",
                           "\nnoise_rms_mps2 = [0.0184, 0.0184, 0.0184] ", "\nfraction = 0.02 "})
    EXPECT_NE(text.find(line), std::string::npos) << line << "\n" << text;
}

TEST(RigFile, AnEmptyOneIsTheDefault) {
  expect_same(parse_rig_file("", "rig.toml").value(), RigOptions{});
}

TEST(RigFile, ListsReplaceTheDefaults) {
  const RigOptions o = parse_rig_file(R"toml(
[[segment]]
duration_s = 10
speed_rpm = 30
[[segment]]
duration_s = 5
[[sensor]]
radius_m = 0.05
mounting_deg = 90
)toml",
                                      "rig.toml")
                           .value();
  ASSERT_EQ(o.wheel.profile.size(), 2U);
  EXPECT_DOUBLE_EQ(o.wheel.profile[0].speed_radps, std::numbers::pi);
  EXPECT_EQ(o.wheel.profile[1].speed_radps, 0.0);
  ASSERT_EQ(o.sensors.size(), 1U);
  EXPECT_EQ(o.sensors[0].radius_m, 0.05);
  EXPECT_DOUBLE_EQ(o.sensors[0].mounting_rad, std::numbers::pi / 2.0);
  EXPECT_EQ(o.sensors[0].warm_up_time_s, 20.0);
}

TEST(RigFile, ErrorsNameFileLineAndKey) {
  EXPECT_EQ(error_of("\nrate = 100"), "rig.toml: line 2: rate is not a key of a rig's description");
  EXPECT_EQ(error_of("[daq]\nbit = 3"), "rig.toml: line 2: bit is not a key of [daq]");
  const auto unknown_key = parse_rig_file("[daq]\nbit = 3", "rig.toml");
  ASSERT_EQ(unknown_key.error().advice.size(), 1u);
  EXPECT_EQ(unknown_key.error().advice[0].option, "print-config");
  EXPECT_EQ(error_of("rate_hz = \"fast\""), "rig.toml: line 1: rate_hz must be a number");
  EXPECT_EQ(error_of("rate_hz = -1"), "rig.toml: rate_hz must be positive");
  EXPECT_EQ(error_of("[[sensor]]\n\nscale = [1, 2]"),
            "rig.toml: line 3: scale must be an array of 3 numbers");
}

TEST(RigFile, RefusesValuesOfTheWrongKind) {
  for (const char* text :
       {"seed = -1", "seed = 1.5", "axes = 2.5", "axes = 10000000000", "output = \"volts\"",
        "output = 3", "datasheet_errors = 1", "wheel = 3", "segment = 3", "sensor = []",
        "[segment]\nduration_s = 1", "[[sensor]]\nradus_m = 0.1",
        "[[sensor]]\nscale = [1, 2, \"3\"]", "rate_hz = nan", "rate_hz ="})
    EXPECT_FALSE(parse_rig_file(text, "rig.toml")) << text;
  EXPECT_EQ(parse_rig_file("rate_hz =", "rig.toml").error().code, Errc::corrupt);
}

TEST(RigFile, IsReadFromDisk) {
  const auto path = std::filesystem::temp_directory_path() /
                    ("proofmass_rig_" + std::to_string(::getpid()) + ".toml");
  std::ofstream(path) << format_rig_file(unusual());
  expect_same(read_rig_file(path.string()).value(), unusual());
  std::filesystem::remove(path);
  EXPECT_EQ(read_rig_file(path.string()).error().code, Errc::unreadable);
}

}  // namespace
}  // namespace proofmass::simulate::rig_file_test
