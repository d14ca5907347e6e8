#include "proofmass/io/layouts/tables.hpp"

#include <algorithm>
#include <fstream>
#include <gtest/gtest.h>

#include "proofmass/io/archive/archive.hpp"
#include "proofmass/io/archive/zip_specimens.hpp"
#include "proofmass/io/test_support.hpp"

namespace proofmass::io::archive_tables_test {
namespace {

using specimen::table_of;
using specimen::ZipFile;

/// The files as a folder, and as a zip archive: both give the same recording.
class FolderAndZip : public testing::TestWithParam<bool> {
 protected:
  void SetUp() override {
    std::string name = testing::UnitTest::GetInstance()->current_test_info()->name();
    std::ranges::replace(name, '/', '_');
    folder_ = std::filesystem::temp_directory_path() / ("proofmass_archive_" + name);
    std::filesystem::remove_all(folder_);
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  Result<Recording> read(const std::vector<ZipFile>& files, const ReadOptions& options = {}) {
    if (GetParam()) return read_text(specimen::zip(files), options);
    std::filesystem::create_directories(folder_);
    for (const ZipFile& file : files) {
      std::filesystem::create_directories((folder_ / file.name).parent_path());
      std::ofstream(folder_ / file.name, std::ios::binary) << file.text;
    }
    return read_recording(folder_.string(), options);
  }

 private:
  std::filesystem::path folder_;
};

INSTANTIATE_TEST_SUITE_P(Archives, FolderAndZip, testing::Bool(), [](const auto& which) {
  return which.param ? "Zip" : "Folder";
});

constexpr const char* phyphox_time =
    "\"event\",\"experiment time\",\"system time\",\"system time text\"\n"
    "\"START\",0.000000000000000E0,1.705472086068796E9,\"2024-01-17 08:14:46.069 UTC+02:00\"\n"
    "\"PAUSE\",3.000000000000000E0,1.705472089068796E9,\"\"\n"
    "\"START\",3.000000000000000E0,1.705472099568796E9,\"\"\n"
    "\"PAUSE\",5.000000000000000E0,1.705472101568796E9,\"\"\n";
constexpr const char* phyphox_device =
    "\"property\",\"value\"\n\"version\",\"1.1.12\"\n\"deviceModel\",\"iPhone13,4\"\n"
    "\"deviceBrand\",\"Apple\"\n\"deviceRelease\",\"17.2.1\"\n";

std::string phyphox_table(const std::string& quantity, const std::string& unit, double step_s) {
  std::string text = "\"Time (s)\"";
  for (const char* axis : {"x", "y", "z"})
    text += ",\"" + quantity + " " + axis + " (" + unit + ")\"";
  text += "\n";
  for (int k = 0; k < 200; ++k) text += std::to_string(0.25 + k * step_s) + ",1.5E-1,-2E-2,9.8E0\n";
  return text;
}

TEST_P(FolderAndZip, PhyphoxBeginsOnTheWallClockAndTellsPauses) {
  const auto read = this->read({{"Accelerometer.csv", phyphox_table("Acceleration", "m/s^2", 0.01)},
                                {"Gyroscope.csv", phyphox_table("Gyroscope", "rad/s", 0.02)},
                                {"meta/device.csv", phyphox_device},
                                {"meta/time.csv", phyphox_time}});
  ASSERT_TRUE(read.has_value()) << read.error().message;
  ASSERT_EQ(read->channels.size(), 3u);
  EXPECT_EQ(read->channels[0].name, "Acceleration x");
  EXPECT_NEAR(read->time.rate_hz, 100.0, 1e-9);
  ASSERT_TRUE(read->time.start_ns.has_value());
  EXPECT_EQ(*read->time.start_ns, 1'705'472'086'318'796'000);
  EXPECT_TRUE(is_noted(*read, "phyphox 1.1.12 on Apple iPhone13,4 (release 17.2.1)"));
  EXPECT_TRUE(is_noted(*read, "paused at 3 s for 10.5 s")) << notes_of(*read);
  EXPECT_TRUE(is_noted(*read, "also holds Gyroscope (4 columns"));
}

TEST_P(FolderAndZip, PhyphoxInOtherDialectsIsTheSame) {
  std::string times = phyphox_time;
  std::ranges::replace(times, ',', ';');
  std::ranges::replace(times, '.', ',');
  const auto read =
      this->read({{"export/Raw Data.csv", phyphox_table("Acceleration", "m/s^2", 0.01)},
                  {"export/meta/time.csv", times}});
  if (!GetParam()) {  // folders are searched two levels deep
    ASSERT_TRUE(read.has_value());
    return;
  }
  ASSERT_TRUE(read.has_value()) << read.error().message;
  ASSERT_TRUE(read->time.start_ns.has_value());
  EXPECT_EQ(*read->time.start_ns, 1'705'472'086'318'796'000);
}

TEST_P(FolderAndZip, VariableReadsAnotherSensor) {
  ReadOptions options;
  options.variables = {"gyroscope"};
  const auto read = this->read({{"Accelerometer.csv", phyphox_table("Acceleration", "m/s^2", 0.01)},
                                {"Gyroscope.csv", phyphox_table("Gyroscope", "rad/s", 0.02)}},
                               options);
  ASSERT_TRUE(read.has_value()) << read.error().message;
  EXPECT_EQ(read->channels[0].name, "Gyroscope x");
  EXPECT_NEAR(read->time.rate_hz, 50.0, 1e-9);
}

TEST_P(FolderAndZip, NgimuSessionReadsItsSensors) {
  std::string sensors =
      "Time (s),Gyroscope X (deg/s),Gyroscope Y (deg/s),Gyroscope Z (deg/s),Accelerometer X (g),"
      "Accelerometer Y (g),Accelerometer Z (g),Magnetometer X (uT),Magnetometer Y (uT),"
      "Magnetometer Z (uT),Barometer (hPa)\n";
  std::string linear = "Time (s),X (g),Y (g),Z (g)\n";
  std::string temperature = "Time (s),Gyroscope And Accelerometer (degC),Barometer (degC)\n";
  for (int k = 0; k < 100; ++k) {
    const std::string time = std::to_string(k * 0.0025);
    sensors += time + ",0,0,0,0,0,1,20,0,-40,1013\n";
    linear += time + ",0,0,0\n";
    linear += std::to_string(k * 0.0025 + 0.001) + ",0,0,0\n";
    temperature += time + ",25,26\n";
  }
  const auto read = this->read({{"NGIMU - 0028614B/sensors.csv", sensors},
                                {"NGIMU - 0028614B/linear.csv", linear},
                                {"NGIMU - 0028614B/temperature.csv", temperature}});
  ASSERT_TRUE(read.has_value()) << read.error().message;
  EXPECT_EQ(read->channels.size(), 10u);
  EXPECT_NEAR(read->time.rate_hz, 400.0, 1e-9);
  EXPECT_TRUE(is_noted(*read, "sensors is read")) << notes_of(*read);
}

std::string ximu_table(int rows) {
  std::string text =
      "Packet number,Gyroscope X (deg/s),Gyroscope Y (deg/s),Gyroscope Z (deg/s),"
      "Accelerometer X (g),Accelerometer Y (g),Accelerometer Z (g),Magnetometer X (G),"
      "Magnetometer Y (G),Magnetometer Z (G)\n";
  for (int k = 0; k < rows; ++k) text += std::to_string(2 * k) + ",0,0,0,0,0,1,0.2,0,-0.4\n";
  return text;
}

TEST_P(FolderAndZip, XimuRateStandsInTheRegisters) {
  const auto read = this->read(
      {{"00000_CalInertialAndMag.csv", ximu_table(100)},
       {"00000_Registers.csv",
        "Packet number,Address,Value,Fixed-point value,Name\n"
        "69,68,3,NaN,BatteryAndThermometerDataRate\n70,69,8,NaN,InertialAndMagneticDataRate\n"}});
  ASSERT_TRUE(read.has_value()) << read.error().message;
  EXPECT_EQ(read->time.rate_hz, 128.0);
  EXPECT_TRUE(is_noted(*read, "InertialAndMagneticDataRate of 00000_Registers.csv"));
}

TEST_P(FolderAndZip, XimuRateIsCountedBetweenDates) {
  std::string dates = "Packet number,Year,Month,Day,Hours,Minutes,Seconds\n";
  for (int s = 0; s <= 20; ++s)
    dates += std::to_string(128 * s + 1) + ",2000,1,5,23,59," + std::to_string(39 + s) + "\n";
  dates += "9999,133333333333,1,5,0,0,0\n";  // a year beyond any calendar
  const auto read = this->read(
      {{"00000_CalInertialAndMag.csv", ximu_table(1400)}, {"00000_DateTime.csv", dates}});
  ASSERT_TRUE(read.has_value()) << read.error().message;
  EXPECT_EQ(read->time.rate_hz, 64.0);
  EXPECT_TRUE(is_noted(*read, "1280 rows in the 20 s")) << notes_of(*read);
  EXPECT_EQ(read->find("Packet number"), nullptr);
  EXPECT_EQ(read->channels.size(), 9u);
  EXPECT_TRUE(read->time.is_uniform());
}

TEST_P(FolderAndZip, XimuWithoutEitherAsksForTheRate) {
  const auto read = this->read({{"00000_CalInertialAndMag.csv", ximu_table(100)}});
  ASSERT_TRUE(read.has_value()) << read.error().message;
  EXPECT_EQ(read->time.rate_hz, 0.0);
  EXPECT_TRUE(recommends(*read, "rate")) << notes_of(*read);
}

std::string logged(double x, double y, double z) {
  std::string text = "time,seconds_elapsed,z,y,x\n";
  for (long long k = 0; k < 300; ++k)
    text += std::to_string(1'716'979'893'874'983'200 + k * 10'000'000) + "," +
            std::to_string(static_cast<double>(k) * 0.01) + "," + std::to_string(z) + "," +
            std::to_string(y) + "," + std::to_string(x) + "\n";
  return text;
}

TEST_P(FolderAndZip, SensorLoggerHasUnitsBySensor) {
  const auto read =
      this->read({{"Accelerometer.csv", logged(0.0, 0.0, 0.0)},
                  {"TotalAcceleration.csv", logged(0.1, 0.2, 9.8)},
                  {"Gyroscope.csv", logged(1.0, 0.0, 0.0)},
                  {"Metadata.csv", "version,device name,platform\n3,Pixel 6,android\n"}});
  ASSERT_TRUE(read.has_value()) << read.error().message;
  const Channel* x = read->find("x");
  ASSERT_NE(x, nullptr);
  EXPECT_EQ(x->values[0], 0.1);
  EXPECT_EQ(x->unit.symbol, "m/s^2");
  EXPECT_EQ(*read->time.start_ns, 1'716'979'893'874'983'200);
  EXPECT_TRUE(is_noted(*read, "TotalAcceleration is read")) << notes_of(*read);
  EXPECT_TRUE(is_noted(*read, "device name Pixel 6")) << notes_of(*read);
}

TEST_P(FolderAndZip, SensorLoggersGyroscopeIsNoAccelerometer) {
  ReadOptions options;
  options.variables = {"Gyroscope"};
  const auto read = this->read(
      {{"TotalAcceleration.csv", logged(0.1, 0.2, 9.8)}, {"Gyroscope.csv", logged(1.0, 0.0, 0.0)}},
      options);
  ASSERT_TRUE(read.has_value()) << read.error().message;
  const Channel* x = read->find("Gyroscope x");
  ASSERT_NE(x, nullptr);
  EXPECT_EQ(x->unit.symbol, "rad/s");
}

TEST_P(FolderAndZip, ThePhoneIsToldThatRecordPropertiesNames) {
  const auto read = this->read(
      {{"accelerometer.csv", table_of(50)},
       {"record.properties", "[Device]\nManufacturer = LGE\nModel = Nexus 5\nOSVersion = 23\n"}});
  ASSERT_TRUE(read.has_value()) << read.error().message;
  EXPECT_TRUE(is_noted(*read, "recorded by LGE Nexus 5")) << notes_of(*read);
}

TEST_P(FolderAndZip, TablesAreCalledByTheirFiles) {
  const auto read = this->read({{"run/a.csv", table_of(30)},
                                {"run/a.txt", table_of(20)},
                                {"run/sub.csv", table_of(10)},
                                {"run/.hidden.csv", table_of(99)},
                                {"run/README.md", "# words"}});
  ASSERT_TRUE(read.has_value()) << read.error().message;
  EXPECT_EQ(read->samples(), 30u);
  EXPECT_TRUE(is_noted(*read,
                       "a.csv is read, having accelerations; also holds a.txt (4 columns, "
                       "20 rows), sub (4 columns, 10 rows)"))
      << notes_of(*read);
  EXPECT_TRUE(is_noted(*read, "skipped, being no recordings: run/README.md")) << notes_of(*read);
}

TEST_P(FolderAndZip, SaysWhyNothingIsARecording) {
  const auto one = this->read({{"README.md", "# words"}});
  ASSERT_FALSE(one.has_value());
  EXPECT_NE(one.error().message.find("README.md: no row of numbers"), std::string::npos)
      << one.error().message;
  const auto two = this->read({{"README.md", "# words"}, {"LICENSE", "more words"}});
  ASSERT_FALSE(two.has_value());
  EXPECT_NE(two.error().message.find("none of 2 files is one"), std::string::npos)
      << two.error().message;
}

TEST(Folder, IsNotReadWhereItHoldsNothing) {
  const auto folder = std::filesystem::temp_directory_path() / "proofmass_archive_empty";
  std::filesystem::create_directories(folder);
  const auto read = read_recording(folder.string(), {});
  std::filesystem::remove_all(folder);
  ASSERT_FALSE(read.has_value());
  EXPECT_NE(read.error().message.find("holds no file"), std::string::npos) << read.error().message;
}

TEST(Folder, IsTwoLevelsDeep) {
  const auto folder = std::filesystem::temp_directory_path() / "proofmass_archive_levels";
  std::filesystem::remove_all(folder);
  std::filesystem::create_directories(folder / "a/b");
  for (const char* name : {"top.csv", "a/second.csv", "a/b/third.csv"})
    std::ofstream(folder / name) << "x\n1\n2\n";
  auto archive = open_folder(folder.string());
  ASSERT_TRUE(archive.has_value());
  std::vector<std::string> names;
  for (const ArchiveEntry& entry : (*archive)->entries()) names.push_back(entry.name);
  std::filesystem::remove_all(folder);
  EXPECT_EQ(names, (std::vector<std::string>{"a/second.csv", "top.csv"}));
}

}  // namespace
}  // namespace proofmass::io::archive_tables_test
