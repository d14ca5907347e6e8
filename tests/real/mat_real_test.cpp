// MATLAB's own files, compared with scipy 1.10.1.
#include <algorithm>
#include <gtest/gtest.h>

#include "proofmass/io/read_recording.hpp"
#include "published_data.hpp"

namespace proofmass::mat_real_test {
namespace {

using Values = std::vector<double>;

struct Specimen {
  const char* file;
  const char* format;
  std::size_t channels;
  std::size_t samples;
  Values last;  ///< the last channel, as far as it is listed
};

class MatSpecimen : public testing::TestWithParam<Specimen> {};

TEST_P(MatSpecimen, IsReadAsScipyReadsIt) {
  const Specimen& expected = GetParam();
  const auto file = published_data() / "formats/mat" / expected.file;
  if (!std::filesystem::exists(file)) GTEST_SKIP() << absent(file);
  const auto read = io::read_recording(file, {});
  ASSERT_TRUE(read.has_value()) << read.error().message;
  EXPECT_EQ(read->format, expected.format);
  ASSERT_EQ(read->channels.size(), expected.channels);
  EXPECT_EQ(read->samples(), expected.samples);
  const Samples& last = read->channels.back().values;
  for (std::size_t k = 0; k < expected.last.size(); ++k)
    EXPECT_DOUBLE_EQ(last[k], expected.last[k]) << k;
}

constexpr double pi = 3.14159265358979312;
INSTANTIATE_TEST_SUITE_P(
    All,
    MatSpecimen,
    testing::Values(
        Specimen{"big_endian.mat", "MAT v5", 2, 2, {3, 4}},
        Specimen{"little_endian.mat", "MAT v5", 2, 2, {3, 4}},
        Specimen{"test_mat4_le_floats.mat", "MAT v4", 1, 2, {0.1, 1.2}},
        Specimen{"testdouble_4.2c_SOL2.mat", "MAT v4", 1, 9, {0, pi / 4, pi / 2, 3 * pi / 4, pi}},
        Specimen{"testdouble_6.1_SOL2.mat", "MAT v5", 1, 9, {0, pi / 4, pi / 2, 3 * pi / 4, pi}},
        Specimen{"testdouble_7.4_GLNX86.mat", "MAT v5", 1, 9, {0, pi / 4, pi / 2}},
        Specimen{"testmatrix_4.2c_SOL2.mat", "MAT v4", 3, 5, {3, 0, 0, 0, 0}},
        Specimen{"testmatrix_7.4_GLNX86.mat", "MAT v5", 3, 5, {3, 0, 0, 0, 0}},
        Specimen{"testcell_7.4_GLNX86.mat", "MAT v5", 1, 3, {1, 2, 3}},
        Specimen{"testcomplex_7.4_GLNX86.mat", "MAT v5", 1, 9, {1, 0.70710678118654757}},
        Specimen{"teststruct_7.4_GLNX86.mat", "MAT v5", 2, 3, {1.4142135623730951}}));

TEST(MatFiles, WithoutNumbersAreRefusedInOneLine) {
  const auto folder = published_data() / "formats/mat";
  if (!std::filesystem::exists(folder)) GTEST_SKIP() << absent(folder);
  for (const char* file :
       {"parabola.mat", "sqr.mat", "teststring_7.4_GLNX86.mat", "testsparse_7.4_GLNX86.mat"}) {
    const auto read = io::read_recording(folder / file, {});
    ASSERT_FALSE(read.has_value()) << file;
    EXPECT_EQ(read.error().message.find('\n'), std::string::npos);
  }
}

TEST(MatFiles, AndTheSameRecordingAsTextAgreeToTheLastBit) {
  const auto folder = published_data() / "imu-tk-xsens";
  if (!std::filesystem::exists(folder)) GTEST_SKIP() << absent(folder);
  const auto mat = io::read_recording(folder / "IMU0x2Dalpha.mat", {});
  const auto text = io::read_recording(folder / "xsens_acc.mat.xz", {});
  ASSERT_TRUE(mat.has_value() && text.has_value());
  EXPECT_EQ(mat->format, "MAT v5");
  EXPECT_EQ(text->format, "CSV");
  ASSERT_EQ(mat->samples(), 51'175u);
  for (std::size_t k = 0; k < mat->samples(); k += 97)
    ASSERT_NEAR(mat->time.at(k), text->time.at(k), 1e-9) << k;
  ASSERT_EQ(mat->channels.size(), text->channels.size());
  for (std::size_t c = 0; c < mat->channels.size(); ++c)
    EXPECT_EQ(mat->channels[c].values, text->channels[c].values);
}

TEST(MatFiles, OfMotionCaptureHaveTheirRateAndTheirVariablesByName) {
  const auto file = published_data() / "tyrex-phones/Guillaume_Nexus5_NoDist_AR/qualisys.mat.xz";
  if (!std::filesystem::exists(file)) GTEST_SKIP() << absent(file);
  io::ReadOptions options;
  options.variables = {"Guillaume_Nexus5_NoDist_AR.RigidBodies.Positions"};
  const auto read = io::read_recording(file, options);
  ASSERT_TRUE(read.has_value()) << read.error().message;
  EXPECT_EQ(read->samples(), 7200u);
  EXPECT_EQ(read->time.rate_hz, 60.0);
  ASSERT_GE(read->channels.size(), 3u);
  EXPECT_EQ(read->channels[0].name, "Positions_x");
  EXPECT_NEAR(read->channels[0].values[0], -550.58013908, 5e-9);
  EXPECT_NEAR(read->channels[0].values[2], -548.41297599, 5e-9);
}

}  // namespace
}  // namespace proofmass::mat_real_test
