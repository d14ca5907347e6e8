// Folders of phones and loggers, opened by the folder's name, as by a user.
#include <cmath>
#include <filesystem>
#include <gtest/gtest.h>
#include <string>

#include "proofmass/io/read_recording.hpp"
#include "published_data.hpp"

namespace proofmass::folders_real_test {
namespace {

bool is_noted(const Recording& recording, const std::string& part) {
  for (const Note& note : recording.notes)
    if (note.text.find(part) != std::string::npos) return true;
  return false;
}

class RealFolders : public testing::Test {
 protected:
  /// The recording in a folder; fails the test if it cannot be read.
  static Recording read(const std::string& folder, const std::string& variable = {}) {
    io::ReadOptions options;
    if (!variable.empty()) options.variables = {variable};
    auto recording = io::read_recording((published_data() / folder).string(), options);
    if (recording) return std::move(recording).value();
    ADD_FAILURE() << recording.error().message;
    return {};
  }
  void SetUp() override {
    if (!std::filesystem::exists(published_data() / "xio-ximu"))
      GTEST_SKIP() << absent(published_data() / "xio-ximu");
  }
};

TEST_F(RealFolders, PhyphoxExportBeginsOnTheWallClock) {
  const Recording run = read("phyphox-barbell-strokes/Acceleration without g 2024-01-17 08-15-45");
  EXPECT_EQ(run.samples(), 3602u);
  // START at 1705472086.068796 s, the first row 6.999333331 ms later.
  EXPECT_EQ(run.time.start_ns, 1'705'472'086'075'795'333);
  EXPECT_TRUE(is_noted(run, "phyphox 1.1.12 on Apple iPhone13,4"));
}

TEST_F(RealFolders, PhyphoxWithoutItsMetaFolderIsKnownToo) {
  const Recording ride = read("phyphox-elevator/series_2");
  EXPECT_EQ(ride.samples(), 2825u);
  EXPECT_TRUE(is_noted(ride, "also holds Pressure and velocity"));
  EXPECT_EQ(read("phyphox-elevator/series_2", "pressure and velocity").samples(), 109u);
}

TEST_F(RealFolders, XimuCardIsItsMakersCsv) {
  const Recording card = read("xio-ximu/gait", "straightLine/CalInertialAndMag");
  const Recording table = read("xio-ximu/gait", "straightLine_CalInertialAndMag");
  ASSERT_EQ(card.samples(), 9963u);
  ASSERT_EQ(table.samples(), card.samples());
  ASSERT_EQ(table.channels.size(), card.channels.size());
  for (std::size_t c = 0; c < card.channels.size(); ++c) {
    EXPECT_EQ(card.channels[c].name, table.channels[c].name);
    EXPECT_EQ(card.channels[c].unit, table.channels[c].unit);
    for (std::size_t k = 0; k < card.samples(); ++k)
      ASSERT_NEAR(card.channels[c].values[k], table.channels[c].values[k],
                  1e-6 * (1.0 + std::abs(card.channels[c].values[k])));
  }
  EXPECT_EQ(card.time.rate_hz, 256.0);
  EXPECT_EQ(table.time.rate_hz, 256.0);
}

TEST_F(RealFolders, XimuRateIsCountedBetweenItsDates) {
  const Recording spring = read("xio-ximu/oscillatory");
  EXPECT_EQ(spring.samples(), 11'617u);
  EXPECT_EQ(spring.time.rate_hz, 256.0);
  EXPECT_TRUE(is_noted(spring, "11520 rows in the 45 s of LoggedData_DateTime.csv"));
}

TEST_F(RealFolders, PhonesAreToldByTheirProperties) {
  const Recording walk = read("tyrex-phones/Guillaume_Nexus5_NoDist_AR");
  EXPECT_EQ(walk.samples(), 25'268u);
  EXPECT_NEAR(walk.time.rate_hz, 198.6, 0.05);
  EXPECT_TRUE(is_noted(walk, "LGE Nexus 5"));
  EXPECT_NEAR(read("tyrex-phones/calib_acc_iPhone5_d3").time.rate_hz, 101.0, 0.5);
}

TEST_F(RealFolders, XsensDotsAreATableEach) {
  const Recording wheel = read("wid-car-wheels/trial06", "IMU1_radial");
  EXPECT_EQ(wheel.samples(), 11'004u);
  EXPECT_NEAR(wheel.time.rate_hz, 120.005, 1e-3);
  EXPECT_EQ(wheel.find("Acc_X")->unit.symbol, "m/s^2");
}

TEST_F(RealFolders, LoggerBeginsAtItsStartTime) {
  const Recording logger = read("formats/gcdc");
  EXPECT_EQ(logger.samples(), 1375u);
  EXPECT_EQ(logger.time.start_ns, 1'518'164'503'167'310'000);
  EXPECT_NEAR(logger.time.rate_hz, 64.0, 0.01);
  EXPECT_EQ(logger.find("Az")->unit.quantity, Quantity::counts);
}

}  // namespace
}  // namespace proofmass::folders_real_test
