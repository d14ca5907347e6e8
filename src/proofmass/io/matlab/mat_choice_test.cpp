#include <gtest/gtest.h>

#include "proofmass/io/matlab/mat_specimens.hpp"
#include "proofmass/io/test_support.hpp"

namespace proofmass::io::matlab::mat_choice_test {
namespace {

using namespace specimen;
using Values = std::vector<double>;

constexpr std::int32_t samples = 20;

/// k -> first + step · (k mod period)
Values values(double first, double step, int period = 7, int count = samples) {
  Values out;
  for (int k = 0; k < count; ++k) out.push_back(first + step * (k % period));
  return out;
}

Values joined(std::initializer_list<Values> parts) {
  Values all;
  for (const Values& part : parts) all.insert(all.end(), part.begin(), part.end());
  return all;
}

const Values time_s = values(5.0, 0.01, samples);
const Values axes = joined({values(0.1, 0.01), values(0.2, 0.02), values(9.7, 0.01)});
const std::string time_vector = doubles("t", samples, time_s);

std::vector<std::string> names_of(const Result<Recording>& read) {
  if (!read) return {read.error().message};
  std::vector<std::string> names;
  for (const Channel& channel : read->channels) names.push_back(channel.name);
  return names;
}
using Names = std::vector<std::string>;

Result<Recording> read_mat5(const std::string& variables, const ReadOptions& options = {}) {
  return read_text(mat5_header() + variables, options);
}

ReadOptions chosen(std::vector<std::string> variables) {
  ReadOptions options;
  options.variables = std::move(variables);
  return options;
}

TEST(Choice, AMatrixAloneIsReadLikeATableWithoutAHeader) {
  const auto timed = read_mat5(doubles("data", samples, joined({time_s, axes})));
  EXPECT_EQ(names_of(timed), (Names{"x", "y", "z"}));
  EXPECT_NEAR(timed->time.rate_hz, 100.0, 1e-6);
  EXPECT_EQ(timed->channels[2].unit.symbol, "m/s^2");
  const auto untimed = read_mat5(doubles("data", samples, axes));
  EXPECT_EQ(names_of(untimed), (Names{"x", "y", "z"}));
  EXPECT_EQ(untimed->time.source, TimeSource::none);
  const auto four = read_mat5(doubles("data", samples, joined({axes, values(1, 1)})));
  EXPECT_EQ(names_of(four), (Names{"column 1", "column 2", "column 3", "column 4"}));
}

TEST(Choice, AMatrixOfAnotherKindKeepsItsName) {
  EXPECT_EQ(names_of(read_mat5(doubles("gyro", samples, axes))),
            (Names{"gyro_x", "gyro_y", "gyro_z"}));
  const auto timed = read_mat5(doubles("Omega", samples, joined({time_s, axes})));
  EXPECT_EQ(names_of(timed), (Names{"Omega_x", "Omega_y", "Omega_z"}));
  EXPECT_NEAR(timed->time.rate_hz, 100.0, 1e-6);
}

TEST(Choice, VectorsOfEqualLengthAreJoinedUnderTheirNames) {
  const auto read =
      read_mat5(time_vector + doubles("ax_g", samples, values(0, 0.01)) +
                doubles("other", 9, values(1, 1, 9, 9)) + doubles("ay_g", 1, values(1, 0.01)));
  EXPECT_EQ(names_of(read), (Names{"ax", "ay"}));
  EXPECT_EQ(read->channels[1].unit.symbol, "g");
  EXPECT_EQ(read->time.channel, "t");
  EXPECT_TRUE(is_noted(*read, "t (20 x 1 double), ax_g (20 x 1 double), ay_g (1 x 20 double) read"))
      << notes_of(*read);
  EXPECT_TRUE(is_noted(*read, "also in the file: other (9 x 1 double)")) << notes_of(*read);
}

TEST(Choice, TheLargestMatrixIsJoinedWithTheVectorsBesideIt) {
  const auto read =
      read_mat5(doubles("cal", 3, values(1, 1, 9, 9)) + time_vector +
                doubles("acc", samples, axes) + doubles("temp", samples, values(20, 1)));
  EXPECT_EQ(names_of(read), (Names{"x", "y", "z", "temp"}));
  EXPECT_EQ(read->time.channel, "t");
}

TEST(Choice, ChannelsTimesSamplesAreTurned) {
  Values turned;
  for (std::size_t k = 0; k < samples; ++k)
    for (std::size_t c = 0; c < 3; ++c) turned.push_back(axes[c * samples + k]);
  const auto read = read_mat5(doubles("data", 3, turned));
  ASSERT_EQ(names_of(read), (Names{"x", "y", "z"}));
  EXPECT_EQ(read->channels[1].values, values(0.2, 0.02));
  // As in motion capture: bodies x axes x frames.
  const auto cube = read_mat5(
      matrix({6, {1, 3, samples}, "Positions"}, element(9, bytes_of(turned), Order::little)));
  ASSERT_EQ(names_of(cube), (Names{"Positions_x", "Positions_y", "Positions_z"}));
  EXPECT_EQ(cube->channels[2].values, values(9.7, 0.01));
}

TEST(Choice, ASingleNumberMayBeTheRate) {
  const std::string inner = structure("", {{"acc", doubles("", samples, axes)}});
  const auto read = read_mat5(structure("run", {{"Fs", doubles("", 1, {250})}, {"imu", inner}}));
  ASSERT_TRUE(read.has_value());
  EXPECT_EQ(read->time.rate_hz, 250.0);
  EXPECT_TRUE(is_noted(*read, "run.Fs: the rate in Hz")) << notes_of(*read);
  const auto mad = read_mat5(doubles("fs", 1, {-1}) + doubles("acc", samples, axes));
  EXPECT_EQ(mad->time.source, TimeSource::none);
  EXPECT_TRUE(is_noted(*mad, "fs: is not a possible rate")) << notes_of(*mad);
}

TEST(Choice, TheUserChoosesByName) {
  const std::string file = time_vector + doubles("acc", samples, axes) +
                           doubles("gyr", samples, axes) + doubles("temp", samples, values(20, 1));
  EXPECT_EQ(names_of(read_mat5(file, chosen({"gyr"}))), (Names{"gyr_x", "gyr_y", "gyr_z"}));
  EXPECT_EQ(read_mat5(file, chosen({"gyr"})).value().time.channel, "t");
  EXPECT_EQ(names_of(read_mat5(file, chosen({"ACC", "gyr"}))),
            (Names{"acc_x", "acc_y", "acc_z", "gyr_x", "gyr_y", "gyr_z"}));
  EXPECT_EQ(names_of(read_mat5(file, chosen({"temp"}))), (Names{"temp"}));
}

TEST(Choice, AStructIsChosenByItsName) {
  const std::string file =
      structure("left", {{"t", time_vector}, {"acc", doubles("", samples, axes)}}) +
      structure("right", {{"ax", doubles("", 8, values(1, 1, 8, 8))},
                          {"ay", doubles("", 8, values(1, -1, 8, 8))}});
  EXPECT_EQ(names_of(read_mat5(file)), (Names{"x", "y", "z"}));
  EXPECT_EQ(names_of(read_mat5(file, chosen({"right"}))), (Names{"ax", "ay"}));
  EXPECT_EQ(names_of(read_mat5(file, chosen({"right.ay"}))), (Names{"ay"}));
}

TEST(Choice, SaysWhatThereIsWhereItCannotChoose) {
  const auto none = read_mat5(doubles("gain", 1, {2}));
  ASSERT_FALSE(none.has_value());
  EXPECT_EQ(none.error().code, Errc::too_few_samples);
  EXPECT_NE(none.error().message.find("it has gain (1 x 1 double)"), std::string::npos);
  const auto absent = read_mat5(time_vector, chosen({"acc"}));
  ASSERT_FALSE(absent.has_value());
  EXPECT_EQ(absent.error().code, Errc::invalid_argument);
  EXPECT_NE(absent.error().message.find("no variable acc"), std::string::npos);
  const auto unequal =
      read_mat5(time_vector + doubles("u", 8, values(1, 1, 8, 8)), chosen({"t", "u"}));
  ASSERT_FALSE(unequal.has_value());
  EXPECT_NE(unequal.error().message.find("t has 20 samples and u 8"), std::string::npos);
  EXPECT_EQ(read_mat5(doubles("gain", 1, {2}), chosen({"gain"})).error().code,
            Errc::invalid_argument);
}

TEST(Choice, OtherFormatsHaveNoVariables) {
  const auto read = read_text("a,b\n1,2\n3,4\n", chosen({"a"}));
  ASSERT_FALSE(read.has_value());
  EXPECT_EQ(read.error().code, Errc::invalid_argument);
}

TEST(Choice, PutsAccelerationsBeforeLargerTablesOfOtherThings) {
  const std::string quaternions =
      doubles("quat", samples, joined({axes, values(1, 1), values(1, 2), values(1, 3)}));
  const std::string matrix =
      time_vector + quaternions + doubles("accel", samples, axes) + doubles("gyr", samples, axes);
  EXPECT_EQ(names_of(read_mat5(matrix)), (Names{"x", "y", "z"}));
  const std::string vectors = time_vector + quaternions +
                              doubles("ax", samples, values(0.1, 0.01)) +
                              doubles("az", samples, values(9.7, 0.01));
  EXPECT_EQ(names_of(read_mat5(vectors)), (Names{"ax", "az"}));
  // A calibration matrix is not a recording, whatever its name.
  const std::string calibration = doubles("acc_scale", 3, values(1, 0.1, 7, 9)) +
                                  doubles("data", 200, values(9.7, 0.01, 7, 600));
  const auto read = read_mat5(calibration);
  ASSERT_TRUE(read);
  EXPECT_EQ(read->samples(), 200u);
}

TEST(Choice, FindsTheVariableOfAChannelThatIsAskedFor) {
  const std::string file = time_vector + doubles("acc", samples, axes) +
                           doubles("gyr", samples, axes) + doubles("temp", samples, values(20, 1));
  const auto asked = [&](std::vector<std::string> channels) {
    ReadOptions options;
    options.channels = std::move(channels);
    const auto read = read_mat5(file, options);
    if (read) {
      EXPECT_NEAR(read->time.rate_hz, 100.0, 1e-6);
    }
    return names_of(read);
  };
  EXPECT_EQ(asked({"gyr_y"}), (Names{"gyr_y"}));
  EXPECT_EQ(asked({"gyr"}), (Names{"gyr_x", "gyr_y", "gyr_z"}));
  EXPECT_EQ(asked({"acc_x", "gyr_z"}), (Names{"acc_x", "gyr_z"}));
  EXPECT_EQ(asked({"temp"}), (Names{"temp"}));
  EXPECT_EQ(asked({"x"}), (Names{"x"})) << "of the table that is read without --variable";
}

}  // namespace
}  // namespace proofmass::io::matlab::mat_choice_test
