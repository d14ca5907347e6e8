#include "proofmass/io/positions/pose_table.hpp"

#include <cmath>
#include <gtest/gtest.h>

#include "proofmass/io/test_support.hpp"

namespace proofmass::io::pose_table_test {
namespace {

using Axes = std::array<double, 3>;

/// The table in a text, or the first error.
Result<PoseTable> table_of(std::string_view text, const std::optional<Unit>& unit = {}) {
  const auto recording = read_text(text);
  if (!recording) return recording.error();
  return pose_table(*recording, unit);
}

bool looks_like(std::string_view text) {
  const auto recording = read_text(text);
  return recording && looks_like_pose_table(*recording);
}

std::string notes_of(const PoseTable& table) {
  std::string all;
  for (const Note& note : table.notes) all += note.text + "\n";
  return all;
}

TEST(PoseTable, ReadsMeansDeviationsDirectionsLabelsAndTimes) {
  const auto table = table_of(
      "pose,start (s),end (s),x_mean (g),y_mean (g),z_mean (g),x_std,y_std,z_std,samples,"
      "up_x,up_y,up_z\n"
      "z up,10,20,0.01,0.02,0.98,0.002,0.004,0.006,100,0,0,2\n"
      "tilted,35,44.5,0.6,0.02,0.78,0.001,0.001,0.001,25,3,0,4\n"
      "x up,41,50,1.02,0.02,0.01,0.002,nan,0.002,400,,,\n");
  ASSERT_TRUE(table.has_value()) << table.error().message;
  ASSERT_EQ(table->rows.size(), 3u);
  const PoseRow& first = table->rows[0];
  EXPECT_EQ(first.label, "z up");
  EXPECT_EQ(first.start_s, 10.0);
  EXPECT_EQ(first.end_s, 20.0);
  EXPECT_EQ(first.mean, (Axes{0.01, 0.02, 0.98}));
  EXPECT_EQ(first.unit.symbol, "g");
  EXPECT_EQ(first.samples, 100u);
  ASSERT_TRUE(first.std_of_mean.has_value());
  EXPECT_DOUBLE_EQ((*first.std_of_mean)[1], 0.0004);
  EXPECT_EQ(first.up, (Axes{0, 0, 1}));
  EXPECT_EQ(table->rows[1].start_s, 35.0);
  EXPECT_EQ(table->rows[1].up, (Axes{0.6, 0, 0.8}));
  EXPECT_EQ(table->rows[2].std_of_mean, std::nullopt);
  EXPECT_EQ(table->rows[2].up, std::nullopt);
}

TEST(PoseTable, KnowsTheNamesPeopleGiveTheColumns) {
  for (const char* header :
       {"x_mean (g),y_mean (g),z_mean (g)", "mean_x,mean_y,mean_z",
        "acc_x_mean,acc_y_mean,acc_z_mean", "Mean X [m/s²],Mean Y [m/s²],Mean Z [m/s²]",
        "avg_ax,avg_ay,avg_az", "AccX mean,AccY mean,AccZ mean"}) {
    const std::string text = std::string(header) + "\n1,0.1,0.2\n0.1,1,0.3\n0.1,0.2,-1\n";
    EXPECT_TRUE(looks_like(text)) << header;
    const auto table = table_of(text);
    ASSERT_TRUE(table.has_value()) << header << ": " << table.error().message;
    EXPECT_EQ(table->rows[2].mean, (Axes{0.1, 0.2, -1})) << header;
  }
  for (const char* header : {"x_sem,y_sem,z_sem", "x_std_mean,y_std_mean,z_std_mean",
                             "standard error x,standard error y,standard error z"}) {
    const auto table =
        table_of("x_mean,y_mean,z_mean," + std::string(header) + "\n1,2,3,4,5,6\n1,2,4,7,8,9\n");
    ASSERT_TRUE(table.has_value()) << header << ": " << table.error().message;
    EXPECT_EQ(table->rows[1].std_of_mean, (Axes{7, 8, 9})) << header;
  }
}

TEST(PoseTable, TakesPlainReadingsWhereItIsToldThatTheyAreMeans) {
  const std::string plain = "ax (g),ay (g),az (g),position\n1,0,0,1\n0,1,0,2\n0,0,1,3\n";
  EXPECT_FALSE(looks_like(plain)) << "a short recording of three accelerations";
  const auto table = table_of(plain);
  ASSERT_TRUE(table.has_value()) << table.error().message;
  EXPECT_EQ(table->rows[1].mean, (Axes{0, 1, 0}));
  EXPECT_EQ(table->rows[1].label, "2");
  EXPECT_TRUE(looks_like("ax,ay,az,up_x,up_y,up_z\n1,0,0,1,0,0\n0,1,0,0,1,0\n"));
}

TEST(PoseTable, IsNoSeriesOfSamples) {
  EXPECT_FALSE(looks_like("t,acc_x (g),acc_y (g),acc_z (g)\n0,1,0,0\n1,0,1,0\n2,0,0,1\n"));
  EXPECT_FALSE(looks_like("t,gyr_x_mean,gyr_y_mean,gyr_z_mean\n0,1,0,0\n1,0,1,0\n2,0,0,1\n"));
  EXPECT_FALSE(looks_like("t,x_mean,y_mean\n0,1,0\n1,0,1\n2,0,0\n"));
  std::string features = "x_mean,y_mean,z_mean\n";
  for (int k = 0; k < 1001; ++k) features += "1,0.1,0.2\n";
  EXPECT_FALSE(looks_like(features)) << "as many rows as no one turns a sensor by hand";
  EXPECT_FALSE(table_of("t,a,b\n0,1,2\n1,2,3\n").has_value());
}

TEST(PoseTable, BringsMeansAndDeviationsToOneUnit) {
  const auto table = table_of(
      "x_mean (g),y_mean (mg),z_mean (g),x_sem (mg),y_sem (mg),z_sem (mg)\n"
      "1,20,0.5,1,2,3\n0.5,30,1,1,2,3\n");
  ASSERT_TRUE(table.has_value()) << table.error().message;
  EXPECT_DOUBLE_EQ(table->rows[0].mean[1], 0.02);
  EXPECT_DOUBLE_EQ((*table->rows[0].std_of_mean)[2], 0.003);
  const auto mixed = table_of("x_mean (g),y_mean (V),z_mean (g)\n1,20,0.5\n2,3,4\n");
  ASSERT_FALSE(mixed.has_value());
  EXPECT_NE(mixed.error().message.find("y_mean in V does not go with means in g"),
            std::string::npos);
  const auto given = table_of("x_mean,y_mean,z_mean,x_sem,y_sem,z_sem\n1,2,3,4,5,6\n1,1,2,4,5,6\n",
                              parse_unit("mV"));
  ASSERT_TRUE(given.has_value()) << given.error().message;
  EXPECT_EQ(given->rows[0].unit.symbol, "mV");
  EXPECT_EQ((*given->rows[0].std_of_mean)[1], 5.0);
}

TEST(PoseTable, LeavesOutRowsWithoutMeansAndSaysSo) {
  const auto table = table_of("x_mean,y_mean,z_mean\n1,2,3\n1,nan,3\n4,5,6\n");
  ASSERT_TRUE(table.has_value()) << table.error().message;
  ASSERT_EQ(table->rows.size(), 2u);
  EXPECT_EQ(table->rows[1].row, 2u);
  EXPECT_NE(notes_of(*table).find("line 3: a mean is not a number: left out"), std::string::npos)
      << notes_of(*table);
  const auto none = table_of("x_mean,y_mean,z_mean\n1,nan,3\nnan,5,6\n");
  ASSERT_FALSE(none.has_value());
  EXPECT_EQ(none.error().code, Errc::too_few_samples);
}

TEST(PoseTable, RefusesADirectionOfNoLength) {
  const auto table =
      table_of("x_mean,y_mean,z_mean,x_true,y_true,z_true\n1,2,3,0,0,1\n1,2,3,0,0,0\n");
  ASSERT_FALSE(table.has_value());
  EXPECT_EQ(table.error().message,
            "line 3: the true direction needs three figures that are not all zero");
}

TEST(PoseTable, NamesTheFileThatIsNone) {
  EXPECT_TRUE(
      read_pose_table("/no/such/file.csv").error().message.starts_with("/no/such/file.csv:"));
}

TEST(PoseTable, ReadsThePublishedSixPositions) {
  const auto file = published_data() / "uca-mpu9250/six-position/trial_1/six_position_data_1.csv";
  if (!std::filesystem::exists(file)) GTEST_SKIP() << "no published recordings here";
  const auto recording = read_recording(file, {});
  ASSERT_TRUE(recording.has_value()) << recording.error().message;
  EXPECT_TRUE(looks_like_pose_table(*recording));
  const auto table = read_pose_table(file);
  ASSERT_TRUE(table.has_value()) << table.error().message;
  ASSERT_EQ(table->rows.size(), 6u);
  EXPECT_EQ(table->rows[0].mean,
            (Axes{0.09955516051697808, 0.06244920681930471, 0.7720859101295814}));
  EXPECT_EQ(table->rows[0].unit.symbol, "g");
  EXPECT_EQ(table->rows[1].up, (Axes{0, 0, -1}));
  EXPECT_EQ(table->rows[2].up, (Axes{0, 1, 0}));
  EXPECT_EQ(table->rows[0].std_of_mean, std::nullopt);
  EXPECT_NE(notes_of(*table).find("x_std, y_std, z_std: standard deviations of the samples, and no "
                                  "column samples says how many: not used"),
            std::string::npos)
      << notes_of(*table);
}

}  // namespace
}  // namespace proofmass::io::pose_table_test
