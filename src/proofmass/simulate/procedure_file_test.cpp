#include "proofmass/simulate/procedure_file.hpp"

#include <filesystem>
#include <fstream>
#include <gtest/gtest.h>
#include <unistd.h>

namespace proofmass::simulate::procedure_file_test {
namespace {

std::string error_of(std::string_view text) {
  const auto options = parse_procedure_file(text, "bench.toml", Procedure::tumble);
  return options ? "no error" : options.error().message;
}

ProcedureOptions unusual() {
  ProcedureOptions o = default_options(Procedure::tumble);
  o.seed = 99;
  o.output = RigOutput::counts;
  o.daq = {.bits = 16, .min_v = 0.0, .max_v = 3.3};
  o.timing.dwell_jitter = 1.0 / 3.0;
  o.table.planes = 2;
  o.table.backward = true;
  o.table.once_phase_rad = 30.0 * rad_per_deg;
  o.hand.bad_pose = 3;
  o.hand.bad_pose_push_mps2 = 0.002 * standard_gravity_mps2;
  o.supply.actual_v = 3.1;
  o.sensor.equation[1].K2 = 50e-6 / standard_gravity_mps2;
  o.sensor.equation[2].K3 = 1e-7;
  o.sensor.equation[0].Kang = 1e-5;
  o.sensor.bias_mps2 = {0.1, 1.0 / 3.0, -1e-9};
  return o;
}

TEST(ProcedureFile, ComesBackTheSame) {
  for (const ProcedureOptions& options :
       {default_options(Procedure::tumble), default_options(Procedure::four_position),
        default_options(Procedure::six_position), default_options(Procedure::multi_position),
        unusual()}) {
    const std::string text = format_procedure_file(options);
    const auto back = parse_procedure_file(text, "bench.toml", options.procedure);
    ASSERT_TRUE(back) << back.error().message << text;
    EXPECT_EQ(format_procedure_file(*back), text);
    EXPECT_EQ(back->procedure, options.procedure);
    EXPECT_EQ(back->timing.dwell_jitter, options.timing.dwell_jitter);
    EXPECT_EQ(back->table.once_phase_rad, options.table.once_phase_rad);
    EXPECT_EQ(back->hand.bad_pose_push_mps2, options.hand.bad_pose_push_mps2);
    EXPECT_EQ(back->supply.actual_v, options.supply.actual_v);
    EXPECT_EQ(back->daq.bits, options.daq.bits);
    EXPECT_EQ(back->sensor.bias_mps2, options.sensor.bias_mps2);
    for (std::size_t axis = 0; axis < 3; ++axis)
      for (const sensor::CoefficientInfo& info : sensor::coefficients())
        EXPECT_NEAR(back->sensor.equation[axis].*info.member,
                    options.sensor.equation[axis].*info.member,
                    1e-15 * std::abs(options.sensor.equation[axis].*info.member))
            << info.name;
  }
}

TEST(ProcedureFile, CoefficientsAreInTheUnitsOfTheStandard) {
  const ProcedureOptions o = parse_procedure_file(
                                 "procedure = \"tumble\"\n[sensor]\nK2 = [50e-6, 0, 0]\n"
                                 "delta_o = [1e-3, 0, 0]\nK0_asym = [0, 2e-3, 0]\n",
                                 "bench.toml", Procedure::tumble)
                                 .value();
  EXPECT_DOUBLE_EQ(o.sensor.equation[0].K2, 50e-6 / standard_gravity_mps2);
  EXPECT_DOUBLE_EQ(o.sensor.equation[0].delta_o, 1e-3);
  EXPECT_DOUBLE_EQ(o.sensor.equation[1].K0_asym, 2e-3 * standard_gravity_mps2);
}

TEST(ProcedureFile, AnEmptyOneIsTheDefault) {
  for (const Procedure p : {Procedure::four_position, Procedure::multi_position})
    EXPECT_EQ(format_procedure_file(parse_procedure_file("", "b", p).value()),
              format_procedure_file(default_options(p)));
}

TEST(ProcedureFile, ErrorsNameFileLineAndKey) {
  EXPECT_EQ(error_of("procedure = \"tumbling\""),
            "bench.toml: line 1: procedure must be one of \"tumble\", \"four-position\", "
            "\"six-position\", \"multi-position\", \"slide\"");
  EXPECT_EQ(error_of("\nprocedure = \"six-position\""),
            "bench.toml: line 2: procedure is six-position, but tumble was asked for");
  EXPECT_EQ(error_of("[hand]\n\npose = 3"), "bench.toml: line 3: pose is not a key of [hand]");
  const auto unknown_key =
      parse_procedure_file("[hand]\npose = 3", "bench.toml", Procedure::tumble);
  ASSERT_EQ(unknown_key.error().advice.size(), 1u);
  EXPECT_EQ(unknown_key.error().advice[0].option, "print-config");
  EXPECT_EQ(error_of("[sensor]\nK2 = 3"), "bench.toml: line 2: K2 must be an array of 3 numbers");
  EXPECT_EQ(error_of("[timing]\nmove_s = 0"), "bench.toml: move_s must be positive");
  EXPECT_EQ(parse_procedure_file("rate_hz =", "b", Procedure::tumble).error().code, Errc::corrupt);
  EXPECT_EQ(read_procedure_file("/nowhere/b.toml", Procedure::tumble).error().code,
            Errc::unreadable);
}

TEST(ProcedureFile, IsReadFromDisk) {
  const auto path = std::filesystem::temp_directory_path() /
                    ("proofmass_bench_" + std::to_string(::getpid()) + ".toml");
  std::ofstream(path) << format_procedure_file(unusual());
  EXPECT_EQ(format_procedure_file(read_procedure_file(path.string(), Procedure::tumble).value()),
            format_procedure_file(unusual()));
  std::filesystem::remove(path);
}

}  // namespace
}  // namespace proofmass::simulate::procedure_file_test
